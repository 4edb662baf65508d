// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_result.h"

#include <nlohmann/json.hpp>

#include "sessions/io/json/json_writer.h"
#include "sessions/trace/decisive_iterations.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

RunStep stepOf(const IterationTrace& iteration, std::int32_t index) {
  RunStep step;
  step.index = index;
  step.attempt = iteration.attempt;
  step.kind = iteration.kind == IterationKind::kRefine ? "refine" : "match";
  step.level = iteration.level;
  step.status = localizationStatusText(iteration.status);
  step.threshold_px = iteration.threshold_px;
  step.templates = iteration.template_count;
  step.matches = iteration.searched_count;
  step.support = iteration.support();
  step.rms_px = iteration.rms_px();
  step.best_score = iteration.best_score;
  step.mean_score = iteration.mean_score;
  step.correction_mm = 1e3 * iteration.correction_translation_m;
  step.correction_mrad = 1e3 * iteration.correction_rotation_rad;
  step.correction_px = iteration.correction_image_px;
  step.seconds = iteration.seconds;
  step.camera_from_station = iteration.camera_from_station;
  if (!iteration.templates.empty()) step.details = matchDetails(iteration);
  return step;
}

}  // namespace

std::vector<RunStep> runSteps(const LocalizationTrace& trace, const ErrorOfPose& error_of) {
  std::vector<RunStep> steps;
  for (const auto& iteration : trace.iterations) {
    steps.push_back(stepOf(*iteration, static_cast<std::int32_t>(steps.size())));
    steps.back().error = error_of(iteration->camera_from_station);
  }
  return steps;
}

void noteTrace(const LocalizationTrace& trace, RunResult& result) {
  result.status = localizationStatusText(trace.status);
  result.message = explanation(trace);
  result.completed = trace.converged();
  result.camera_from_station = trace.camera_from_station;
  result.iterations = static_cast<std::int32_t>(trace.iterations.size());
  if (const auto matching = lastMatching(trace)) {
    result.matches = matching->searched_count;
    result.inliers = matching->pnp.inlier_count;
  }
  result.edge_support = trace.support.share();
  if (hasProbability(trace)) {
    result.probability = trace.probability;
    result.evidence_nats = trace.evidence.strongest_nats();
    result.weakest_quadrant_nats = trace.evidence.weakest_nats();
    result.region_nats = trace.evidence.region.nats;
    result.evidence_share = trace.evidence.finest().shareOfExpected();
    result.expected_nats = trace.evidence.finest().expected_nats;
  }
  result.compared_poses = static_cast<std::int32_t>(trace.hypotheses.size());
  if (trace.competitor >= 0) result.score_gap = trace.gap;
  result.competing_poses = static_cast<std::int32_t>(trace.competing_poses.size());
  if (const CompetingPose* closest = closestCompetingPose(trace))
    result.least_margin_nats = closest->margin_nats;
  result.seconds = trace.seconds;
  result.digest = trace.digest;
}

void judge(bool wrong_mesh, RunResult& result) {
  result.wrong_mesh = wrong_mesh;
  if (wrong_mesh) {
    result.success = false;
    result.false_positive = result.completed;
    result.gross_false_positive = result.completed;
    return;
  }
  if (!result.error || !result.requirement) return;
  const bool within = meetsRequirement(*result.error, *result.requirement);
  result.success = result.completed && within;
  result.false_positive = result.completed && !within;
  result.gross_false_positive = result.completed && isGross(*result.error, *result.requirement);
}

std::string comparedText(const LocalizationTrace& trace,
                         const std::function<std::optional<double>(const Pose&)>& share_of) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < trace.hypotheses.size(); ++i) {
    const PoseHypothesis& hypothesis = trace.hypotheses[i];
    const PoseEvidence& evidence = hypothesis.evidence;
    list.push_back({{"origin", originText(hypothesis)},
                    {"best", static_cast<int>(i) == trace.best_hypothesis},
                    {"competitor", static_cast<int>(i) == trace.competitor},
                    {"score", hypothesis.score},
                    {"probability", hypothesis.probability},
                    {"total_nats", evidence.finest().total_nats()},
                    {"strongest_nats", evidence.strongest_nats()},
                    {"weakest_quadrant_nats", evidence.weakest_nats()},
                    {"expected_nats", evidence.finest().expected_nats},
                    {"evidence_share", evidence.finest().shareOfExpected()},
                    {"region_nats", evidence.region.nats},
                    {"edge_support", evidence.edge_support}});
    if (hypothesis.origin == HypothesisOrigin::kCandidate)
      list.back()["searched_nats"] =
          trace.candidates[static_cast<std::size_t>(hypothesis.number)].evidence.total_nats();
    if (const auto share = share_of(hypothesis.camera_from_station))
      list.back()["requirement_share"] = *share;
  }
  return list.empty() ? "" : list.dump();
}

nlohmann::ordered_json toJson(const PoseError& error) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : kErrorParts) json[name] = error.*part;
  for (const auto& [name, part] : kModelErrorParts)
    if (error.*part) json[name] = *(error.*part);
  return json;
}

nlohmann::ordered_json toJson(const StageSeconds& seconds) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : kStages) json[name] = seconds.*part;
  return json;
}

nlohmann::ordered_json toJson(const ImageQuality& quality) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : kImageQualityParts) json[name] = quality.*part;
  return json;
}

nlohmann::ordered_json toJson(const RunResult& result) {
  nlohmann::ordered_json json = {{"id", result.case_id},         {"reseed", result.reseed},
                                 {"station", result.station},    {"tags", result.tags},
                                 {"method", result.method},      {"status", result.status},
                                 {"completed", result.completed}};
  json["success"] = result.success ? nlohmann::ordered_json(*result.success) : nullptr;
  json["false_positive"] = result.false_positive;
  json["gross_false_positive"] = result.gross_false_positive;
  if (!result.message.empty()) json["message"] = result.message;
  if (result.inputFailed()) return json;
  json["iterations"] = result.iterations;
  json["camera_from_station"] = toJson(result.camera_from_station);
  json["camera_from_station_seed"] = toJson(result.camera_from_station_seed);
  json["matches"] = result.matches;
  json["inliers"] = result.inliers;
  json["edge_support"] = result.edge_support;
  if (result.probability) {
    json["probability"] = *result.probability;
    json["evidence_nats"] = *result.evidence_nats;
    json["weakest_quadrant_nats"] = *result.weakest_quadrant_nats;
    json["region_nats"] = *result.region_nats;
    json["evidence_share"] = *result.evidence_share;
    json["expected_nats"] = *result.expected_nats;
  }
  json["compared_poses"] = result.compared_poses;
  if (!result.compared.empty()) json["compared"] = nlohmann::json::parse(result.compared);
  if (result.score_gap) json["score_gap"] = *result.score_gap;
  json["competing_poses"] = result.competing_poses;
  if (result.least_margin_nats) json["least_margin_nats"] = *result.least_margin_nats;
  if (result.image_quality) json["image_quality"] = toJson(*result.image_quality);
  if (result.error) json["error"] = toJson(*result.error);
  if (result.seed_error) json["seed_error"] = toJson(*result.seed_error);
  json["seconds"] = toJson(result.seconds);
  json["digest"] = result.digest;
  return json;
}

}  // namespace boresight::sessions
