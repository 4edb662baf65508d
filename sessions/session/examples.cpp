// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/examples.h"

#include <system_error>

#include "sessions/io/errors.h"

namespace boresight::sessions {

std::filesystem::path examplesFolder() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (std::filesystem::path folder = program.parent_path(); folder != folder.root_path();
       folder = folder.parent_path()) {
    for (const char* place : {"share/boresight/examples", "sessions/examples"}) {
      if (std::filesystem::is_directory(folder / place / "stations", ignored))
        return folder / place;
    }
  }
  throw InputError(program,
                   "the examples are neither in share/boresight/examples beside the "
                   "program nor in the source tree above it");
}

}  // namespace boresight::sessions
