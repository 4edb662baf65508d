// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/io/option_value.h"
#include "sessions/session/check.h"
#include "sessions/session/pose_covariance.h"

namespace boresight::sessions {

/// kReopened takes an earlier decision back.
enum class Verdict { kValidated, kRejected, kReopened };

/// Where a pose comes from that is checked, decided on or exported.
enum class PoseSource { kRun, kAnnotation };

/// A check as it was when somebody decided.
struct JudgedCheck {
  Check check;
  std::string override_reason;  ///< why a failed one does not stand in the way, or empty

  bool operator==(const JudgedCheck&) const = default;
};

/// A second person's yes.
struct Approval {
  std::string by;
  std::string comment;
  std::string time;  ///< UTC, "2026-01-31T23:59:59Z"

  bool operator==(const Approval&) const = default;
};

/// The pose that was judged.
struct JudgedPose {
  PoseSource source = PoseSource::kRun;
  Pose camera_from_station;
  PoseCovariance covariance;

  bool operator==(const JudgedPose&) const = default;
};

/// What an operator decided about a case's result; the last one of a case holds.
struct Decision {
  std::string case_id;
  Verdict verdict = Verdict::kRejected;
  std::string by;  ///< who, not empty
  std::string comment;
  std::string time;                               ///< UTC, "2026-01-31T23:59:59Z"
  std::string digest;                             ///< of the run that was judged, or empty
  std::optional<JudgedPose> pose = std::nullopt;  ///< always there of a validation that can hold
  /// SHA-256 of each thing that the judgement rests on, by its name (sessions/review/grounds.h).
  std::map<std::string, std::string> grounds = {};
  std::vector<JudgedCheck> checks = {};
  std::optional<Approval> approval = std::nullopt;
  int basin_seeds = 0;  ///< further seeds that the checks rest on, to measure them again; 0: none

  bool operator==(const Decision&) const = default;
};

/// By what the poses of a session are judged.
struct ReviewSettings {
  std::string preset = "sample_transfer";  ///< of limits (sessions/session/check_limits.h)
  OptionList limits;  ///< what differs from the preset, by name in the order of the alphabet
  bool second_person = false;  ///< a validation counts once somebody else has approved it

  bool operator==(const ReviewSettings&) const = default;
};

}  // namespace boresight::sessions
