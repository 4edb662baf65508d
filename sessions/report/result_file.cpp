// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/result_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/run/image_quality.h"
#include "sessions/session/named_poses.h"
#include "sessions/session/session_file.h"
#include "sessions/trace/doubtful_pose.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

ordered_json fileJson(const std::filesystem::path& file) {
  return {{"file", file.string()}, {"sha256", sha256Text(readFileBytes(file, kMaxImageFileBytes))}};
}

ordered_json iterationJson(const IterationTrace& iteration) {
  ordered_json json = {{"attempt", iteration.attempt},
                       {"kind", iteration.kind == IterationKind::kRefine ? "refine" : "match"},
                       {"level", iteration.level},
                       {"status", localizationStatusText(iteration.status)},
                       {"edge_pixels", iteration.edge_pixel_count}};
  if (iteration.kind == IterationKind::kRefine) {
    json["samples"] = iteration.refinement.sample_count;
    json["found"] = iteration.refinement.found_count;
    json["used"] = iteration.refinement.used_count;
  } else {
    json["templates"] = iteration.template_count;
    json["template_side_px"] = iteration.template_side_px;
    json["matches"] = iteration.searched_count;
    json["inliers"] = iteration.pnp.inlier_count;
    json["best_score"] = iteration.best_score;
    json["mean_score"] = iteration.mean_score;
  }
  json["threshold_px"] = iteration.threshold_px;
  json["rms_px"] = iteration.rms_px();
  json["correction_mm"] = iteration.correction_translation_m * 1e3;
  json["correction_px"] = iteration.correction_image_px;
  json["correction_deg"] = iteration.correction_rotation_rad / kDegree_rad;
  json["camera_from_station"] = toJson(iteration.camera_from_station);
  json["seconds"] = toJson(iteration.seconds);
  return json;
}

/// What the acceptance of the pose rests on; members that the run did not come to are missing.
ordered_json acceptanceJson(const LocalizationTrace& trace, bool in_colour) {
  const SupportOptions& asked = trace.lastOptions().support;
  ordered_json json;
  if (hasProbability(trace)) {
    const PoseEvidence& evidence = trace.evidence;
    const ContourEvidence& contours = evidence.finest();
    json["probability"] = trace.probability;
    json["min_probability"] = asked.min_probability;
    json["score"] = evidence.score();
    json["share_of_expected_evidence"] = contours.shareOfExpected();
    json["evidence_nats"] = evidence.strongest_nats();
    json["edges_nats"] = contours.edges_nats;
    json["edges_expected_nats"] = contours.expected_nats;
    json["outline_nats"] = contours.outline_nats;
    json["outline_expected_nats"] = contours.outline_expected_nats;
    json["weakest_quadrant_nats"] = evidence.weakest_nats();
    json["quadrant_nats"] = contours.quadrant_nats;
    json["edge_places"] = contours.places;
    json["region_nats"] = evidence.region.nats;
    json["separated_share_of_outline"] = evidence.region.separatedShare();
    json["in_colour"] = in_colour;
  } else {
    json["min_edge_support"] = asked.min_support;
  }
  json["edge_support"] = trace.support.share();
  if (trace.edge_width.widestDirection() >= 0) {
    json["edge_width_px"] = trace.edge_width.widest_px();
    json["max_edge_width_px"] = EdgeWidth::kWidest_px;
  }
  return json;
}

/// Candidates of the search, the most evidence first.
ordered_json candidatesJson(const LocalizationTrace& trace) {
  ordered_json list = ordered_json::array();
  for (const PoseCandidate& candidate : trace.candidates)
    list.push_back({{"camera_from_station", toJson(candidate.camera_from_station)},
                    {"evidence_nats", candidate.rank_nats()}});
  return list;
}

/// Poses that the run refined and compared, in the order in which it found them.
ordered_json comparedPosesJson(const LocalizationTrace& trace) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < trace.hypotheses.size(); ++i) {
    const PoseHypothesis& hypothesis = trace.hypotheses[i];
    list.push_back({{"camera_from_station", toJson(hypothesis.camera_from_station)},
                    {"origin", originText(hypothesis)},
                    {"score", hypothesis.score},
                    {"probability", hypothesis.probability},
                    {"best", static_cast<int>(i) == trace.best_hypothesis},
                    {"competitor", static_cast<int>(i) == trace.competitor}});
  }
  return list;
}

/// Other poses that show about the same edges as the pose found.
ordered_json competingPosesJson(const LocalizationTrace& trace) {
  ordered_json list = ordered_json::array();
  for (const CompetingPose& pose : trace.competing_poses)
    list.push_back({{"camera_from_station", toJson(pose.camera_from_station)},
                    {"similarity", pose.similarity},
                    {"margin_nats", pose.margin_nats},
                    {"mirrored", pose.mirrored}});
  return list;
}

