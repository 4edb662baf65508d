// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/correspondence.h"

#include <cmath>

namespace boresight {
namespace {

constexpr double kLargestCoordinate = 1e9;
constexpr double kSmallestSigma_px = 1e-6;
constexpr double kLargestSigma_px = 1e6;
constexpr double kUnitTolerance = 1e-6;

// Written so that a NaN is not bounded.
bool isBounded(double value) { return std::abs(value) < kLargestCoordinate; }

template <class Vector>
bool isBoundedEach(const Vector& values) {
  for (int i = 0; i < values.size(); ++i) {
    if (!isBounded(values[i])) return false;
  }
  return true;
}

bool isSigma(const Eigen::Vector3d& sigma) {
  return isBoundedEach(sigma) && sigma.minCoeff() >= 0.0;
}

}  // namespace

bool isUsable(const Correspondence& correspondence) {
  return isBoundedEach(correspondence.point_in_station_m) && isBoundedEach(correspondence.pixel) &&
         correspondence.sigma_px >= kSmallestSigma_px &&
         correspondence.sigma_px <= kLargestSigma_px;
}

bool isUsable(const Pose& pose) {
  return isBoundedEach(pose.translation_m) &&
         std::abs(pose.rotation.squaredNorm() - 1.0) < kUnitTolerance;
}

bool isUsable(const PosePrior& prior) {
  return isUsable(prior.camera_from_station) && isSigma(prior.sigma.translation_m) &&
         isSigma(prior.sigma.rotation_rad) && isBoundedEach(prior.sigma.pivot_in_camera_m);
}

}  // namespace boresight
