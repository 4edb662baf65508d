// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/geometry/camera.h"
#include "core/pnp/normal_equations.h"
#include "core/refine/edge_refinement.h"

namespace boresight {

/// Focal length that fits the edges of a refined pose best, relative to the camera's. A pose from a
/// wrong focal length has a wrong depth, which its residuals do not reveal.
struct FocalFit {
  double change = 0.0;      ///< relative change of the focal length
  double sigma = 0.0;       ///< one sigma of the change
  bool determined = false;  ///< whether the edges determine the focal length together with the pose

  /// Whether the image determines the focal length well enough and contradicts the camera's.
  bool disagrees() const {
    return determined && sigma <= kLargestSigma && magnitude() > kLeastChange &&
           magnitude() > kSigmas * sigma;
  }
  /// Absolute value of the change.
  double magnitude() const { return change < 0.0 ? -change : change; }

  /// Largest sigma of a usable focal length: small or flat objects reach only 2 to 30 %, so that
  /// errors of the mesh dominate.
  static constexpr double kLargestSigma = 0.01;
  static constexpr double kLeastChange =
      0.004;                              ///< correct cameras of rendered stations: up to 0.0026
  static constexpr double kSigmas = 4.0;  ///< correct cameras of photographs: up to 3.5
};

/// Measures the focal length together with a refined pose: the equations of its edges with one more
/// unknown, the scale of the image about its principal point, solved again with Tukey's weights
/// about their own residuals. Sigma accounts for shared errors (compare ErrorGroups).
class FocalFitter {
 public:
  static constexpr int kRounds = 5;  ///< each a step

  /// Takes memory for up to `max_samples` samples. kArenaTooSmall.
  Status create(std::int32_t max_samples, Arena& arena);
  /// The result must outlive the steps; `camera` is that of its image.
  void begin(const Camera& camera, const RefinementResult& refined);
  /// One round; true when fit() is complete.
  [[nodiscard]] bool step();
  /// The measured focal length.
  const FocalFit& fit() const { return fit_; }

 private:
  /// Equation of a sample: derivatives of its place along the normal, and the residual.
  struct Row {
    Vector6d by_pose;
    double by_focal = 0.0;
    double residual_px = 0.0;  ///< at the solution so far
    Eigen::Vector2d pixel;
  };
  struct Sums;

  bool rowOf(const EdgeSample& sample, Row& row) const;
  bool measureScale();
  void weigh(Sums& sums) const;
  bool solve(const Sums& sums);
  void measureSigma();
  double weightOf(const EdgeSample& sample, const Row& row) const;

  Camera camera_;
  const RefinementResult* refined_ = nullptr;
  PoseMatrix camera_from_station_{Pose()};
  std::span<float> residuals_;
  Eigen::AlignedBox2d box_px_;  ///< of the edge places
  int round_ = 0;
  double cut_px_ = 0.0;                   ///< residual at which the weight is 0
  Vector6d xi_ = Vector6d::Zero();        ///< of the pose
  Vector6d coupling_ = Vector6d::Zero();  ///< by which the pose follows the focal length
  double information_ = 0.0;              ///< of the focal length alone
  FocalFit fit_;
};

}  // namespace boresight
