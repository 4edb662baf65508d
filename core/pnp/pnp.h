// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/options.h"
#include "core/base/random.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

struct Correspondence {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

enum class PnpSampler : std::int32_t { kP3p = 0, kGuided = 1 };
inline constexpr const char* kPnpSamplerNames[] = {"p3p", "guided"};

struct PnpOptions {
  PnpSampler sampler = PnpSampler::kGuided;
  std::int32_t max_samples = 500;
  double confidence = 0.999;
  std::int32_t min_inliers = 6;
  std::int32_t local_optimizations = 3;  ///< rounds of refit on the inliers after each new best
  double prior_factor = 3.0;  ///< the weak prior's sigma as a multiple of the uncertainty (kGuided)
  std::int32_t refine_iterations = 20;
  std::int64_t seed = 1;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"pnp.sampler", "", 0, 1,
                     "Minimal samples by P3P, or four points refined from the hypothesis under a "
                     "weak prior.",
                     kPnpSamplerNames},
          self.sampler);
    visit(OptionInfo{"pnp.max_samples", "", 1, 100000, "Largest number of RANSAC samples."},
          self.max_samples);
    visit(OptionInfo{"pnp.confidence", "", 0.5, 0.999999, "RANSAC stops early at this confidence."},
          self.confidence);
    visit(OptionInfo{"pnp.min_inliers", "", 4, 10000, "Fewer inliers are no pose."},
          self.min_inliers);
    visit(OptionInfo{"pnp.local_optimizations", "", 0, 20,
                     "Refits on the inliers after each new best sample."},
          self.local_optimizations);
    visit(OptionInfo{"pnp.prior_factor", "", 0.1, 1000.0,
                     "Sigma of the prior in guided samples, as a multiple of the uncertainty."},
          self.prior_factor);
    visit(OptionInfo{"pnp.refine_iterations", "", 1, 200, "Largest number of refinement steps."},
          self.refine_iterations);
    visit(OptionInfo{"pnp.seed", "", 0, 9007199254740991.0, "Seed of the sample generator."},
          self.seed);
  }
};

/// Gaussian prior on the pose about a hypothesis, in the axes of SeedUncertainty.
struct PosePrior {
  Pose camera_from_station;
  SeedUncertainty sigma;  ///< the box read as one sigma per axis
};

struct PnpSolution {
  Pose camera_from_station;
  std::span<std::uint8_t> inlier;  ///< of the *returned* pose, one per correspondence
  std::span<double> residual_px;   ///< distance pixel - projection; 1e6 where it does not project
  std::int32_t inlier_count = 0;
  double rms_px = 0.0;  ///< over the inliers
  /// 6x6 over xi = (rotation rad, translation m), camera frame, left perturbation; from the
  /// inliers' Jacobian with unit weights per pixel, scaled by their observed variance.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t samples = 0;
};

/// Up to four poses from three unit bearings and three points (lambda-twist style or another
/// published solver, without libm): the number of solutions.
int solveP3p(const std::array<Eigen::Vector3d, 3>& bearing,
             const std::array<Eigen::Vector3d, 3>& point_in_station_m,
             std::array<Pose, 4>& camera_from_station);

/// Gauss-Newton / LM on reprojection error with the full camera model over the correspondences
/// whose `use` is nonzero (all when empty), from the given pose, with an optional prior. Returns
/// the refined pose in place; kDegenerate when the normal equations are singular or nothing
/// projects.
Status refinePose(std::span<const Correspondence> correspondences,
                  std::span<const std::uint8_t> use, const Camera& camera, const PosePrior* prior,
                  int max_iterations, Pose& camera_from_station);

/// 6x6 covariance at a pose from the used correspondences (see PnpSolution). kDegenerate when
/// singular.
Status poseCovariance(std::span<const Correspondence> correspondences,
                      std::span<const std::uint8_t> use, const Camera& camera,
                      const Pose& camera_from_station, Matrix6d& covariance);

/// RANSAC in bounded slices (LO-RANSAC, Chum 2003), then refinement over all inliers.
class PnpRansac {
 public:
  Status create(int max_correspondences, Arena& arena);
  /// `hypothesis` is where guided samples start and what their prior is about (sigma = uncertainty
  /// times prior_factor). Spans in `solution` must hold one entry per correspondence. The data must
  /// outlive the steps.
  Status begin(std::span<const Correspondence> correspondences, const Camera& camera,
               const PosePrior& hypothesis, double threshold_px, const PnpOptions& options,
               PnpSolution& solution);
  /// One batch of samples, or the refinement; `done` when the solution is complete.
  Status step(bool& done);

 private:
  // (the implementer of this stage fills this in)
};

}  // namespace boresight
