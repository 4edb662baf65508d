// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "sessions/evaluation/reseed.h"
#include "sessions/review/agreement_checks.h"
#include "sessions/review/checks.h"
#include "sessions/review/edge_evidence.h"
#include "sessions/review/mirror_image.h"
#include "sessions/run/runner.h"

namespace boresight::sessions {
namespace {

RunPlan planFor(const ReviewSubject& subject) {
  if (subject.run) return subject.run->plan();
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = subject.loaded->source.feature_size_m.value_or(0.0);
  return RunPlan(options);
}

/// The case as it would be had somebody begun elsewhere.
LocalizationProblem problemFrom(const ReviewSubject& subject, const LoadedCase& loaded,
                                const Vector6d& offset) {
  const SessionCase& one = loaded.source;
  const Eigen::Vector3d centre = matchedBounds(loaded.scene.view()).centre();
  LocalizationProblem problem = loaded.problem();
  problem.camera_from_station_seed =
      seedForOffset(subject.camera_from_station, offset, one.uncertainty.pivot, centre);
  problem.uncertainty = seedUncertainty(one.uncertainty, problem.camera_from_station_seed, centre);
  return problem;
}

void addRival(const LoadedCase& loaded, const Pose& camera_from_station, bool mirrored,
              BasinResult& result) {
  result.rivals.push_back(
      {camera_from_station, mirrored, coverageOfPose(loaded, camera_from_station).value()});
}

void count(const ReviewSubject& subject, const LocalizationTrace& trace, BasinResult& result) {
  ++result.seeds;
  if (!trace.converged()) return;
  ++result.converged;
  if (withinRequirement(subject, trace.camera_from_station))
    ++result.returned;
  else
    addRival(*subject.loaded, trace.camera_from_station, false, result);
}

/// A station with two like halves is nearly its own mirror image: the right one must fit better.
void tryMirrorImage(const ReviewSubject& subject, const RunPlan& plan, int axis,
                    const std::stop_token& stop, BasinResult& result) {
  const auto image = mirrorImageOf(*subject.loaded, axis);
  const LocalizationTrace trace =
      localize(problemFrom(subject, *image, Vector6d::Zero()), plan, RecordLevel::kSummary, stop);
  if (trace.converged()) addRival(*image, trace.camera_from_station, true, result);
}

}  // namespace

BasinResult basinTest(const ReviewSubject& subject, int seeds, const std::stop_token& stop,
                      const std::function<void(const BasinResult&)>& after_each) {
  BasinResult result;
  if (subject.loaded == nullptr) return result;
  const RunPlan plan = planFor(subject);
  result.coverage = coverageOfPose(*subject.loaded, subject.camera_from_station).value();
  // First, so that a stop leaves what `seeds` alone says: running this many again gives the same.
  for (int axis = 0; axis < 3 && seeds > 0 && !stop.stop_requested(); ++axis)
    tryMirrorImage(subject, plan, axis, stop, result);
  for (int number = 1; number <= seeds && !stop.stop_requested(); ++number) {
    const SessionCase& one = subject.loaded->source;
    const Vector6d offset = drawOffset(one.uncertainty, 1.0, one.id, number);
    const LocalizationTrace trace =
        localize(problemFrom(subject, *subject.loaded, offset), plan, RecordLevel::kSummary, stop);
    if (trace.status == LocalizationStatus::kRunning) break;
    count(subject, trace, result);
    if (after_each) after_each(result);
  }
  return result;
}

}  // namespace boresight::sessions
