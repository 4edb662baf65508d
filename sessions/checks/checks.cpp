// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/checks.h"

#include <algorithm>
#include <utility>

#include "sessions/checks/edge_evidence.h"
#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/run/runner.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

RunPlan planFor(const ReviewSubject& subject) {
  if (subject.run) return subject.run->plan();
  return RunPlan(withFeatureSize(defaultProfile(), subject.loaded->source.feature_size_m));
}

/// The case with its seed displaced by `offset`.
LocalizationProblem problemFrom(const ReviewSubject& subject, const LoadedCase& loaded,
                                const Vector6d& offset) {
  const SessionCase& session_case = loaded.source;
  const Eigen::Vector3d centre = matchedBounds(loaded.scene.view()).centre();
  LocalizationProblem problem = loaded.problem();
  problem.camera_from_station_seed =
      seedForOffset(subject.camera_from_station, offset, session_case.uncertainty.pivot, centre);
  problem.uncertainty =
      seedUncertainty(session_case.uncertainty, problem.camera_from_station_seed, centre);
  return problem;
}

void addCompeting(const LoadedCase& loaded, const Pose& camera_from_station, bool mirrored,
                  ConvergenceResult& result) {
  result.competing.push_back(
      {camera_from_station, mirrored, coverageOfPose(loaded, camera_from_station).value()});
}

void count(const ReviewSubject& subject, const LocalizationTrace& trace,
           ConvergenceResult& result) {
  ++result.seeds;
  if (!trace.converged()) return;
  ++result.converged;
  if (withinRequirement(subject, trace.camera_from_station))
    ++result.returned;
  else
    addCompeting(*subject.loaded, trace.camera_from_station, false, result);
}

/// A station with two like halves is nearly its own mirror image: the right one must fit better.
void tryMirrorImage(const ReviewSubject& subject, const RunPlan& plan, int axis,
                    const std::stop_token& stop, ConvergenceResult& result) {
  const auto image = mirrorImageOf(*subject.loaded, axis);
  const LocalizationTrace trace =
      localize(problemFrom(subject, *image, Vector6d::Zero()), plan, RecordLevel::kSummary, stop);
  if (trace.converged()) addCompeting(*image, trace.camera_from_station, true, result);
}

constexpr CheckName kReturned{"convergence_returned", "Convergence from other seeds"};
/// Of coverage over none at all.
constexpr double kNothingSeen = 10.0;
constexpr CheckName kCompeting{"convergence_competing", "Best competing pose"};

std::string foundText(const ConvergenceResult& convergence) {
  const auto elsewhere = std::ranges::count(convergence.competing, false, &ConvergedPose::mirrored);
  return "Of " + std::to_string(convergence.seeds) + " other seeds " +
         std::to_string(convergence.returned) + " returned to this pose " +
         (convergence.symmetric ? "or one that differs by a declared symmetry, and " : "and ") +
         std::to_string(elsewhere) + " converged elsewhere.";
}

/// A competing pose that fits worse is no evidence against the pose: a nearly symmetric station has
/// many.
Check competingPoseCheck(const ConvergenceResult& convergence, const CheckLimits& limits) {
  const auto best = std::ranges::max_element(convergence.competing, {}, &ConvergedPose::coverage);
  if (best == convergence.competing.end() && convergence.returned == 0)
    return notAskedCheck(kCompeting, "No other seed converged to a pose for comparison.");
  if (best == convergence.competing.end())
    return statedCheck(kCompeting, true, "No other pose and no mirror image of the station fits.",
                       "");
  const std::string what = best->mirrored ? "a mirror image of the station" : "another pose";
  const double ratio =
      convergence.coverage > 0.0 ? best->coverage / convergence.coverage : kNothingSeen;
  return measuredCheck(
      kCompeting, "%", 100.0 * ratio, limits.competing_percent, LimitSide::kAtMost,
      "The image shows " + percentText(convergence.coverage) +
          " of the edges that this pose predicts, and " + what + " " + percentText(best->coverage) +
          ".",
      best->mirrored ? "The mesh is mirrored or of another object."
                     : "The competing pose fits better: run from it and compare the overlays.");
}

}  // namespace

std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const ConvergenceResult& convergence) {
  std::vector<Check> checks;
  PredictedEdges edges;
  if (subject.loaded != nullptr)
    edges = predictEdges(subject.loaded->source.camera, subject.loaded->scene.view(),
                         subject.camera_from_station);
  addRunChecks(subject, limits, checks);
  addPrecisionChecks(subject, limits, checks);
  addImageChecks(subject, limits, checks);
  addEdgeChecks(subject, limits, edges, checks);
  addConvergenceChecks(convergence, limits, checks);
  addAgreementChecks(subject, limits, checks);
  addOnboardCheck(subject, checks);
  return checks;
}

ConvergenceResult convergenceTest(const ReviewSubject& subject, int seeds,
                                  const std::stop_token& stop,
                                  const std::function<void(const ConvergenceResult&)>& after_each) {
  ConvergenceResult result;
  if (subject.loaded == nullptr || seeds <= 0) return result;
  const RunPlan plan = planFor(subject);
  result.symmetric = !subject.loaded->source.symmetries.empty();
  result.coverage = coverageOfPose(*subject.loaded, subject.camera_from_station).value();
  // Mirror images come first: also after a stop, the result depends on its number of seeds alone.
  for (int axis = 0; axis < 3 && !stop.stop_requested(); ++axis)
    tryMirrorImage(subject, plan, axis, stop, result);
  for (int number = 1; number <= seeds && !stop.stop_requested(); ++number) {
    const SessionCase& session_case = subject.loaded->source;
    const Vector6d offset = drawOffset(session_case.uncertainty, 1.0, session_case.id, number);
    const LocalizationTrace trace =
        localize(problemFrom(subject, *subject.loaded, offset), plan, RecordLevel::kSummary, stop);
    if (trace.status == LocalizationStatus::kRunning) break;
    count(subject, trace, result);
    if (after_each) after_each(result);
  }
  return result;
}

bool isConvergenceCheck(const std::string& check_id) {
  return check_id == kReturned.id || check_id == kCompeting.id;
}

void addConvergenceChecks(const ConvergenceResult& convergence, const CheckLimits& limits,
                          std::vector<Check>& checks) {
  if (convergence.seeds == 0)
    return addNotAsked({kReturned, kCompeting},
                       "No convergence test: a competing pose is not excluded.", checks);
  checks.push_back(measuredCheck(
      kReturned, "%", 100.0 * convergence.returned / convergence.seeds, limits.convergence_percent,
      LimitSide::kAtLeast, foundText(convergence),
      "Convergence depends on the seed: compare with annotations or with another image."));
  checks.push_back(competingPoseCheck(convergence, limits));
}

std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis) {
  auto result = std::make_unique<LoadedCase>();
  result->source = loaded.source;
  result->image = loaded.image;
  result->scene = mirrored(loaded.scene, static_cast<MirrorAxis>(axis));
  result->ignore = loaded.ignore;
  if (result->ignore) result->ignore_bits = result->ignore->view();
  return result;
}

}  // namespace boresight::sessions
