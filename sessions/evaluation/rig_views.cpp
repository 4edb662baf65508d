// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/rig_views.h"

#include <algorithm>
#include <memory>

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

std::vector<View> viewsOf(const RigViews& rig, std::vector<BitImage>& masks) {
  std::vector<View> views;
  masks.resize(rig.cases.size());
  for (std::size_t v = 0; v < rig.cases.size(); ++v) {
    View view;
    view.image = rig.images[v].view();
    if (rig.masks[v]) {
      masks[v] = rig.masks[v]->view();
      view.ignore = &masks[v];
    }
    view.camera = rig.cameras[v];
    view.camera_from_rig = rig.cases[v]->rig->camera_from_rig;
    views.push_back(view);
  }
  return views;
}

/// A rig frame that is the first camera's own changes no bit of the seed.
Pose rigSeed(const Case& first) {
  const Pose& camera_from_rig = first.rig->camera_from_rig;
  if (camera_from_rig == Pose()) return first.seed_camera_from_station;
  return camera_from_rig.inverse() * first.seed_camera_from_station;
}

ordered_json viewJson(const RigViews& rig, const RigRun& run, std::size_t v) {
  const ViewReport& report = run.result.views[v];
  ordered_json json = {{"case", rig.cases[v]->id},
                       {"camera", rig.cases[v]->camera},
                       {"status", localizationStatusText(report.status)},
                       {"matches", report.correspondences},
                       {"inliers", report.inliers},
                       {"edges_used", report.edges_used},
                       {"edges_rms_px", report.edges_rms_px},
                       {"edge_support", report.support.share()}};
  if (run.result.status != LocalizationStatus::kConverged) return json;
  json["camera_from_station"] = toJson(report.camera_from_station);
  if (const auto error = viewError(rig, run, v)) json["error"] = toJson(*error);
  return json;
}

}  // namespace

std::vector<std::string> rigIds(const Dataset& dataset) {
  std::vector<std::string> ids;
  for (const Case& one : dataset.cases)
    if (one.rig && std::find(ids.begin(), ids.end(), one.rig->id) == ids.end())
      ids.push_back(one.rig->id);
  return ids;
}

RigViews readRigViews(const Dataset& dataset, const std::string& id) {
  RigViews rig;
  rig.id = id;
  for (const Case& one : dataset.cases)
    if (one.rig && one.rig->id == id) rig.cases.push_back(&one);
  const auto refuse = [&](const std::string& reason) {
    throw InputError(dataset.file, "rig \"" + id + "\"", reason);
  };
  if (rig.cases.empty()) refuse("no case names it");
  if (rig.cases.size() > kMaxViews)
    refuse("has " + std::to_string(rig.cases.size()) + " views; at most " +
           std::to_string(kMaxViews) + " are solved as one");
  const Case& first = *rig.cases.front();
  if (!first.uncertainty) refuse("neither its first case nor the station states an uncertainty");
  for (const Case* one : rig.cases) {
    if (one->station != first.station)
      refuse("shows several stations: " + first.station + " and " + one->station);
    rig.cameras.push_back(dataset.cameras.at(one->camera));
    rig.images.push_back(readCaseImage(dataset, *one));
    rig.masks.push_back(readCaseMask(dataset, *one));
  }
  const Station& station = dataset.stations.at(first.station);
  rig.scene = readStationScene(station);
  rig.feature_size_m = station.feature_size_m;
  return rig;
}

RigRun localizeViews(const RigViews& rig, LocalizerOptions options, const RunSettings& settings) {
  std::vector<BitImage> masks;
  const std::vector<View> views = viewsOf(rig, masks);
  const Case& first = *rig.cases.front();
  ViewsProblem problem;
  problem.views = views;
  problem.mesh = rig.scene.view();
  problem.rig_from_station_seed = rigSeed(first);
  problem.uncertainty = seedUncertainty(*first.uncertainty, first.seed_camera_from_station,
                                        matchedBounds(problem.mesh).centre());
  if (options.templates.feature_size_m == 0.0)
    options.templates.feature_size_m = rig.feature_size_m.value_or(0.0);
  std::vector<std::string> ids;
  for (const Case* one : rig.cases) ids.push_back(one->id);
  RunSettings summary = settings;
  summary.level = RecordLevel::kSummary;
  Runner stepped(problem, options, ids, summary);
  stepped.advance(StepUntil::kEnd);
  const JointResult& joint = stepped.joint();
  RigRun run{joint.result, views.size(), joint.digest, stepped.trace().seconds.total()};
  return run;
}

std::optional<PoseError> viewError(const RigViews& rig, const RigRun& run, std::size_t view) {
  const Case& one = *rig.cases[view];
  if (!one.truth_camera_from_station) return std::nullopt;
  return poseError(*one.truth_camera_from_station, run.result.views[view].camera_from_station,
                   one.camera_from_end_effector);
}

ordered_json toJson(const RigViews& rig, const RigRun& run) {
  const ViewsResult& result = run.result;
  ordered_json json = {{"rig", rig.id},
                       {"status", localizationStatusText(result.status)},
                       {"iterations", result.iterations},
                       {"attempts", result.attempts},
                       {"rig_from_station", toJson(result.rig_from_station)}};
  if (result.status == LocalizationStatus::kFault) json["fault"] = statusText(result.fault);
  if (result.status == LocalizationStatus::kConverged)
    json["covariance"] = toJson(result.covariance);
  json["views"] = ordered_json::array();
  for (std::size_t v = 0; v < run.views; ++v) json["views"].push_back(viewJson(rig, run, v));
  json["seconds"] = run.seconds;
  json["digest"] = run.digest;
  return json;
}

}  // namespace boresight::sessions
