// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/observations.h"

#include <algorithm>

#include "core/base/scatter.h"
#include "core/geometry/camera.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {
namespace {

/// Errors of neighbouring edge places are alike: this number of them an image counts as that many
/// independent ones. With 200, errors of rendered cameras are 1.75 times the stated sigmas.
constexpr std::int32_t kEdgePlaces = 65;
constexpr double kSmallestSigma_px = 0.3;
constexpr double kSmallestWeight = 0.5;  ///< robust weight of a place that the refinement used

CalibrationView annotatedView(const Session& session, const SessionCase& session_case) {
  CalibrationView view;
  view.case_id = session_case.id;
  const auto found = session.annotations.find(session_case.id);
  if (found == session.annotations.end()) return view;
  for (const PointPair& pair : found->second->points)
    if (pair.used())
      view.points.push_back(
          {*pair.point_in_station_m, *pair.pixel, Eigen::Vector2d::Zero(), pair.sigma_px});
  if (view.points.size() < kFewestPoints) return view;
  const auto solved = solveCaseAnnotations(session, session_case.id, false);
  if (const auto pose = solved.camera_from_station())
    view.camera_from_station = *pose;
  else
    view.points.clear();
  return view;
}

/// Nothing of a run that did not converge, or did not refine on edges. Its residuals are of the
/// camera that it ran with.
CalibrationView runView(const Session& session, const SessionCase& session_case) {
  CalibrationView view;
  view.case_id = session_case.id;
  if (session.lastRunOf(session_case.id) == nullptr) return view;
  const LocalizationTrace run = loadRun(currentRunOf(session, session_case.id));
  if (!run.converged() || run.iterations.empty()) return view;
  view.camera_from_station = run.camera_from_station;
  const RefinementTrace& refinement = run.iterations.back()->refinement;
  std::vector<const EdgeSample*> used;
  for (const EdgeSample& sample : refinement.samples)
    if (sample.weight > kSmallestWeight) used.push_back(&sample);
  const auto count = static_cast<std::int32_t>(used.size());
  const std::int32_t stride = std::max(1, (count + kEdgePlaces - 1) / kEdgePlaces);
  const double sigma_px = std::max(refinement.rms_px, kSmallestSigma_px);
  for (std::int32_t k = 0; scattered(k, stride) < count; ++k) {
    const EdgeSample& sample = *used[static_cast<std::size_t>(scattered(k, stride))];
    Eigen::Vector2d predicted;
    if (!project(session_case.camera, refinement.camera_from_station * sample.point_in_station_m,
                 predicted))
      continue;
    view.points.push_back({sample.point_in_station_m,
                           predicted + sample.residual_px * sample.normal(), sample.normal(),
                           sigma_px});
  }
  return view;
}

}  // namespace

std::vector<CalibrationView> observationsOf(const Session& session, ObservationSource source) {
  std::vector<CalibrationView> views;
  for (const auto& session_case : session.cases) {
    CalibrationView view = source == ObservationSource::kAnnotations
                               ? annotatedView(session, *session_case)
                               : runView(session, *session_case);
    if (view.points.size() >= kFewestPoints) views.push_back(std::move(view));
  }
  return views;
}

}  // namespace boresight::sessions
