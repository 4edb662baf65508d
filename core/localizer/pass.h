// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/digest.h"
#include "core/base/nth.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/memory_seal.h"
#include "core/localizer/pass_memory.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/localizer/stage.h"
#include "core/localizer/workspace.h"
#include "core/pnp/normal_equations.h"

namespace boresight {

/// Input from outside that a pass waits for.
enum class PassNeed : std::uint8_t {
  kNothing = 0,
  kMatches,  ///< supplyMatches(), after matchOutside()
  kPose,     ///< supplyPose(), after solveOutside(): matched, or failed() gives the reason
  kRound,    ///< endRound(), after solveOutside(): the edges of a refinement round are searched
};

/// The pose of a hypothesis that several views share, in the frame of one of them.
struct JointPose {
  LocalizationStatus status = LocalizationStatus::kPnpFailed;  ///< kRunning: there is a pose
  Pose camera_from_station;                                    ///< of the view
  /// Over (rotation rad, translation m), left perturbation.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t samples = 0;  ///< drawn by RANSAC
};

/// Runs the stages of one pass, one bounded slice per step: edges, or search, or
/// render -> templates -> match -> pose, or render -> refine, or one of the measurements of a pose.
/// It fills the plan's record and the digest. It contains no policy.
///
/// Tasks are those of Localizer.
class Pass {
 public:
  Pass() = default;
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  /// Checks the problem and lays out the memory. Errors as of Localizer::status().
  Status create(const LocalizationProblem& problem, const LocalizerOptions& options,
                std::span<std::byte> block, int workers, Kernels kernels);

  /// Starts a pass; the previous pass must have ended.
  void begin(const PassPlan& plan);
  /// Whether a pass has begun and not ended.
  bool running() const { return running_; }
  /// One slice; does nothing while the pass waits for input from outside.
  StepReport step();
  /// Outcome of the last pass.
  const PassOutcome& outcome() const { return outcome_; }

  /// Number of tasks that may run at the same time before the next step; 0 between two passes.
  int tasks() const;
  /// Runs a task with the scratch of a worker. Each task at most once between two steps.
  void runTask(int task, int worker);

  /// Input from outside that the pass waits for.
  PassNeed needs() const;
  /// Leaves matching to the caller; renders also fill `surfaces`. See Localizer::matchOutside.
  void matchOutside(const SurfaceRender& surfaces);
  /// False when the caller matches: then every attempt starts from the seed.
  bool searches() const { return options_.search.enabled && !match_outside_; }
  /// Takes matches in place of those of WHS. kInvalidOption when the pass waits for none,
  /// kCapacityExceeded when there are more than its memory holds.
  Status supplyMatches(std::span<const SuppliedMatch> supplied);

  /// Leaves poses and refinement rounds to the caller, who solves several views as one. A pass that
  /// fails before its pose then continues without matches: other views may have enough.
  void solveOutside() { solve_outside_ = true; }
  /// Why the view does not take part in the pass; kRunning when it does.
  LocalizationStatus failed() const { return failed_; }
  /// Ends a match pass with the pose of all views. Inliers and residuals of this view's
  /// correspondences are filled in before, in record().pnp.
  void supplyPose(const JointPose& joint);
  /// Normal equations of the view's edges in the refinement round.
  const EdgeEquations& round() const { return round_; }
  /// The refinement stage, for a refinement of several views.
  EdgeRefinement& refinement() { return memory_.refinement; }
  /// Ends a round after the refinement was moved; `ends`: this was the last round.
  void endRound(Status status, bool ends);

  /// Shows the record of a ruling, and counts it when it is complete.
  void show(const Ruling& ruling);
  /// Takes other options from the next pass on; see firstFixedOption.
  void changeOptions(const LocalizerOptions& options);
  /// Whether the memory that must not change during a run is unchanged.
  bool memoryHolds() const;
  /// Sets how the run ended and writes it to the digest.
  void finish(LocalizationStatus status, const Pose& camera_from_station,
              const Matrix6d& covariance);

  /// Context for the policies.
  RunContext context() const {
    return {options_, problem_.camera, scene_, levels_, problem_.end_effector_in_camera_m};
  }
  /// Whether candidates of the search wait to be refined; the next search pass continues.
  bool searchIsSuspended() const { return memory_.search.isSuspended(); }
  /// The problem of the run.
  const LocalizationProblem& problem() const { return problem_; }
  /// The options of the run.
  const LocalizerOptions& options() const { return options_; }
  /// The plan of the pass under way.
  const PassPlan& plan() const { return plan_; }
  /// Results of all stages so far.
  const Workspace& workspace() const { return workspace_; }
  /// Results of all stages so far.
  Workspace& workspace() { return workspace_; }
  /// The stages and their memory.
  const PassMemory& memory() const { return memory_; }
  /// The stages and their memory.
  PassMemory& memory() { return memory_; }
  /// The record of an iteration, by its index in memory.
  const Iteration& recordAt(int index) const { return nth(memory_.records, index); }
  /// The record of the iteration under way.
  Iteration& record() { return nth(memory_.records, plan_.record); }
  /// The record of the iteration under way.
  const Iteration& record() const { return recordAt(plan_.record); }
  /// The digest of all that was computed so far.
  const DigestWriter& digest() const { return digest_; }

 private:
  void dropOtherEdges();
  void prepareRecord();
  EdgeRender& renderMemory();
  bool keepsRender(const Iteration& iteration) const;

  StepReport stepEdges();
  StepReport stepSearch();
  bool beginSearch();
  StepReport stepRender();
  StepReport stepTemplates();
  StepReport stepMatch();
  StepReport stepPose();
  StepReport stepRefine();
  StepReport stepOutsideRound();
  StepReport stepSupport();
  StepReport stepCompare();
  StepReport stepSearchAgain();
  void takeMirrorImage(std::span<const PoseCandidate> candidates);
  void takeOther(std::span<const PoseCandidate> candidates);
  void beginSupport();
  PoseEvidence measuredEvidence();
  StepReport takeEvidence(PoseEvidence evidence);
  Status beginPose();
  Status beginRefinement();
  Status continueRender(bool& complete);
  bool beginMatch(int index, WhsSearch& search);
  void finishMatch(int index, const WhsSearch& search);
  void collectCorrespondences();

  StepReport end(Stage stage);
  StepReport endFailed(Stage stage, LocalizationStatus status);
  StepReport endFaulted(Stage stage, Status fault);

  LocalizationProblem problem_;
  LocalizerOptions options_;
  PassMemory memory_;
  RunLevels levels_;
  BoundingBox scene_;  ///< of the matched parts, station frame
  SearchProblem searched_;
  Workspace workspace_;
  DigestWriter digest_;
  MemorySeal seal_;

  PassPlan plan_;
  PassOutcome outcome_;
  bool running_ = false;
  Stage stage_ = Stage::kEdges;
  bool stage_begun_ = false;
  bool task_begun_ = false;         ///< by step(), which then also ends it
  bool evidence_complete_ = false;  ///< of a support pass

  bool match_outside_ = false;
  bool matches_supplied_ = false;
  SurfaceRender surfaces_;
  bool solve_outside_ = false;
  bool solver_waits_ = false;  ///< a pose or a round is needed
  LocalizationStatus failed_ = LocalizationStatus::kRunning;
  EdgeEquations round_;
};

}  // namespace boresight
