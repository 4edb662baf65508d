// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/arena.h"
#include "core/base/nth.h"
#include "core/localizer/attempt.h"
#include "core/localizer/pass.h"
#include "core/localizer/pose_comparison.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_ransac.h"
#include "core/views/views_problem.h"

namespace boresight {

/// Localization from several views at once. There is one attempt, and a pass for each view. At
/// every iteration all views render and match (or search edges) in their own images from one
/// hypothesis, and one pose is solved from all results:
///
/// - matches: PnpRansac over the correspondences of all views;
/// - refinement: the views' normal equations, each weighted by its own noise, brought into the
///   first view's frame by the adjoint and summed: one step for all.
///
/// The attempt runs in the first view's frame and counts the matches of all views; each view rolls
/// its render by the same angle about its own ray. A single view therefore gives the same bits as
/// Localizer without a search.
///
/// A view with too few matches, or with matches that disagree with the others', is left out until
/// the next matching iteration (from refinements, until the next attempt). A view without edge
/// support, or whose image is blurred, is dropped for the attempt, and the run refines without it.
/// The result is the pose for which all remaining views have support.
///
/// A run that searches does so in every view; attempts start from the candidates of all views, and
/// from the best pose moved along the directions that the views together determine least. The
/// result is ambiguous when another pose, or the mesh's mirror image, competes with it in every
/// view (jointCompetingPoses). Matches from outside are not supported.
class ViewsLocalizer {
 public:
  /// Bytes of arena for a number of workers, in a block aligned to Arena::kAlignment: the sum of
  /// each view's, and some ten kB per view.
  static Status requiredBytes(const ViewsProblem& problem, const LocalizerOptions& options,
                              int workers, Kernels kernels, std::size_t& bytes);

  /// As Localizer's constructor. kCapacityExceeded: no view, or more than kMaxViews.
  ViewsLocalizer(const ViewsProblem& problem, const LocalizerOptions& options,
                 std::span<std::byte> memory, int workers = 1,
                 Kernels kernels = Kernels::kPortable);

  /// kOk when it can run.
  Status status() const { return status_; }
  /// One slice of one view, or of the pose of all; after `finished` it does nothing. An iteration
  /// is complete when the first view's is.
  StepReport step();
  /// Number of tasks that may run at the same time, all of one view; see Localizer::tasks().
  int tasks() const;
  /// Runs a task with the scratch of a worker; see Localizer::runTask().
  void runTask(int task, int worker);

  /// State of the run.
  const ViewsResult& result() const { return result_; }
  /// The pass of a view, for inspection; there is none when status() is not kOk.
  const Pass& view(int index) const { return nth(views_, index).pass; }
  /// A view's record of the iteration and rolled hypothesis that the first view's workspace shows.
  /// nullptr before the first iteration, and for a view that does not take part in it.
  const Iteration* iterationOf(int index) const;
  /// SHA-256 over how the views are linked, each view's own digest and the result.
  std::array<std::uint8_t, 32> digest() const;

 private:
  struct Linked {
    Pass pass;
    Pose camera_from_first;
    int dropped_in_attempt = -1;
    bool refines = false;
    bool has_edges = false;
    bool is_prepared = false;  ///< it has edges, and was searched
    bool has_begun = false;    ///< the pass of the attempt's current plan
  };
  /// Contribution of a view to a hypothesis.
  struct Share {
    LocalizationStatus status = LocalizationStatus::kRunning;
    std::int32_t correspondences = 0;
    std::int32_t inliers = 0;
  };
  using Shares = std::array<Share, kMaxViews>;

  /// Part of the run that the passes of the views belong to.
  enum class Phase : std::uint8_t { kIterate = 0, kAccept, kCompare };

  static Status validate(const ViewsProblem& problem, const LocalizerOptions& options);
  static void layOut(const ViewsProblem& problem, const LocalizerOptions& options, Arena& arena,
                     ViewsLocalizer* to);
  Pass& first() { return views_[0].pass; }
  const Iteration& leading() const { return *view(0).workspace().iteration; }
  Shares& shares() { return nth(shares_, plan_.record); }

  bool takesPart(std::size_t view) const;
  bool hasPass(std::size_t view) const;
  std::optional<std::size_t> workingView() const;
  PassPlan planOf(std::size_t view) const;
  StepReport prepareView(std::size_t view);
  void startAttempts();
  void start(const Attempt& attempt);
  bool stepView(std::size_t view, StepReport& report);
  StepReport retry(LocalizationStatus status, const StepReport& report);
  StepReport takePose(const StepReport& report);
  StepReport follow(PoseComparison::Next next, LocalizationStatus status, const StepReport& report);
  WeakDirections weakDirectionsOfAll() const;
  EdgePlaces edgePlaces() const;
  StepReport compare(PassKind kind, const StepReport& report);
  StepReport decide(const Ruling& ruling);
  StepReport finish(LocalizationStatus status, StepReport report);
  StepReport finishFault(std::size_t view);
  void finishResult();
  void startPlan();

  StepReport stepPose();
  void chooseViews();
  Status beginPose();
  std::int32_t seeing(std::size_t view) const;
  void collect(std::size_t view, bool all);
  void noteInliers();
  bool leaveOutDissenters();
  StepReport supplyPose(Status status);
  void fillSolution(std::size_t view, Status status);

  void chooseRefining();
  StepReport stepRound();
  Status advance(bool& settled);
  StepReport stepSupport();
  StepReport stepCompare();
  void noteViews();

  ViewsProblem problem_;
  LocalizerOptions options_;
  Status status_ = Status::kOk;
  std::array<Linked, kMaxViews> linked_;
  std::span<Linked> views_;  ///< those of the problem
  bool finished_ = false;
  Attempt attempt_;
  PassPlan plan_;  ///< of the first view
  Phase phase_ = Phase::kIterate;
  PassKind comparison_kind_ = PassKind::kCompare;  ///< of the final pose
  /// Of all views, in the first one's frame; the most evidence first.
  std::array<PoseCandidate, kMaxViews * PoseSearch::kMaxCandidates> candidates_;
  PoseComparison comparison_;
  WeakDirections weak_;       ///< of the latest pose that views support
  double probability_ = 0.0;  ///< of that pose, by the view that supports it best

  PnpRansac ransac_;
  bool pose_begun_ = false;
  std::span<Correspondence> correspondences_;  ///< of all views that take part, view by view
  std::span<std::int32_t> own_index_;          ///< of each in its view's list
  std::array<PnpView, kMaxViews> pnp_views_;
  PnpSolution pnp_;
  std::array<Shares, 2> shares_;  ///< by record
  Shares latest_;                 ///< of the chosen hypothesis, and its changes since
  ViewsResult result_;
};

}  // namespace boresight
