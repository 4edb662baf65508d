// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/report_residuals.h"

#include <algorithm>
#include <cmath>

#include "sessions/annotation/predicted_place.h"
#include "sessions/session/case_marks.h"

namespace boresight::sessions {
namespace {

/// The last iteration of a kind that came to a pose, or nullptr.
const IterationTrace* lastOf(const LocalizationTrace& trace, IterationKind kind) {
  const auto found =
      std::find_if(trace.iterations.rbegin(), trace.iterations.rend(),
                   [kind](const auto& one) { return one->kind == kind && one->support() > 0; });
  return found == trace.iterations.rend() ? nullptr : found->get();
}

ReportResiduals ofEdges(const PoseReport& report, const Camera& camera,
                        const IterationTrace& iteration) {
  ReportResiduals made{"edge places of the refinement", {}};
  for (const EdgeSample& sample : iteration.refinement.samples) {
    const auto place =
        predictPlace(camera, report.pose.camera_from_station, sample.point_in_station_m);
    if (!place.valid || sample.gradient == 0.0) continue;
    made.all.push_back({place.pixel, sample.residual_px * sample.normal, sample.weight > 0.0});
  }
  return made;
}

ReportResiduals ofTemplates(const PoseReport& report, const Camera& camera,
                            const IterationTrace& iteration) {
  ReportResiduals made{"matched templates", {}};
  for (std::size_t i = 0; i < iteration.correspondences.size(); ++i) {
    const Correspondence& one = iteration.correspondences[i];
    const auto place =
        predictPlace(camera, report.pose.camera_from_station, one.point_in_station_m);
    const bool inlier = i < iteration.pnp.inlier.size() && iteration.pnp.inlier[i] != 0;
    if (place.valid) made.all.push_back({place.pixel, one.pixel - place.pixel, inlier});
  }
  return made;
}

ReportResiduals ofMarks(const PoseReport& report, const Camera& camera) {
  ReportResiduals made{"marks", {}};
  const auto found = report.session->annotations.find(report.pose.case_id);
  if (found == report.session->annotations.end()) return made;
  for (const PointPair& point : found->second->points) {
    if (!point.pixel || !point.point_in_station_m) continue;
    const auto place =
        predictPlace(camera, report.pose.camera_from_station, *point.point_in_station_m);
    if (place.valid) made.all.push_back({place.pixel, *point.pixel - place.pixel, point.enabled});
  }
  return made;
}

}  // namespace

double ReportResiduals::rms_px() const {
  double squares = 0.0;
  int count = 0;
  for (const ReportResidual& one : all) {
    if (!one.used) continue;
    squares += one.residual_px.squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0.0;
}

ReportResiduals reportResiduals(const PoseReport& report) {
  Camera camera = report.loaded->source.camera;
  if (prepareCamera(camera) != Status::kOk) return {};
  if (report.pose.source == PoseSource::kAnnotation) return ofMarks(report, camera);
  if (!report.trace) return {};
  if (const auto* refined = lastOf(*report.trace, IterationKind::kRefine))
    return ofEdges(report, camera, *refined);
  if (const auto* matched = lastOf(*report.trace, IterationKind::kMatch))
    return ofTemplates(report, camera, *matched);
  return {};
}

}  // namespace boresight::sessions
