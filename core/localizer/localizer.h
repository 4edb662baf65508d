// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/digest.h"
#include "core/base/kernels.h"
#include "core/localizer/linked_view.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/localizer/rival.h"
#include "core/localizer/self_similarity.h"
#include "core/localizer/wide_search.h"
#include "core/localizer/workspace.h"
#include "core/match/warped_search.h"

namespace boresight {

enum class Stage : std::uint8_t {
  kEdges = 0,
  kRender,
  kTemplates,
  kMatch,
  kPose,
  kRefine,
  kSupport,
  kFinished,
};
const char* stageText(Stage stage);

/// Bytes of a localizer's block: what lives throughout, what construction takes besides (given back
/// before the first step), and what each stage takes besides; these share the same memory.
struct MemoryUse {
  std::size_t kept = 0;          ///< bytes that live throughout
  std::size_t construction = 0;  ///< bytes that construction takes besides
  /// Bytes that each stage takes besides.
  std::array<std::size_t, static_cast<std::size_t>(Stage::kFinished)> stage{};

  /// High-water mark of a stage.
  std::size_t of(Stage at) const {
    return at < Stage::kFinished ? kept + stage[static_cast<std::size_t>(at)] : kept;
  }
  /// High-water mark of the whole: what the block must hold.
  std::size_t total() const;
};

/// What one step did.
struct StepReport {
  Stage stage = Stage::kEdges;      ///< the stage that was worked on
  bool stage_complete = false;      ///< the stage is done
  bool iteration_complete = false;  ///< its record is whole, up to the stage that failed
  bool finished = false;            ///< the run has ended; further steps do nothing

  /// A step on a stage inside an iteration.
  static StepReport of(Stage stage, bool stage_complete) { return {stage, stage_complete}; }
};

/// Render-and-compare localization (Pham 2025), one bounded slice per call. The flight loop, the
/// command line, a window's worker and a recorder are callers of the same `step()`; nothing in here
/// calls back, pauses, draws or logs. After construction nothing allocates.
///
/// All memory is one block: first what lives throughout (adjacency, ray grids, edge maps from the
/// finest level that is matched on, renders, matches), then one piece that the stages use in turn.
/// What a stage leaves in it stays until the next step that works on another stage: edge maps finer
/// than the finest level until the first render, the samples of a refinement until the next render.
///
/// A caller with threads of its own may share out the stages that consist of independent pieces:
///
///     while (!finished) {
///       for piece in 0 ... pieces() - 1, at the same time:  work(piece, worker)
///       finished = step().finished
///     }
///
/// Whatever has not been done by then, `step()` does itself: the results are the same bits with any
/// number of workers, and without any.
class Localizer {
 public:
  /// Bytes of arena for a problem of this size, in a block aligned to Arena::kAlignment (one less
  /// aligned loses its first bytes); kInvalidOption for options out of range and for kernels that
  /// are not available.
  static Status requiredBytes(const ProblemSize& size, const LocalizerOptions& options,
                              std::size_t& bytes) {
    return requiredBytes(size, options, 1, bytes);
  }
  /// The same with scratch for so many workers, 1 ... kMaxWorkers.
  static Status requiredBytes(const ProblemSize& size, const LocalizerOptions& options, int workers,
                              std::size_t& bytes, Kernels kernels = Kernels::kPortable);
  /// The same in detail.
  static Status requiredMemory(const ProblemSize& size, const LocalizerOptions& options,
                               int workers, MemoryUse& use, Kernels kernels = Kernels::kPortable);
  /// The same in detail.
  static Status requiredMemory(const ProblemSize& size, const LocalizerOptions& options,
                               MemoryUse& use) {
    return requiredMemory(size, options, 1, use);
  }
  static constexpr int kMaxWorkers = 256;  ///< most workers that can share a run

  /// `memory` and everything `problem` points to must outlive the localizer. `status()` tells
  /// whether it can run: kInvalidOption, kInvalidImage (its size is not the camera's or the ignore
  /// mask's), kInvalidCamera (not prepared), kInvalidPose (not finite, a quaternion not of unit
  /// length, an uncertainty that is negative), kInvalidMesh, kArenaTooSmall. If not, the first step
  /// ends the run as a fault. `kernels` (those that the memory was asked for) change nothing but
  /// the time taken.
  Localizer(const LocalizationProblem& problem, const LocalizerOptions& options,
            std::span<std::byte> memory, int workers = 1, Kernels kernels = Kernels::kPortable);

  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// kOk when it can run.
  Status status() const { return status_; }

  /// One slice; after `finished` it does nothing.
  StepReport step();

  /// Pieces of the work before the next step that may be done at the same time; 0 where there is
  /// nothing to share out.
  int pieces() const;
  /// Does one of them, in the scratch of one of the workers. Each piece at most once between two
  /// steps; calls at the same time need different pieces and different workers.
  void work(int piece, int worker);

