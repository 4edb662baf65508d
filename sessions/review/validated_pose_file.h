// SPDX-License-Identifier: Apache-2.0
// validated_pose.json: a pose to hand over, with everything that a reviewer will ask for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sessions/review/handed_pose.h"
#include "sessions/run/trace.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

inline constexpr const char* kValidatedPoseFormat = "boresight-validated-pose";
inline constexpr int kValidatedPoseVersion = 1;

/// The file as JSON (README.md beside this file tells its members). It holds a session of this one
/// case and its rig, so that whoever has the inputs can run it again and look; paths are relative
/// to `file`. `run` is the pose's, for its matches; without it they are left out.
/// A pose that is not validated says so in `state` and `standing`.
nlohmann::ordered_json validatedPoseJson(const Session& session, const HandedPose& pose,
                                         const std::optional<LocalizationTrace>& run,
                                         const std::filesystem::path& file);

/// Measures the case's pose again (checkedPose), writes it atomically and returns it. InputError
/// when something cannot be measured, or is not as the session states; OutputError.
HandedPose writeValidatedPose(const std::filesystem::path& file, const Session& session,
                              const std::string& case_id);

/// The member `signature`: SHA-256 over the JSON without it, as compact text. `json` as it was
/// parsed: text may have lost what numbers were made of (1.0 is written 1).
nlohmann::ordered_json signatureOf(const nlohmann::ordered_json& json);

}  // namespace boresight::sessions
