// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/run/image_quality.h"
#include "sessions/trace/match_details.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A case with this tag is far.
inline constexpr const char* kFarTag = "far";

/// The parts of a time and of an error, by their names in files. Model errors are empty when not
/// requested.
inline constexpr std::pair<const char*, double StageSeconds::*> kStages[] = {
    {"initialization", &StageSeconds::initialization},
    {"rendering", &StageSeconds::rendering},
    {"matching", &StageSeconds::matching},
    {"pose", &StageSeconds::pose},
    {"refinement", &StageSeconds::refinement}};
inline constexpr std::pair<const char*, double PoseError::*> kErrorParts[] = {
    {"normal_mm", &PoseError::normal_mm},
    {"lateral_mm", &PoseError::lateral_mm},
    {"rotation_mrad", &PoseError::rotation_mrad},
    {"in_plane_mrad", &PoseError::in_plane_mrad},
    {"geodesic_mrad", &PoseError::geodesic_mrad}};
inline constexpr std::pair<const char*, std::optional<double> PoseError::*> kModelErrorParts[] = {
    {"projection_px", &PoseError::projection_px},
    {"mssd_mm", &PoseError::mssd_mm},
    {"mspd_px", &PoseError::mspd_px},
    {"add_mm", &PoseError::add_mm},
    {"adi_mm", &PoseError::adi_mm}};

/// Stored data of one iteration of a run.
struct RunStep {
  std::int32_t index = 0;    ///< over all attempts, from 0
  std::int32_t attempt = 0;  ///< as in IterationTrace, like the members below
  std::string kind;          ///< "match" or "refine"
  std::int32_t level = 0;
  std::string status;  ///< localizationStatusText()
  double threshold_px = 0.0;
  std::int32_t templates = 0;
  std::int32_t matches = 0;  ///< templates that were searched for
  std::int32_t support = 0;  ///< inliers, or edge places used by a refinement
  double rms_px = 0.0;
  double best_score = 0.0;
  double mean_score = 0.0;
  double correction_mm = 0.0;
  double correction_mrad = 0.0;
  double correction_px = 0.0;
  StageSeconds seconds;
  Pose camera_from_station;           ///< after
  std::optional<PoseError> error;     ///< of that pose, without the errors of BOP
  std::vector<MatchDetails> details;  ///< one per template, where the trace has them
};

/// The error of a pose of a run; nothing where the truth is not known.
using ErrorOfPose = std::function<std::optional<PoseError>(const Pose& camera_from_station)>;

/// One per iteration of the trace. Match details are included when the trace was recorded in full.
std::vector<RunStep> runSteps(const LocalizationTrace& trace, const ErrorOfPose& error_of);

/// Stored data of one run of a batch.
struct RunResult {
  std::string case_id;
  std::int64_t dataset_index = 0;  ///< of the case in its dataset, from 0
  std::int32_t reseed = 0;         ///< 0: the seed of the dataset
  std::string station;
  std::string method;
  std::vector<std::string> tags;

  /// LocalizationStatus as text, or "input_error", "method_error" (the method failed), or
  /// "bad_seed" (the station is not visible from it).
  std::string status;
  std::string message;  ///< why it did not converge; empty otherwise
  bool completed = false;
  std::optional<bool> success;  ///< empty without truth or requirement
  bool false_positive = false;
  bool gross_false_positive = false;
  bool wrong_mesh = false;  ///< deliberately not the case's own: a negative test

  Pose camera_from_station_seed;
  Pose camera_from_station;
  std::int32_t iterations = 0;
  std::int32_t matches = 0;  ///< of lastMatching(); 0 also without one
  std::int32_t inliers = 0;  ///< likewise
  double edge_support = 0.0;
  /// Of runs with a search that found a pose: probability that the pose is correct, and its
  /// evidence.
  std::optional<double> probability;
  std::optional<double> evidence_nats;          ///< ContourEvidence::strongest_nats()
  std::optional<double> weakest_quadrant_nats;  ///< ContourEvidence::weakest_nats()
  std::optional<double> region_nats;            ///< RegionEvidence::nats
  std::optional<double> evidence_share;         ///< ContourEvidence::shareOfExpected()
  std::optional<double> expected_nats;          ///< ContourEvidence::expected_nats
  std::int32_t compared_poses = 0;              ///< refined and measured
  std::string compared;              ///< these poses as a JSON list, comparedText(); may be empty
  std::optional<double> score_gap;   ///< to the best other pose that was compared
  std::int32_t competing_poses = 0;  ///< that the image also supports
  std::optional<double> least_margin_nats;    ///< of the pose's evidence over theirs
  std::optional<ImageQuality> image_quality;  ///< at the seed's projection of the station
  std::optional<PoseError> error;
  std::optional<PoseError> seed_error;
  std::optional<Requirement> requirement;
  StageSeconds seconds;
  std::string digest;
  /// RunInputs::sha256(), or the SHA-256 of a frame's 8-bit pixels; empty when the input could not
  /// be read, and in files of earlier versions.
  std::string inputs_sha256;
  std::vector<RunStep> steps;  ///< of a run in this process; from a results file: readSteps

  bool inputFailed() const { return status == "input_error"; }
  /// Error of a completed run on the case's own mesh; null otherwise: a pose found with another
  /// mesh is wrong at any distance from the truth.
  const PoseError* completedError() const {
    return completed && !wrong_mesh && error ? &*error : nullptr;
  }
  bool hasTag(const std::string& tag) const { return std::ranges::count(tags, tag) > 0; }
};

/// The poses that a run compared, as a JSON list: origin, score, probability and evidence of each.
/// `share_of` gives requirementShare() of a pose's error, where it is known.
std::string comparedText(const LocalizationTrace& trace,
                         const std::function<std::optional<double>(const Pose&)>& share_of);

/// Fills in the outcome of a run.
void noteTrace(const LocalizationTrace& trace, RunResult& result);

/// Decides success and false positives from the error and the requirement; with a mesh that is not
/// the case's own every completed run is a gross false positive.
void judge(bool wrong_mesh, RunResult& result);

nlohmann::ordered_json toJson(const PoseError& error);
nlohmann::ordered_json toJson(const StageSeconds& seconds);
nlohmann::ordered_json toJson(const ImageQuality& quality);
/// A line of results.jsonl.
nlohmann::ordered_json toJson(const RunResult& result);

}  // namespace boresight::sessions