ordered_json imageJson(const GrayImage& image) {
  return {{"file", image.file.string()},
          {"sha256", image.file_sha256},
          {"pixels_sha256", image.pixels_sha256},
          {"width", image.width},
          {"height", image.height},
          {"rule", image.rule}};
}

ordered_json provenanceJson(const LocalizationTrace& trace, const RunProvenance& provenance) {
  const SessionCase& session_case = provenance.loaded->source;
  ordered_json json = {{"version", trace.version},
                       {"digest", trace.digest},
                       {"profile", provenance.profile},
                       {"options", toJson(provenance.changed_options)},
                       {"uncertainty", toJson(session_case.uncertainty)},
                       {"image", imageJson(provenance.loaded->image)},
                       {"camera", fileJson(provenance.camera_file)}};
  ordered_json meshes = ordered_json::array();
  for (const MeshInfo& info : provenance.loaded->scene.infos)
    meshes.push_back(
        {{"file", info.file.string()}, {"sha256", info.file_sha256}, {"unit", info.unit}});
  json["meshes"] = meshes;
  json["seed"] = fileJson(provenance.seed_file);
  if (!session_case.image.label.empty()) json["image_label"] = toJson(session_case.image.label);
  if (session_case.station_frame) json["station_frame"] = toJson(*session_case.station_frame);
  if (!session_case.frames.empty()) {
    ordered_json& frames = json["frames"] = ordered_json::array();
    for (const FrameTransform& transform : session_case.frames) frames.push_back(toJson(transform));
  }
  if (const auto& ignore = provenance.loaded->ignore)
    json["ignore"] = {{"file", ignore->file.string()},
                      {"sha256", ignore->file_sha256},
                      {"ignored_pixels", ignore->ignored_count}};
  if (!provenance.truth_file.empty()) json["truth"] = fileJson(provenance.truth_file);
  if (!provenance.config_file.empty()) json["config"] = fileJson(provenance.config_file);
  return json;
}

/// The pose in every named frame, and the correction to command of a converged run.
void addFrames(const LocalizationTrace& trace, const LoadedCase& loaded, ordered_json& json) {
  const SessionCase& session_case = loaded.source;
  const Pose& pose = trace.camera_from_station;
  std::optional<Matrix6d> covariance;
  if (trace.converged())
    covariance = poseCovariance(session_case, loaded.scene.view(), pose, trace.covariance).total();
  const auto named = namedPoses(session_case, pose, covariance);
  if (!named.empty()) json["frames"] = toJson(named);
  if (covariance && session_case.camera_from_end_effector)
    json["correction_to_command"] = toJson(correctionsOf(session_case, pose, *covariance));
}

}  // namespace

ordered_json resultJson(const LocalizationTrace& trace, const std::optional<PoseError>& error,
                        const RunProvenance& provenance) {
  RunResult result;
  noteTrace(trace, result);
  ordered_json json = {{"format", "boresight-result"},
                       {"version", 1},
                       {"method", provenance.method},
                       {"status", result.status},
                       {"completed", result.completed}};
  if (!result.message.empty()) json["message"] = result.message;
  json["iterations"] = result.iterations;
  json["attempts"] = trace.attempts;
  json["camera_from_station"] = toJson(trace.camera_from_station);
  json["camera_from_station_seed"] = toJson(trace.camera_from_station_seed);
  addFrames(trace, *provenance.loaded, json);
  if (trace.converged()) json["covariance"] = toJson(trace.covariance);
  json["matches"] = result.matches;
  json["inliers"] = result.inliers;
  json["edge_support"] = result.edge_support;
  const LocalizationProblem problem = provenance.loaded->problem();
  json["acceptance"] =
      acceptanceJson(trace, trace.lastOptions().search.color && problem.color.data != nullptr);
  if (const auto doubtful = doubtfulPose(trace))
    json["doubtful_pose"] = {{"camera_from_station", toJson(doubtful->camera_from_station)},
                             {"probability", doubtful->probability}};
  json["candidates"] = candidatesJson(trace);
  json["compared_poses"] = comparedPosesJson(trace);
  if (trace.competitor >= 0) json["score_gap"] = trace.gap;
  json["competing_poses"] = competingPosesJson(trace);
  if (const auto quality = imageQualityOf(problem)) json["image_quality"] = toJson(*quality);
  if (error) json["error"] = toJson(*error);
  if (!provenance.warnings.empty()) json["warnings"] = provenance.warnings;
  json["seconds"] = toJson(trace.seconds);
  json["arena_bytes"] = trace.arena_bytes;
  json["input_bytes"] = trace.memory.inputs;
  json["iteration"] = ordered_json::array();
  for (const auto& iteration : trace.iterations)
    json["iteration"].push_back(iterationJson(*iteration));
  json["provenance"] = provenanceJson(trace, provenance);
  return json;
}

}  // namespace boresight::sessions