  /// Begins anew from another pose with other options, as a fresh localizer would. Memory is what
  /// it was: kArenaTooSmall when the new options ask for more.
  Status restart(const Pose& camera_from_station_seed, const LocalizerOptions& options);

  /// Whether the run stands before an iteration: its edges are there, the last iteration (or
  /// attempt) has ended and the next has not begun.
  bool isBetweenIterations() const { return status_ == Status::kOk && iteration_pending_; }
  /// The iterations that come have other options; those that were stay what they are. False when
  /// not between iterations, or when an option is out of range or holds for a whole run
  /// (firstFixedOption); then nothing has changed. The digest hears of it unless none differs.
  [[nodiscard]] bool changeOptions(const LocalizerOptions& options);

  /// Leaves the matching to the caller, for methods other than WHS in the same loop; before the
  /// first step. Every match stage then waits for supplyMatches(), and the renders also give
  /// `surfaces` (of the level's size, or larger), which must outlive the run. Everything else, and
  /// a run without this call, stays what it is. The digest hears of it.
  void matchOutside(const SurfaceRender& surfaces);
  /// Whether step() waits for matches: then the workspace's iteration holds render and templates.
  bool awaitsMatches() const;
  /// One entry per template, in their order; or any other items of the render, which then stand for
  /// the templates. What is not finite counts as not found. kCapacityExceeded for more than
  /// templates.count, kInvalidOption when none are awaited; then nothing has changed.
  Status supplyMatches(std::span<const SuppliedMatch> supplied);

  /// To be looked at between two steps.
  ///@{
  const Workspace& workspace() const { return workspace_; }
  const LocalizationProblem& problem() const { return problem_; }
  const LocalizerOptions& options() const { return options_; }
  std::size_t highWaterBytes() const { return kept_.highWater() + scratch_.highWater(); }
  ///@}
  /// What the stages need of the memory; known from the start.
  const MemoryUse& memoryUse() const { return memory_use_; }
  /// SHA-256 over options, inputs and every intermediate up to now, whoever looks or not.
  std::array<std::uint8_t, 32> digest() const { return digest_.digest(); }

 private:
  friend class ViewLink;

  void begin();
  Status build();
  Status layOut(const ProblemSize& size);
  Status layOutKept();
  void layOutRenders();
  EdgeRender createRender(int level);
  Status layOutStages(const ProblemSize& size);
  void shareScratch(std::size_t& bytes);
  void openPieces(int count);
  std::size_t& bytesOf(Stage stage) { return memory_use_.stage[static_cast<std::size_t>(stage)]; }
  void startIteration();
  void startHypothesis();
  void placeIteration(Iteration& now);
  void placeRestart(Iteration& now);
  StepReport stepEdges();
  StepReport stepRender();
  StepReport stepTemplates();
  StepReport stepMatch();
  StepReport stepPose();
  StepReport stepRefine();
  Status beginRefinement();
  StepReport stepSupport();
  StepReport finishSupported();
  StepReport failUnsupported();
  StepReport fail(Stage stage, LocalizationStatus status);
  bool canTryAgain() const;
  void startAttempt();
  StepReport faulted(Stage stage, Status fault);
  bool beginMatch(int index, WarpedSearch& search);
  void finishMatch(int index, const WarpedSearch& search);
  WarpGrid warpsOf(const Iteration& now, const Eigen::Vector3d& point_in_camera_m) const;
  void dropIndistinct();
  void learn();
  bool nextUndone();
  void collectCorrespondences();
  void noteHypothesis();
  HypothesisSummary summaryOf(const Iteration& iteration) const;
  Status continueRender(bool& complete);
  void layOutWideSearch();
  bool isWide() const { return wide_round_ != WideRound::kNone; }
  int restartCount() const;
  StepReport beginEvidence();
  StepReport stepEvidence();
  StepReport finishRestart(Stage stage, const EdgeSupport& support);
  void noteRestart(const EdgeSupport& support);
  StepReport finishWideRound();
  void chooseRestarts();
  int bestFinalistLeft() const;
  void startFinalist(int finalist);
  void layOutRivals();
  bool weighsRivals() const;
  StepReport weighRivals();
  void takeLead();
  void beginScan();
  StepReport stepScan();
  void noteRivals();
  bool isKnown(const Pose& camera_from_station, double within_px) const;
  StepReport nextRival(StepReport made);
  void startRival();
  StepReport endRival(Stage stage, LocalizationStatus status);
  StepReport concludeRivals(StepReport made);
  void returnToLead();
  bool isInSeedsBox(const Pose& camera_from_station) const;
  LocalizationStatus verdict() const;
  double templateFactorNow() const;
  bool isConvincing(int buffer) const;
  StepReport leaveToOthers(Stage stage, LocalizationStatus status);
  StepReport stepLinkedRefine();
  bool canReuseRender(const Iteration& now) const;
  StepReport failHypothesis(Stage stage, LocalizationStatus status);
  StepReport finishHypothesis(Stage stage);
  StepReport finishIteration(Stage stage, const Pose& camera_from_station,
                             const Matrix6d& covariance);
  void finish(LocalizationStatus status);
  void measureCorrection(const Pose& before, const Pose& after);
  bool isSmall(const Iteration& iteration) const;
  const PosePrior* anchor() const;
  double featureSize() const;

