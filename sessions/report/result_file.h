// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/json/option_value.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Provenance of a result. Empty file names are inputs that were not given.
struct RunProvenance {
  std::string method = "whs";
  std::string profile;
  OptionList changed_options;  ///< differences from the profile
  const LoadedCase* loaded = nullptr;
  std::filesystem::path camera_file, seed_file, truth_file, config_file;
  std::vector<std::string> warnings;  ///< printed before the run
};

/// result.json (`boresight-result`, version 1): status, pose, covariance, the pose in the frames
/// that have names (as in validated_pose.json), one line per iteration, errors against a truth,
/// seconds per stage, and the provenance: hashes of every input (of an image the file's and the
/// 8-bit pixels'), options, version, digest. InputError when an input to be hashed is missing.
nlohmann::ordered_json resultJson(const LocalizationTrace& trace,
                                  const std::optional<PoseError>& error,
                                  const RunProvenance& provenance);

}  // namespace boresight::sessions
