// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace boresight::sessions {

/// The name of a temporary file or folder, from before it is created until it has another name or
/// is removed: a program that a signal ends removes it. Thread-safe.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::filesystem::path file);
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();

 private:
  std::filesystem::path file_;
};

/// Removes all unfinished files, for a program that ends at once: a thread that begins or finishes
/// one from now on waits for ever.
void removeUnfinishedFiles();

}  // namespace boresight::sessions
