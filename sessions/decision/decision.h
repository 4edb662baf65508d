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

/// Outcome of a review; kReopened withdraws an earlier decision.
enum class Verdict { kValidated, kRejected, kReopened };

/// Source of a pose that is checked, decided on or exported.
enum class PoseSource { kRun, kAnnotation };

/// A check at the time of the decision.
struct JudgedCheck {
  Check check;
  std::string waiver_reason;  ///< reason to waive a failed check, or empty

  bool operator==(const JudgedCheck&) const = default;
};

/// Approval by a second person.
struct Approval {
  std::string by;
  std::string comment;
  std::string time;  ///< UTC, "2026-01-31T23:59:59Z"

  bool operator==(const Approval&) const = default;
};

/// Covariance of a pose by its causes, which are independent: over (rotation rad, translation m),
/// left perturbation, camera frame.
struct PoseCovariance {
  Matrix6d picture = Matrix6d::Zero();  ///< of the image or the annotations alone; zero: not known
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

/// An operator's decision on a case's result; the last decision of a case is in force.
struct Decision {
  std::string case_id;
  Verdict verdict = Verdict::kRejected;
  std::string by;  ///< name of the operator, not empty
  std::string comment;
  std::string time;                               ///< UTC, "2026-01-31T23:59:59Z"
  std::string digest;                             ///< of the run that was judged, or empty
  std::optional<JudgedPose> pose = std::nullopt;  ///< required for a validation to be valid
  /// SHA-256 of each input of the judgement, by its name (sessions/review/review_status.h).
  std::map<std::string, std::string> input_fingerprint = {};
  std::vector<JudgedCheck> checks = {};
  std::optional<Approval> approval = std::nullopt;
  int convergence_seeds = 0;  ///< further seeds of the convergence test, to repeat it; 0: none

  bool operator==(const Decision&) const = default;
};

/// Settings by which the poses of a session are judged.
struct ReviewSettings {
  std::string preset = "sample_transfer";  ///< of limits (sessions/decision/check_limits.h)
  OptionList limits;                       ///< differences from the preset, in alphabetical order
  bool second_person = false;              ///< a second person must approve a validation

  bool operator==(const ReviewSettings&) const = default;
};

nlohmann::ordered_json toJson(const Decision& decision);
/// Inverse of toJson; the caller must check that the case exists. InputError.
Decision readDecision(const JsonReader& json);

/// A check with its state, figure, limit and sentence; the reason of its waiver, if any.
nlohmann::ordered_json toJson(const JudgedCheck& judged);
JudgedCheck readJudgedCheck(const JsonReader& json);

nlohmann::ordered_json toJson(const ReviewSettings& settings);
/// Inverse of toJson. InputError, also for a preset or limit that does not exist.
ReviewSettings readReviewSettings(const JsonReader& json);

/// {"picture", "mesh_scale", "calibration"}, six rows of six numbers each.
nlohmann::ordered_json toJson(const PoseCovariance& covariance);
/// The reverse. InputError.
PoseCovariance readPoseCovariance(const JsonReader& json);

}  // namespace boresight::sessions
