// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/kernels.h"
#include "core/localizer/attempt.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/pass.h"
#include "core/localizer/pose_comparison.h"
#include "core/localizer/problem.h"
#include "core/localizer/stage.h"
#include "core/localizer/workspace.h"

namespace boresight {

/// Render-and-compare localization (Pham 2025), one bounded slice per call. The flight loop, the
/// command line, a window's worker and a recorder call the same `step()`; it never calls back,
/// pauses, draws or logs. After construction nothing allocates: all memory is one block
/// (PassMemory).
///
/// Pass runs the stages. Policies decide which pass comes next: Attempt plans the iterations,
/// PoseComparison the poses from which attempts start. A run that searches takes the refined pose
/// with the best evidence (PoseComparison). From a near seed it first refines the seed alone, and
/// ends there when the pose is probable. At the end the final pose is compared with other poses
/// that show about the same edges.
///
/// A caller with threads may distribute the independent tasks of a stage:
///
///     while (!finished) {
///       for task in 0 ... tasks() - 1, at the same time:  runTask(task, worker)
///       finished = step().finished
///     }
///
/// `step()` runs the remaining tasks: the results have the same bits with any number of workers.
class Localizer {
 public:
  /// Largest number of workers.
  static constexpr int kMaxWorkers = PassMemory::kMaxWorkers;

  /// `memory` (requiredBytes() of it) and data of `problem` must outlive the localizer. `status()`
  /// reports whether it can run: kInvalidOption, kInvalidImage (its size is not the camera's or the
  /// ignore mask's), kInvalidCamera (not prepared), kInvalidPose (not finite, quaternion not of
  /// unit length, negative uncertainty), kInvalidMesh, kArenaTooSmall. If it cannot run, the first
  /// step ends the run as a fault. `kernels` (those that the memory was measured for) change only
  /// the run time.
  Localizer(const LocalizationProblem& problem, const LocalizerOptions& options,
            std::span<std::byte> memory, int workers = 1, Kernels kernels = Kernels::kPortable);

  /// kOk when it can run.
  Status status() const { return status_; }

  /// One slice; after `finished` it does nothing.
  StepReport step();

  /// Number of tasks that may run at the same time before the next step.
  int tasks() const { return pass_.tasks(); }
  /// Runs a task with the scratch of a worker. Each task at most once between two steps; calls at
  /// the same time need different tasks and different workers.
  void runTask(int task, int worker) { pass_.runTask(task, worker); }

  /// Restarts with another problem (such as the next image of a sequence) and other options,
  /// without reallocating; data of the problem must outlive the run. On kInvalidPose,
  /// kInvalidOption and kArenaTooSmall (more memory needed) the old run continues.
  Status restart(const LocalizationProblem& problem, const LocalizerOptions& options);

  /// Whether the next step starts an iteration.
  bool isBetweenIterations() const;
  /// Takes other options for the iterations that follow. Returns false without effect when not
  /// between iterations, or when an option is out of range or fixed for a run (firstFixedOption).
  /// Changed options are included in the digest.
  [[nodiscard]] bool changeOptions(const LocalizerOptions& options);

  /// Leaves the matching to the caller, for methods other than WHS in the same loop; call before
  /// the first step. Every match stage then waits for supplyMatches(), and the renders also fill
  /// `surfaces` (of the level's size, or larger), which must outlive the run. Included in the
  /// digest.
  void matchOutside(const SurfaceRender& surfaces) { pass_.matchOutside(surfaces); }
  /// Whether step() waits for matches: then the workspace's iteration holds render and templates.
  bool awaitsMatches() const { return pass_.needs() == PassNeed::kMatches; }
  /// One entry per template, in the order of the templates; or other items of the render, which
  /// replace the templates. Entries that are not finite count as not found. kCapacityExceeded for
  /// more than templates.count, kInvalidOption when no matches are awaited; both change nothing.
  Status supplyMatches(std::span<const SuppliedMatch> supplied) {
    return pass_.supplyMatches(supplied);
  }

  /// Valid between two steps.
  ///@{
  const Workspace& workspace() const { return pass_.workspace(); }
  const LocalizationProblem& problem() const { return pass_.problem(); }
  const LocalizerOptions& options() const { return pass_.options(); }
  const MemoryUse& memoryUse() const { return pass_.memory().use(); }
  std::size_t highWaterBytes() const { return pass_.memory().highWaterBytes(); }
  ///@}
  /// SHA-256 over options, inputs and every intermediate up to now; large arrays (image, mask,
  /// mesh, edges, renders, samples) enter with their CRC-32 (run_digest.h).
  std::array<std::uint8_t, 32> digest() const { return pass_.digest().digest(); }

 private:
  /// The policy that plans the next pass.
  enum class Phase : std::uint8_t {
    kEdges = 0,
    kNearSearch,
    kSearch,
    kIterate,
    kWeigh,
    kAccept,
    kCompare,
    kEnded
  };

  Status begin(const LocalizationProblem& problem, const LocalizerOptions& options);
  PassPlan plan() const;
  StepReport decide(StepReport report);
  StepReport iterated(const Ruling& ruling);
  StepReport weighed();
  EdgePlaces edgePlaces() const;
  bool concernsOneHypothesis() const;
  StepReport accepted(LocalizationStatus status, const StepReport& report);
  StepReport compared(const StepReport& report);
  StepReport conclude(LocalizationStatus status, const StepReport& report);
  StepReport fail(const Ruling& ruling);
  StepReport searchAll(const StepReport& report);
  StepReport follow(PoseComparison::Next next, LocalizationStatus status, const StepReport& report);
  StepReport show(const Ruling& ruling);
  Agreement agreement() const;
  StepReport finish(LocalizationStatus status, StepReport report);
  void iterate(const Attempt& attempt);
  bool startsNear() const;
  void startComparison();
  bool searches() const { return pass_.searches(); }

  std::span<std::byte> memory_;
  int workers_;
  Kernels kernels_;
  Status status_ = Status::kOk;
  Pass pass_;
  Matrix6d covariance_ = Matrix6d::Zero();  ///< of the final pose
  Phase phase_ = Phase::kEdges;
  PassKind comparison_kind_ = PassKind::kCompare;  ///< of the final pose
  Attempt attempt_;
  PoseComparison comparison_;
};

}  // namespace boresight
