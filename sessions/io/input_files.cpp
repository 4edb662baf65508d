// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/input_files.h"

#include <sys/stat.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identityOf(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return Identity(info.st_dev, info.st_ino);
}

struct Input {
  fs::path file;  ///< absolute
  FileUse use;
};

struct Inputs {
  std::mutex mutex;
  std::map<Identity, Input> noted;

  /// The input that has this identity still: of a file that is gone another one may get it.
  Input* find(const Identity& identity) {
    const auto found = noted.find(identity);
    if (found == noted.end() || identityOf(found->second.file) != identity) return nullptr;
    return &found->second;
  }
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

}  // namespace

void noteInput(const fs::path& file, FileUse use) {
  const auto identity = identityOf(file);
  if (!identity || use == FileUse::kFree) return;
  const std::lock_guard lock(inputs().mutex);
  Input* known = inputs().find(*identity);
  if (known == nullptr)
    inputs().noted.insert_or_assign(*identity, Input{fs::absolute(file), use});
  else if (known->use != use && known->use != FileUse::kFree)
    known->use = FileUse::kInput;
}

void noteOutput(const fs::path& output, FileUse use) {
  const auto identity = identityOf(output);
  if (!identity) return;
  if (use == FileUse::kInput) use = FileUse::kFree;
  const std::lock_guard lock(inputs().mutex);
  inputs().noted.insert_or_assign(*identity, Input{fs::absolute(output), use});
}

void requireNoInput(const fs::path& output, FileUse use) {
  const auto identity = identityOf(output);
  if (!identity) return;
  const std::lock_guard lock(inputs().mutex);
  const Input* known = inputs().find(*identity);
  if (known == nullptr || known->use == FileUse::kFree) return;
  if (known->use == use && use != FileUse::kInput) return;
  throw OverwriteError(output, known->file);
}

}  // namespace boresight::sessions
