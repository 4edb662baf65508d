// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/observations.h"

#include <algorithm>

#include "core/geometry/camera.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {
namespace {

/// Errors of neighbouring edge places are alike: this number of them an image counts as that many
/// independent ones. With 200, errors of rendered cameras are 1.75 times the stated sigmas.
constexpr std::size_t kEdgePlaces = 65;
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
  const std::size_t step = std::max<std::size_t>(1, (used.size() + kEdgePlaces - 1) / kEdgePlaces);
  const double sigma_px = std::max(refinement.rms_px, kSmallestSigma_px);
  for (std::size_t i = 0; i < used.size(); i += step) {
    Eigen::Vector2d predicted;
    if (!project(session_case.camera, refinement.camera_from_station * used[i]->point_in_station_m,
                 predicted))
      continue;
    view.points.push_back({used[i]->point_in_station_m,
                           predicted + used[i]->residual_px * used[i]->normal(), used[i]->normal(),
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
