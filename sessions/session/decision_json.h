// SPDX-License-Identifier: Apache-2.0
// Decisions and what they are made by, inside the session file.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"
#include "sessions/session/decision.h"

namespace boresight::sessions {

nlohmann::ordered_json toJson(const Decision& decision);
/// The reverse; whether there is such a case is for the caller to ask. InputError.
Decision readDecision(const JsonReader& json);

/// A check with its state, figure, limit and sentence; the reason of its override if there is one.
nlohmann::ordered_json toJson(const JudgedCheck& judged);
JudgedCheck readJudgedCheck(const JsonReader& json);

nlohmann::ordered_json toJson(const ReviewSettings& settings);
/// The reverse. InputError, also for a preset or limit that does not exist.
ReviewSettings readReviewSettings(const JsonReader& json);

/// {"picture", "mesh_scale", "calibration"}, six rows of six numbers each.
nlohmann::ordered_json toJson(const PoseCovariance& covariance);
/// The reverse. InputError.
PoseCovariance readPoseCovariance(const JsonReader& json);

/// UTC, as `utcNowText` says it. InputError.
std::string readTime(const JsonReader& json);

}  // namespace boresight::sessions
