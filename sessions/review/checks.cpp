// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/checks.h"

#include "sessions/review/agreement_checks.h"
#include "sessions/review/basin_checks.h"
#include "sessions/review/edge_checks.h"
#include "sessions/review/onboard_check.h"
#include "sessions/review/precision_checks.h"
#include "sessions/review/predicted_edges.h"
#include "sessions/review/run_checks.h"

namespace boresight::sessions {

std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const std::optional<BasinResult>& basin) {
  std::vector<Check> checks;
  PredictedEdges edges;
  if (subject.loaded != nullptr)
    edges = predictEdges(subject.loaded->source.camera, subject.loaded->scene.view(),
                         subject.camera_from_station);
  addRunChecks(subject, limits, checks);
  addPrecisionChecks(subject, limits, checks);
  addEdgeChecks(subject, limits, edges, checks);
  addBasinChecks(basin, limits, checks);
  addAgreementChecks(subject, limits, checks);
  addOnboardCheck(subject, checks);
  return checks;
}

}  // namespace boresight::sessions
