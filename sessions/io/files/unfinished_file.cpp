// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/unfinished_file.h"

#include <mutex>
#include <set>
#include <system_error>
#include <utility>

namespace boresight::sessions {
namespace {

/// Never destroyed: threads may write until the process ends.
struct Unfinished {
  std::mutex mutex;
  std::multiset<std::filesystem::path> files;
};

Unfinished& unfinished() {
  static Unfinished* const kUnfinished = new Unfinished;
  return *kUnfinished;
}

}  // namespace

UnfinishedFile::UnfinishedFile(std::filesystem::path file) : file_(std::move(file)) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().files.insert(file_);
}

UnfinishedFile::~UnfinishedFile() {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().files.erase(unfinished().files.find(file_));
}

void removeUnfinishedFiles() {
  unfinished().mutex.lock();  // and never unlocked
  std::error_code error;
  for (const std::filesystem::path& file : unfinished().files)
    std::filesystem::remove_all(file, error);
}

}  // namespace boresight::sessions
