// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"
#include "sessions/decision/check.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/option_value.h"

namespace boresight::sessions {

/// kReopened takes an earlier decision back.
enum class Verdict { kValidated, kRejected, kReopened };

/// Where a pose comes from that is checked, decided on or exported.
enum class PoseSource { kRun, kAnnotation };

/// A check at the time of the decision.
struct JudgedCheck {
  Check check;
  std::string waiver_reason;  ///< why a failed one does not stand in the way, or empty

  bool operator==(const JudgedCheck&) const = default;
};

/// A second person's yes.
struct Approval {
  std::string by;
  std::string comment;
  std::string time;  ///< UTC, "2026-01-31T23:59:59Z"

  bool operator==(const Approval&) const = default;
};

/// Covariance of a pose by its causes, which are independent: over (rotation rad, translation m),
/// left perturbation, camera frame.
struct PoseCovariance {
  Matrix6d picture =
      Matrix6d::Zero();  ///< of the picture or the annotations alone; zero: not known
  Matrix6d mesh_scale = Matrix6d::Zero();   ///< of the mesh's scale, which no single image shows
  Matrix6d calibration = Matrix6d::Zero();  ///< of focal length and principal point

  bool known() const { return picture.allFinite() && !picture.isZero(0.0); }
  /// Zero when it is not known.
  Matrix6d total() const {
    return known() ? Matrix6d(picture + mesh_scale + calibration) : Matrix6d::Zero();
  }

  bool operator==(const PoseCovariance&) const = default;
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
  /// SHA-256 of each thing that the judgement rests on, by its name
  /// (sessions/review/review_status.h).
  std::map<std::string, std::string> input_fingerprint = {};
  std::vector<JudgedCheck> checks = {};
  std::optional<Approval> approval = std::nullopt;
  int convergence_seeds =
      0;  ///< further seeds that the checks rest on, to measure them again; 0: none

  bool operator==(const Decision&) const = default;
};

/// By what the poses of a session are judged.
struct ReviewSettings {
  std::string preset = "sample_transfer";  ///< of limits (sessions/decision/check_limits.h)
  OptionList limits;  ///< what differs from the preset, by name in the order of the alphabet
  bool second_person = false;  ///< a second person must approve a validation

  bool operator==(const ReviewSettings&) const = default;
};

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

}  // namespace boresight::sessions
