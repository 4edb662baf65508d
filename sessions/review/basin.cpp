// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "sessions/evaluation/reseed.h"
#include "sessions/review/agreement_checks.h"
#include "sessions/review/checks.h"
#include "sessions/trace/record.h"

namespace boresight::sessions {
namespace {

RunPlan planFor(const ReviewSubject& subject) {
  if (subject.run) return subject.run->plan();
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = subject.loaded->source.feature_size_m.value_or(0.0);
  return RunPlan(options);
}

/// The case as it would be had somebody begun elsewhere.
LocalizationProblem problemFrom(const ReviewSubject& subject, int number) {
  const SessionCase& one = subject.loaded->source;
  const Eigen::Vector3d centre = matchedBounds(subject.loaded->scene.view()).centre();
  const Vector6d offset = drawOffset(one.uncertainty, 1.0, one.id, number);
  LocalizationProblem problem = subject.loaded->problem();
  problem.camera_from_station_seed =
      seedForOffset(subject.camera_from_station, offset, one.uncertainty.pivot, centre);
  problem.uncertainty = seedUncertainty(one.uncertainty, problem.camera_from_station_seed, centre);
  return problem;
}

void count(const ReviewSubject& subject, const LocalizationTrace& trace, BasinResult& result) {
  ++result.seeds;
  if (!trace.converged()) return;
  ++result.converged;
  if (withinRequirement(subject, trace.camera_from_station))
    ++result.returned;
  else
    result.elsewhere.push_back(trace.camera_from_station);
}

}  // namespace

BasinResult basinTest(const ReviewSubject& subject, int seeds, const std::stop_token& stop,
                      const std::function<void(const BasinResult&)>& after_each) {
  BasinResult result;
  if (subject.loaded == nullptr) return result;
  const RunPlan plan = planFor(subject);
  for (int number = 1; number <= seeds && !stop.stop_requested(); ++number) {
    const LocalizationTrace trace =
        localize(problemFrom(subject, number), plan, RecordLevel::kSummary, stop);
    if (trace.status == LocalizationStatus::kRunning) break;
    count(subject, trace, result);
    if (after_each) after_each(result);
  }
  return result;
}

}  // namespace boresight::sessions
