// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/rational_start.h"

#include <cmath>

#include <Eigen/Dense>

namespace boresight::sessions {
namespace {

constexpr int kAngles = 200;
constexpr int kRounds = 8;

/// Distorted radius of an angle, z = 1.
double distortedRadius(const Camera& kannala_brandt, double theta) {
  const double square = theta * theta;
  double factor = 0.0;
  for (std::size_t i = 4; i-- > 0;) factor = (factor + kannala_brandt.distortion[i]) * square;
  return theta * (1.0 + factor);
}

}  // namespace

Camera rationalStart(const Camera& kannala_brandt, double widest_rad) {
  // With s = tan^2 theta and g the factor of the radius: N(s) - g D(s) = 0, linear in k1 .. k6.
  Eigen::MatrixXd rows(kAngles, 6);
  Eigen::VectorXd right(kAngles), square(kAngles), radius(kAngles);
  for (int i = 0; i < kAngles; ++i) {
    const double theta = widest_rad * (i + 1) / kAngles;
    const double r = std::tan(theta);
    const double s = r * r;
    const double factor = distortedRadius(kannala_brandt, theta) / r;
    const Eigen::RowVector3d powers(s, s * s, s * s * s);
    rows.row(i) << powers, -factor * powers;
    right[i] = factor - 1.0;
    square[i] = s;
    radius[i] = r;
  }
  Eigen::VectorXd denominator = Eigen::VectorXd::Ones(kAngles);
  Eigen::VectorXd k = Eigen::VectorXd::Zero(6);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd weight = radius.cwiseQuotient(denominator.cwiseAbs());
    Eigen::MatrixXd weighted = weight.asDiagonal() * rows;
    const Eigen::VectorXd length = weighted.colwise().norm();
    weighted = weighted * length.cwiseInverse().asDiagonal();
    k = weighted.colPivHouseholderQr().solve(weight.cwiseProduct(right)).cwiseQuotient(length);
    const auto s = square.array();
    denominator = 1.0 + s * (k[3] + s * (k[4] + s * k[5]));
  }
  Camera camera = kannala_brandt;
  camera.model = CameraModel::kBrownConrady;
  camera.distortion = {k[0], k[1], 0.0, 0.0, k[2], k[3], k[4], k[5]};
  return camera;
}

}  // namespace boresight::sessions
