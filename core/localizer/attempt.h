// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/localizer/workspace.h"

namespace boresight {

/// One attempt of a run: the iterations from a seed until they converge or fail (Pham 2025, Sec.
/// III-A). The first iteration compares renders rolled about the view axis and keeps the one with
/// most inliers; windows and thresholds shrink from iteration to iteration (schedule.h). After the
/// matching iterations the pose is refined on edges. A plain value: a copy continues with the same
/// results.
class Attempt {
 public:
  Attempt() = default;
  /// `index`: number of the attempt, from 0. `iteration`: the first iteration to run.
  Attempt(int index, const Seed& seed, int iteration = 0);
  /// Refines a pose on edges, without templates, within the seed's uncertainty. With `coarse_first`
  /// the first refinement is at the coarse level, where its search reaches farther.
  Attempt(int index, const Seed& seed, const Pose& camera_from_station, bool coarse_first,
          const LoopOptions& loop);

  /// Plan of the next pass.
  PassPlan plan(const RunContext& run) const;
  /// Takes the outcome of the planned pass; kPose: the attempt has converged. Fills in the records'
  /// hypotheses, pose and corrections.
  Ruling take(const PassOutcome& outcome, const Agreement& agreement, const RunContext& run,
              std::span<Iteration, 2> records);

  /// Starts again from the seed with templates of another size: they may have caused the failure.
  void restart();
  /// Reopens a converged attempt after a view was dropped. kFailed at the iteration limit.
  Ruling goOn(const RunContext& run);

  /// The attempt before its last iteration, which started from this pose; not a draft.
  Attempt beforeLastIteration(int index, const Pose& camera_from_station_before,
                              const LocalizerOptions& options) const;

  /// The refinement at the coarse level uses a render from this pose, which may be there already.
  void renderFrom(const Pose& camera_from_station) { coarse_render_ = camera_from_station; }

  /// Refines with fewer edge places and ends at the first small correction: enough to compare poses
  /// with each other. Until beforeLastIteration().
  void draft() { is_draft_ = true; }

  /// Number of the attempt, from 0.
  int index() const { return index_; }
  /// Whether the next pass starts an iteration.
  bool atIterationStart() const { return hypothesis_ == 0; }

  /// The estimate so far.
  const Pose& camera_from_station() const { return camera_from_station_; }
  /// Covariance of the estimate, as PnP or the refinement gives it.
  const Matrix6d& covariance() const { return covariance_; }
  /// Index of the record of the latest iteration.
  int record() const { return record_; }

 private:
  Ruling takeHypothesis(const PassOutcome& outcome, const Agreement& agreement,
                        const RunContext& run, std::span<Iteration, 2> records);
  Ruling finishIteration(Stage stage, const Pose& camera_from_station, const Matrix6d& covariance,
                         const RunContext& run, Iteration& record);
  bool isConvincing(int record, const Iteration& iteration, const LoopOptions& loop) const;
  void startIteration();

  int index_ = 0;
  int size_index_ = 0;  ///< index of the template size
  int iteration_ = 0;
  int hypothesis_ = 0;  ///< of the iteration
  int record_ = 0;
  bool is_draft_ = false;
  bool coarse_first_ = false;  ///< the next refinement is at the coarse level
  bool has_best_ = false;      ///< the other record holds the best hypothesis so far
  int small_corrections_ = 0;
  Seed seed_;
  std::optional<Pose> coarse_render_;  ///< pose of the render at the coarse level
  PosePrior anchor_;                   ///< the seed with its uncertainty as a Gaussian
  PoseEstimate matched_;               ///< from the latest templates
  Pose camera_from_station_;
  Matrix6d covariance_ = Matrix6d::Zero();
  std::array<Agreement, 2> agreement_;  ///< of each record
  std::array<Stage, 2> reached_{};      ///< by each record
};

/// Counts of a match iteration and the cost of its pose.
HypothesisSummary summaryOf(const Iteration& iteration);

}  // namespace boresight
