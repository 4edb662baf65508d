// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <mutex>
#include <string>

#include "sessions/io/datasets/dataset_file.h"

namespace boresight::sessions {

/// Hashes of the inputs of a dataset's runs, so that results notice a file that was changed under
/// its name. Each file is hashed once. Thread-safe.
class RunInputs {
 public:
  /// `mesh_of` is the station whose mesh replaces that of each case; usually empty.
  explicit RunInputs(const Dataset& dataset, std::string mesh_of = {});

  /// SHA-256 over the files of image, mask and used meshes, the camera model, the seed of the
  /// dataset and the truth. InputError when a file cannot be read.
  std::string sha256(const Case& dataset_case);

  /// InputError when `held`, the hash stored with a run of the case, differs from the present one;
  /// not when it is empty, as in files of earlier versions, nor when a file cannot be read.
  void requireUnchanged(const Case& dataset_case, const std::string& held,
                        const std::filesystem::path& results);

 private:
  std::string fileSha256(const std::filesystem::path& file);

  const Dataset& dataset_;
  std::string mesh_of_;
  std::mutex mutex_;
  std::map<std::filesystem::path, std::shared_future<std::string>> files_;
};

}  // namespace boresight::sessions
