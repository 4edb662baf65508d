// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/arena.h"
#include "core/localizer/localizer.h"
#include "core/localizer/view_link.h"
#include "core/pnp/pnp.h"
#include "core/views/views_problem.h"

namespace boresight {

/// Localization from several views at once. Each view has a Localizer; at every iteration all of
/// them render, match (or look for edges) in their own images from the one hypothesis, and one pose
/// is solved for from what all found:
///
/// - matches: PnpRansac over the correspondences of all views;
/// - refinement: the views' normal equations, each weighted by its own noise, brought into the
/// first
///   view's frame by the adjoint and summed: one step for all.
///
/// The first view's localizer leads: its loop decides on iterations, hypotheses (each view rolls
/// its render by the same angle about its own ray), convergence and further attempts, with the
/// counts and poses of all. So one view alone gives the bits of the plain Localizer.
///
/// A view that has nothing to say, or whose matches disagree with the others', is left out (until
/// the next matching iteration; from refinements, until the next attempt). One that the gate on
/// edge support refuses is dropped for the attempt, and the run goes on to refine without it.
/// Whatever is left when all that take part are supported is the result.
///
/// Not offered: the wide search, rivals, partial support, matches from outside, covariances by
/// groups of errors (kInvalidOption) and more than one worker.
class ViewsLocalizer {
 public:
  /// Bytes of arena, in a block aligned to Arena::kAlignment: the sum of what each view's localizer
  /// asks for, and some ten kB a view.
  static Status requiredBytes(const ViewsProblem& problem, const LocalizerOptions& options,
                              std::size_t& bytes) {
    return requiredBytes(problem, options, Kernels::kPortable, bytes);
  }
  /// The same with these kernels.
  static Status requiredBytes(const ViewsProblem& problem, const LocalizerOptions& options,
                              Kernels kernels, std::size_t& bytes);

  /// As Localizer's constructor. kCapacityExceeded: no view, or more than kMaxViews.
  ViewsLocalizer(const ViewsProblem& problem, const LocalizerOptions& options,
                 std::span<std::byte> memory, Kernels kernels = Kernels::kPortable);

  ViewsLocalizer(const ViewsLocalizer&) = delete;
  ViewsLocalizer& operator=(const ViewsLocalizer&) = delete;

  /// kOk when it can run.
  Status status() const { return status_; }
  /// One slice of one view, or of the pose of all; after `finished` it does nothing. An iteration
  /// is complete when the leader's is.
  StepReport step();

  /// How the run stands, or ended.
  const ViewsResult& result() const { return result_; }
  /// Views of the problem.
  int viewCount() const { return static_cast<int>(views_.size()); }
  /// A view's own, for looking at; there is none when status() is not kOk.
  const Localizer& view(int index) const {
    return *views_[static_cast<std::size_t>(index)].localizer;
  }
  /// What a view has of the iteration that the first one's workspace shows: of rolled hypotheses
  /// the same one. nullptr before the first iteration, and for a view that has no part in this one.
  const Iteration* iterationOf(int index) const;
  /// SHA-256 over how the views are linked, each view's own digest and the result.
  std::array<std::uint8_t, 32> digest() const;

 private:
  struct Linked {
    std::optional<Localizer> localizer;
    Pose camera_from_first;
    int dropped_in_attempt = -1;
    bool refines = false;
  };
  /// What a view brought to a hypothesis.
  struct Share {
    LocalizationStatus status = LocalizationStatus::kRunning;
    std::int32_t correspondences = 0;
    std::int32_t inliers = 0;
  };
  using Shares = std::array<Share, kMaxViews>;

  static Status validate(const ViewsProblem& problem, const LocalizerOptions& options);
  static void layOut(const ViewsProblem& problem, const LocalizerOptions& options, Arena& arena,
                     ViewsLocalizer* to);
  LocalizationProblem problemOf(std::size_t view) const;
  ViewLink link(std::size_t view) { return ViewLink(*views_[view].localizer); }
  const Iteration& leading() const { return *view(0).workspace().iteration; }
  Shares& shares() { return shares_[static_cast<std::size_t>(link(0).buffer())]; }

  bool takesPart(std::size_t view) const;
  bool stepView(std::size_t view, StepReport& report);
  StepReport finishFault(std::size_t view);
  StepReport noted(const StepReport& report);

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
  void noteViews();
  void finish();

  ViewsProblem problem_;
  LocalizerOptions options_;
  Status status_ = Status::kOk;
  std::array<Linked, kMaxViews> linked_;
  std::span<Linked> views_;  ///< those that there are
  bool finished_ = false;

  PnpRansac ransac_;
  bool pose_begun_ = false;
  std::span<Correspondence> correspondences_;  ///< of all views that take part, view by view
  std::span<std::int32_t> own_index_;          ///< of each in its view's list
  std::array<PnpView, kMaxViews> pnp_views_;
  PnpSolution pnp_;
  std::array<Shares, 2> shares_;  ///< by the leader's buffer
  Shares latest_;                 ///< of the hypothesis chosen, and what has become of it since
  ViewsResult result_;
};

}  // namespace boresight
