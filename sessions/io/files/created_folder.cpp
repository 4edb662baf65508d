// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/created_folder.h"

#include <system_error>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {

namespace fs = std::filesystem;

CreatedFolder::CreatedFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::path level = fs::absolute(folder).lexically_normal();
  if (!level.has_filename()) level = level.parent_path();
  if (fs::is_directory(level, error)) return;
  for (; !fs::exists(level, error) && level.has_relative_path(); level = level.parent_path())
    created_.push_back(level);
  fs::create_directories(folder, error);
  if (error) throw OutputError(folder, "it is no folder and cannot become one");
}

CreatedFolder::~CreatedFolder() {
  std::error_code error;
  for (const fs::path& level : created_)
    if (!fs::remove(level, error)) return;  // a file is in it
}

}  // namespace boresight::sessions
