// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/geometry/pose.h"
#include "core/localizer/localizer.h"
#include "core/pnp/normal_equations.h"

namespace boresight {

/// What all views together made of a hypothesis, in one camera's frame.
struct JointPose {
  LocalizationStatus status = LocalizationStatus::kPnpFailed;  ///< kRunning: there is a pose
  Pose camera_from_station;                                    ///< the pose found
  /// Over (rotation rad, translation m), left perturbation.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t samples = 0;          ///< drawn by RANSAC
  std::int32_t inliers = 0;          ///< of all views
  std::int32_t correspondences = 0;  ///< of all views that take part
};

enum class SupportVerdict : std::uint8_t { kSupported = 0, kNotSupported, kGoOn };

/// The way into a localizer for who solves several views as one (ViewsLocalizer), and nobody else.
///
/// Every view's localizer steps by itself through edges, render, templates and matching, and
/// through a refinement's search, until need() says what it waits for. The leader is asked first;
/// followers are then told where its loop stands. The answer to what they wait for is supplied to
/// all, the leader last: its loop goes on with it as with a pose of its own.
class ViewLink {
 public:
  /// The localizer must outlive the link.
  explicit ViewLink(Localizer& localizer) : localizer_(&localizer) {}

  /// Before the first step.
  void join(ViewRole role);
  ViewNeed need() const;              ///< What the localizer waits for
  LocalizationStatus failed() const;  ///< Why the view has no say at the moment; kRunning: it has
  /// Which of two records the leader's hypothesis at hand, or the one it kept, is in.
  int buffer() const;

  /// A follower renders and matches (or refines) as the leader does now, from the same pose within
  /// the same uncertainty: its box, turned into this camera's axes, in a box.
  void follow(const Localizer& leader, const Pose& camera_from_leader);
  /// Inliers and residuals of this view's correspondences, for supplyPose.
  PnpSolution& solution();
  /// The pose of all views, for which need() is kPose.
  StepReport supplyPose(const JointPose& joint);

  /// The view's own equations of the refinement round at hand.
  const NormalEquations& round() const;
  /// The leader's pose by the sum of all views' equations, in its frame.
  Status advance(const NormalEquations& sum, bool& settled);
  /// A follower's pose, and its covariance.
  bool moveTo(const Pose& camera_from_station, const Matrix6d& covariance);
  /// `settled`: in all views.
  bool refinementEnds(Status status, bool settled) const;
  /// Ends a refinement round with what advance() or moveTo() gave; `ends`: it was the last.
  StepReport finishRound(Status status, bool ends);

  void measureSupport();  ///< Measures the edge support of the final pose in this view
  /// A follower, until the next place.
  void rest();
  /// What all views together decided about the final pose.
  StepReport conclude(SupportVerdict verdict);

  /// Which of its two records a localizer's workspace shows, and either of them.
  static int shownBuffer(const Localizer& localizer);
  /// One of a localizer's two records.
  static const Iteration& record(const Localizer& localizer, int buffer);

 private:
  Localizer* localizer_;
};

}  // namespace boresight
