// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_options.h"
#include "core/pnp/pnp_view.h"
#include "core/pnp/spread_sampler.h"

namespace boresight {

/// A pose from correspondences, with its inliers and residuals.
struct PnpSolution {
  Pose camera_from_station;        ///< the pose
  std::span<std::uint8_t> inlier;  ///< of the *returned* pose, one per correspondence
  std::span<double> residual_px;   ///< distance pixel - projection; 1e6 where it does not project
  std::int32_t inlier_count = 0;   ///< of the returned pose
  double rms_px = 0.0;             ///< over the inliers
  /// 6x6 over xi = (rotation rad, translation m), camera frame, left perturbation: poseCovariance
  /// over the inliers.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t samples = 0;  ///< drawn
};

/// RANSAC in bounded slices, then refinement over all inliers.
///
/// - Samples: three points refined from the hypothesis under its weak prior (the hypothesis itself
///   is scored first), or five by EPnP (with a moving entrance pupil, the bearings assume the
///   depths of the hypothesis).
/// - Score: sum of min(residual^2, threshold^2) / sigma^2 over the usable correspondences (MSAC,
///   Torr and Zisserman 2000), the lowest wins; of equal scores the earlier one.
/// - Every new best is refitted to its inliers, without that prior, while this lowers the score
///   (LO-RANSAC, Chum, Matas and Kittler 2003).
/// - Stops when a sample without outliers has been drawn with the required confidence, given the
///   best pose's share of inliers, or at max_samples.
/// - Finally refits to the inliers and selects them again until they stay the same. Both steps
///   lower the score, so this ends; the result minimizes the squares over the inliers it reports.
/// - With EPnP it is plain RANSAC (Fischler and Bolles 1981): most inliers win, no sample is
///   refitted, and the result minimizes the squares over the best sample's inliers.
///
/// Statuses (of `begin` or `step`): kInvalidOption (options, or a threshold outside (0, 1e6)),
/// kInvalidCamera (not prepared), kInvalidPose (hypothesis), kCapacityExceeded (more
/// correspondences than `create` or the solution's spans allow for), kTooFewPoints (fewer usable
/// correspondences than min_inliers), kDegenerate (no sample gives a pose, or the inliers do not
/// determine one), kNoConsensus (fewer than min_inliers inliers). On any of them the solution holds
/// the hypothesis (identity when that is not usable) and no inliers; `residual_px` always is that
/// of the pose in the solution.
class PnpRansac {
 public:
  /// Allocates for this number of correspondences. kArenaTooSmall.
  Status create(int max_correspondences, Arena& arena);
  /// Guided samples start from `hypothesis`, the mean of their prior (sigma = uncertainty times a
  /// factor). Spans in `solution` must hold one entry per correspondence. The data must outlive the
  /// steps.
  Status begin(std::span<const Correspondence> correspondences, const Camera& camera,
               const PosePrior& hypothesis, double threshold_px, const PnpOptions& options,
               PnpSolution& solution);
  /// The same from several views, at most kMaxPnpViews, which must outlive the steps: hypothesis
  /// and solution are the first view's pose; scores and refits are over all views. A minimal sample
  /// is from one view (places are compared in their own images), a guided one may be of any.
  Status begin(std::span<const Correspondence> correspondences, std::span<const PnpView> views,
               const PosePrior& hypothesis, double threshold_px, const PnpOptions& options,
               PnpSolution& solution);
  /// One batch of samples, or the refinement; `done` when the solution is complete or a status
  /// other than kOk ended it.
  Status step(bool& done);

 private:
  enum class Phase : std::uint8_t { kIdle, kSampling, kRefining, kDone };
  struct Score {
    double cost = 0.0;
    std::int32_t inliers = 0;
  };

  Status validate(double threshold_px, const PosePrior& hypothesis) const;
  void listUsable();
  std::size_t viewOfUsable(std::int32_t k) const;
  int sampleSize() const;
  bool isOfOneView(const SpreadSampler::Sample& sample) const;
  const Correspondence& usable(std::int32_t k) const;
  Status finish(Status status);
  void takeSample();
  void sampleEpnp(const SpreadSampler::Sample& sample);
  void sampleGuided(const SpreadSampler::Sample& sample);
  void consider(const Pose& camera_from_station);
  void optimizeLocally();
  bool enoughSamples() const;
  bool score(const Pose& camera_from_station, double limit, Score& result) const;
  bool selectInliers(const Pose& camera_from_station, std::int32_t& count);
  Status refine();
  void writeSolution(const Pose& camera_from_station, bool with_inliers);

  // Scratch, one entry per correspondence.
  std::span<std::int32_t> usable_;       ///< indices; the first usable_count_ are valid
  std::span<Eigen::Vector2d> place_px_;  ///< of the usable ones, for the sampler
  std::span<double> weight_;             ///< 1 / sigma_px^2, by correspondence
  std::span<std::uint8_t> selected_;     ///< inliers of the pose of the last selectInliers()

  std::span<const Correspondence> correspondences_;
  Camera camera_;  ///< of a single view
  PnpView single_;
  std::span<const PnpView> views_;
  PosePrior hypothesis_;
  PosePrior prior_;
  double threshold_px_ = 0.0;
  PnpOptions options_;
  PnpSolution* solution_ = nullptr;

  Phase phase_ = Phase::kIdle;
  Status status_ = Status::kTooFewPoints;
  std::int32_t usable_count_ = 0;
  std::int32_t samples_ = 0;
  SpreadSampler sampler_;
  Pose best_;
  Score best_score_;
};

}  // namespace boresight
