// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/pose_uncertainty.h"

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using sessions::endEffectorPose;
using sessions::EndEffectorPose;

Vector6d randomVector6(Random& random) {
  Vector6d vector;
  for (int i = 0; i < 6; ++i) vector[i] = random.normal();
  return vector;
}

Matrix6d randomCovariance(Random& random, double scale) {
  Matrix6d root;
  for (int i = 0; i < 6; ++i) root.col(i) = scale * randomVector6(random);
  return root * root.transpose();
}

TEST(EndEffectorPose, ARightSeedNeedsNoCorrection) {
  Random random = randomFor("EndEffectorPose.Right");
  const Pose camera_from_station = randomPose(random);
  const Pose camera_from_end_effector = randomPose(random);
  const EndEffectorPose made = endEffectorPose(camera_from_station, camera_from_station,
                                               camera_from_end_effector, Matrix6d::Zero());
  const Pose& correction = made.end_effector_seed_from_end_effector_estimated;
  EXPECT_LT(perturbationBetween(Pose(), correction).norm(), 1e-14);
}

TEST(EndEffectorPose, ApointOfTheStationIsWhereBothWaysLead) {
  Random random = randomFor("EndEffectorPose.Chain");
  for (int i = 0; i < 100; ++i) {
    const Pose seed = randomPose(random);
    const Pose estimate = randomPose(random);
    const Pose camera_from_end_effector = randomPose(random);
    const EndEffectorPose made =
        endEffectorPose(seed, estimate, camera_from_end_effector, Matrix6d::Zero());
    // A point held by the end effector, placed in the station by the estimate.
    const Eigen::Vector3d held(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d in_station = made.station_from_end_effector * held;
    EXPECT_LT((estimate * in_station - camera_from_end_effector * held).norm(), 1e-12);
    // The same place, seen from where the seed thought the end effector to be.
    const Eigen::Vector3d by_seed = camera_from_end_effector.inverse() * (seed * in_station);
    EXPECT_LT((made.end_effector_seed_from_end_effector_estimated * held - by_seed).norm(), 1e-12);
  }
}

/// The scatter of the results over draws of the pose, against what is said of it.
TEST(EndEffectorPose, TheCovarianceIsTheScatterOfDraws) {
  Random random = randomFor("EndEffectorPose.Covariance");
  const Pose seed = randomPose(random);
  const Pose estimate = randomPose(random);
  const Pose camera_from_end_effector = randomPose(random);
  const Matrix6d covariance = randomCovariance(random, 1e-4);
  const EndEffectorPose made =
      endEffectorPose(seed, estimate, camera_from_end_effector, covariance);
  const Matrix6d root = covariance.llt().matrixL();
  Matrix6d scatter = Matrix6d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose drawn = perturbed(root * randomVector6(random), estimate);
    const Pose correction = endEffectorPose(seed, drawn, camera_from_end_effector, covariance)
                                .end_effector_seed_from_end_effector_estimated;
    // Right perturbation: made * Exp(xi) == drawn.
    const Vector6d xi = perturbationBetween(
        Pose(), made.end_effector_seed_from_end_effector_estimated.inverse() * correction);
    scatter += xi * xi.transpose() / kDraws;
  }
  const Vector6d sigma = made.covariance.diagonal().cwiseSqrt();
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      EXPECT_NEAR(scatter(row, column), made.covariance(row, column),
                  0.03 * sigma[row] * sigma[column])
          << row << ", " << column;
}

}  // namespace
}  // namespace boresight::test
