// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace boresight::sessions {

/// Creates a folder for the outputs of a scope. At its end, those of the created folders that are
/// still empty are removed: a full disk leaves none.
class CreatedFolder {
 public:
  /// An empty name is no folder. OutputError.
  explicit CreatedFolder(const std::filesystem::path& folder);
  CreatedFolder(const CreatedFolder&) = delete;
  CreatedFolder& operator=(const CreatedFolder&) = delete;
  ~CreatedFolder();

 private:
  std::vector<std::filesystem::path> created_;  ///< the deepest first
};

}  // namespace boresight::sessions