  LocalizationProblem problem_;
  LocalizationProblem started_;  ///< from the seed of this attempt: what the wide search found
  LocalizerOptions options_;
  std::span<std::byte> memory_;
  Arena kept_;
  int workers_ = 1;
  Kernels kernels_ = Kernels::kPortable;
  Arena scratch_;  ///< of construction and of the stages, one after the other
  MemoryUse memory_use_;
  Status status_ = Status::kOk;

  MeshAdjacency adjacency_;
  BoundingBox bounds_;
  EdgeDetector detector_;
  EdgeRenderer renderer_;
  TemplateSelector selector_;
  std::span<Eigen::Vector3d> failed_in_station_m_;  ///< where the last templates were of no use
  int failed_count_ = 0;
  std::span<WarpedSearch> searches_;  ///< one per worker
  bool match_outside_ = false;
  bool supplied_ = false;   ///< for the match stage at hand
  SurfaceRender surfaces_;  ///< for those who match outside
  LinkedView link_;
  PnpRansac ransac_;
  EdgeRefinement refinement_;
  std::array<RayGrid, kPyramidLevels> rays_;

  std::array<Iteration, 2> buffers_;  ///< the current hypothesis and the best of this iteration
  std::array<Stage, 2> reached_{};    ///< by each of them
  struct Agreement {
    std::int32_t inliers = 0;
    std::int32_t correspondences = 0;
  };
  std::array<Agreement, 2> agreement_;  ///< of each of them; of all views when there are several
  std::array<EdgeRender, 2> coarse_render_;  ///< of the first iteration, one per buffer
  EdgeRender fine_render_;  ///< of later ones, in the same memory unless it is the same level
  int current_ = 0;
  bool has_best_ = false;

  enum class WideRound : std::uint8_t { kNone = 0, kRestarts, kFinalists };
  RestartGrid grid_;
  WideRound wide_round_ = WideRound::kNone;
  bool weighing_ = false;                      ///< a restart's pose is being looked at
  std::array<EdgeRender, 2> wide_render_;      ///< of restarts, one per buffer
  std::array<EdgeRender, 2> evidence_render_;  ///< of poses found, by restarts and by finalists
  std::span<HypothesisSummary> restarts_;
  std::span<HypothesisSummary> finalists_;
  int finalist_count_ = 0;
  std::uint32_t finalists_used_ = 0;  ///< bits

  /// The pose with the most evidence up to now, and what it takes to do its last iteration again.
  struct Lead {
    Pose camera_from_station;
    Pose camera_from_station_before;
    PoseEstimate matched;
    LocalizationProblem started;
    int iteration = 0;
    int rival = -1;  ///< that it was; -1: the first
  };
  enum class RivalRound : std::uint8_t { kNone = 0, kScan, kRivals, kReturn };
  RivalRound rival_round_ = RivalRound::kNone;
  SelfSimilarity similarity_;
  EdgeRender lead_render_;
  Lead lead_;
  LocalizationProblem first_started_;  ///< of the attempt that converged first
  int first_attempt_ = 0;
  std::span<Rival> rivals_;
  int rival_count_ = 0;
  int rival_ = 0;               ///< being tried
  bool lead_is_shown_ = false;  ///< the latest iteration is the lead's
  int hypothesis_ = 0;
  std::span<std::uint8_t> done_;  ///< pieces of the stage, or of its round
  int piece_count_ = 0;
  int piece_ = 0;             ///< none before it is left to do
  bool piece_begun_ = false;  ///< by step() itself

  Stage stage_ = Stage::kEdges;
  bool stage_begun_ = false;
  bool iteration_pending_ = false;
  bool hypothesis_pending_ = false;
  int attempt_ = 0;
  int iteration_ = 0;  ///< of this attempt
  int small_corrections_ = 0;
  int coarse_level_ = 0;
  int wide_level_ = 0;  ///< of restarts; the coarse level when there are none
  int fine_level_ = 0;
  PosePrior anchor_;          ///< the seed with its uncertainty as a Gaussian
  PoseEstimate matched_;      ///< from the latest templates
  Pose camera_from_station_;  ///< the hypothesis
  Matrix6d covariance_ = Matrix6d::Zero();
  Workspace workspace_;
  DigestWriter digest_;
};

}  // namespace boresight
