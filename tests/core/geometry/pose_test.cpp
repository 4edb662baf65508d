// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

Eigen::Matrix4d homogeneous(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.matrix();
  matrix.topRightCorner<3, 1>() = pose.translation_m;
  return matrix;
}

Eigen::Matrix3d matrixOf(const Eigen::Vector3d& rotation_rad) {
  return Eigen::AngleAxisd(rotation_rad.norm(), rotation_rad.normalized()).toRotationMatrix();
}

TEST(Pose, AgreesWithItsMatrix) {
  Random random = randomFor("Pose.ActsLikeItsMatrix");
  for (int i = 0; i < 300; ++i) {
    const Pose a_from_b = randomPose(random);
    const Pose b_from_c = randomPose(random);
    const Eigen::Vector3d point = randomVector(random, 2.0);
    const Eigen::Vector3d by_matrix = (homogeneous(a_from_b) * point.homogeneous()).head<3>();
    EXPECT_LT((a_from_b * point - by_matrix).norm(), 1e-14);
    EXPECT_LT(
        (homogeneous(a_from_b * b_from_c) - homogeneous(a_from_b) * homogeneous(b_from_c)).norm(),
        1e-14);
    EXPECT_LT((homogeneous(a_from_b.inverse()) - homogeneous(a_from_b).inverse()).norm(), 1e-14);
    EXPECT_THAT(a_from_b * a_from_b.inverse(), poseNear(Pose{}, 1e-15, 4e-15));
  }
}

TEST(Pose, LongChainsStayRotations) {
  Random random = randomFor("Pose.LongChainsStayRotations");
  Pose chain;
  for (int i = 0; i < 100000; ++i) chain = Pose{randomRotation(random), {}} * chain;
  EXPECT_NEAR(chain.rotation.norm(), 1.0, 4e-16);
}

TEST(Pose, IsFinite_ChecksEveryNumber) {
  EXPECT_TRUE(Pose{}.isFinite());
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int i = 0; i < 7; ++i) {
      Pose pose;
      (i < 4 ? pose.rotation.coeffs()[i] : pose.translation_m[i - 4]) = bad;
      EXPECT_FALSE(pose.isFinite());
    }
  }
}

TEST(RotationExp, AgreesWithAngleAxisAtEveryScale) {
  Random random = randomFor("RotationExp.AgreesWithAngleAxis");
  for (int i = 0; i < 20000; ++i) {
    const double angle_rad = std::pow(10.0, random.uniform(-18.0, 0.49));
    const Eigen::Vector3d axis = randomDirection(random);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle_rad, axis));
    const Eigen::Quaterniond actual = rotationExp(angle_rad * axis);
    EXPECT_NEAR(actual.norm(), 1.0, 4e-16);
    // Relative to the angle: a tiny rotation keeps all its digits.
    EXPECT_LT((actual.vec() - expected.vec()).norm(), 1e-15 * std::min(1.0, angle_rad));
    EXPECT_NEAR(actual.w(), expected.w(), 1e-15);
  }
  EXPECT_EQ(rotationExp(Eigen::Vector3d::Zero()).coeffs(), Eigen::Quaterniond::Identity().coeffs());
  // Where the series takes over.
  for (const double angle_rad : {0.9999e-3, 1e-3, 1.0001e-3, 1e-2}) {
    const double expected = std::sin(0.5 * angle_rad);
    EXPECT_NEAR(rotationExp({angle_rad, 0.0, 0.0}).x(), expected, 4e-16 * expected);
  }
}

TEST(RotationLog, InvertsExpFromTinyAnglesToHalfATurn) {
  Random random = randomFor("RotationLog.InvertsExp");
  for (int i = 0; i < 20000; ++i) {
    const bool near_half_turn = i % 2 == 0;
    const double small = std::pow(10.0, random.uniform(-15.0, 0.0));
    const double angle_rad = near_half_turn ? kPi - small : small;
    const Eigen::Vector3d rotation_rad = angle_rad * randomDirection(random);
    const Eigen::Vector3d log = rotationLog(rotationExp(rotation_rad));
    EXPECT_LT((log - rotation_rad).norm(), 2e-15 * angle_rad) << "angle " << angle_rad;
  }
}

TEST(RotationLog, TakesTheShorterWayForEitherSign) {
  Random random = randomFor("RotationLog.TakesTheShorterWay");
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Quaterniond q = randomRotation(random);
    const Eigen::Quaterniond negative(-q.coeffs());
    EXPECT_LE(rotationLog(q).norm(), kPi + 1e-15);
    EXPECT_EQ(rotationLog(q), rotationLog(negative));
    const Eigen::Quaterniond again = rotationExp(rotationLog(q));
    EXPECT_LT(2.0 * (again.coeffs() * (again.dot(q) < 0.0 ? -1.0 : 1.0) - q.coeffs()).norm(),
              4e-15);
  }
}

TEST(RotationLog, SurvivesUnderflowAndExactHalfTurns) {
  EXPECT_EQ(rotationLog(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero());
  EXPECT_EQ(rotationLog({1.0, 1e-200, 0.0, 0.0}), Eigen::Vector3d(2e-200, 0.0, 0.0));
  EXPECT_EQ(rotationLog({-1.0, 1e-200, 0.0, 0.0}), Eigen::Vector3d(-2e-200, 0.0, 0.0));
  EXPECT_NEAR(rotationLog({0.0, 0.0, 1.0, 0.0}).y(), kPi, 1e-15);
  EXPECT_NEAR(rotationLog({0.0, 0.6, 0.0, -0.8}).norm(), kPi, 1e-15);
}

TEST(Perturbed, MovesPointsOnTheLeft) {
  Random random = randomFor("Perturbed.MovesPointsOnTheLeft");
  for (int i = 0; i < 500; ++i) {
    const Pose pose = randomPose(random);
    Vector6d xi;
    xi << randomVector(random, 1.0), randomVector(random, 1.0);
    const Eigen::Vector3d point = randomVector(random, 1.0);
    const Eigen::Vector3d expected = matrixOf(xi.head<3>()) * (pose * point) + xi.tail<3>();
    EXPECT_LT((perturbed(xi, pose) * point - expected).norm(), 1e-14);
    EXPECT_LT((perturbationBetween(pose, perturbed(xi, pose)) - xi).norm(), 1e-14);
    const Pose other = randomPose(random);
    EXPECT_THAT(perturbed(perturbationBetween(pose, other), pose), poseNear(other, 1e-14, 1e-14));
  }
}

TEST(PoseFromMatrix, ReturnsTheNearestRotation) {
  Random random = randomFor("PoseFromMatrix.ReturnsTheNearestRotation");
  for (int i = 0; i < 2000; ++i) {
    const double noise = i % 2 == 0 ? 1.5e-5 : 1e-12;
    const Eigen::Matrix3d exact = randomRotation(random).toRotationMatrix();
    Eigen::Matrix3d matrix = exact;
    for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) += random.uniform(-noise, noise);
    Pose pose;
    double deviation = -1.0;
    const Eigen::Vector3d translation_m = randomVector(random, 1.0);
    ASSERT_EQ(poseFromMatrix(matrix, translation_m, pose, deviation), Status::kOk);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
    EXPECT_LT((pose.matrix() - nearest).norm(), 3e-15);
    EXPECT_NEAR(deviation, (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm(),
                1e-15);
    EXPECT_NEAR(pose.rotation.norm(), 1.0, 4e-16);
    EXPECT_GE(pose.rotation.w(), 0.0);
    EXPECT_EQ(pose.translation_m, translation_m);
  }
}

TEST(PoseFromMatrix, HandlesHalfTurnsAboutEveryAxis) {
  Random random = randomFor("PoseFromMatrix.HandlesHalfTurns");
  for (int i = 0; i < 300; ++i) {
    Eigen::Vector3d axis =
        i < 3 ? Eigen::Vector3d(Eigen::Vector3d::Unit(i)) : randomDirection(random);
    const Eigen::Matrix3d matrix = 2.0 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
    Pose pose;
    double deviation = 0.0;
    ASSERT_EQ(poseFromMatrix(matrix, Eigen::Vector3d::Zero(), pose, deviation), Status::kOk);
    EXPECT_LT((pose.matrix() - matrix).norm(), 3e-15);
    EXPECT_GE(pose.rotation.w(), 0.0);
  }
}

TEST(PoseFromMatrix, RefusesMatricesThatAreNotRotations) {
  Pose pose;
  double deviation = 0.0;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  // |R'R - I| = sqrt(3) (s^2 - 1) for R = s I: on either side of 1e-4.
  const double allowed = std::sqrt(1.0 + 0.9999e-4 / std::sqrt(3.0));
  const double beyond = std::sqrt(1.0 + 1.0001e-4 / std::sqrt(3.0));
  EXPECT_EQ(poseFromMatrix(allowed * identity, zero, pose, deviation), Status::kOk);
  EXPECT_EQ(poseFromMatrix(beyond * identity, zero, pose, deviation), Status::kInvalidPose);
  EXPECT_NEAR(deviation, 1.0001e-4, 1e-10);
  EXPECT_EQ(poseFromMatrix(-identity, zero, pose, deviation), Status::kInvalidPose);
  EXPECT_EQ(poseFromMatrix(Eigen::Matrix3d::Zero(), zero, pose, deviation), Status::kInvalidPose);
  for (const double bad : {kNan, kInfinity, 1e300}) {
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d matrix = identity;
      matrix(k / 3, k % 3) = bad;
      EXPECT_EQ(poseFromMatrix(matrix, zero, pose, deviation), Status::kInvalidPose);
      EXPECT_TRUE(isFinite(deviation));
    }
  }
  for (const double bad : {kNan, kInfinity})
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(poseFromMatrix(identity, bad * Eigen::Vector3d::Unit(k), pose, deviation),
                Status::kInvalidPose);
}

TEST(OffsetAboutPivot, IsTheDisplacementOfTheConventions) {
  Random random = randomFor("OffsetAboutPivot");
  for (int i = 0; i < 500; ++i) {
    const Pose seed = randomCameraFromStation(random, 0.5);
    const Eigen::Vector3d pivot_m = seed * randomVector(random, 0.2);
    const Vector6d offset = randomOffset(random, scaled(SeedUncertainty{}, 5.0));
    const Pose pose = displacedAboutPivot(seed, offset, pivot_m);
    const Eigen::Vector3d point_in_station_m = randomVector(random, 0.3);
    const Eigen::Vector3d expected =
        matrixOf(offset.head<3>()) * (seed * point_in_station_m - pivot_m) + pivot_m +
        offset.tail<3>();
    EXPECT_LT((pose * point_in_station_m - expected).norm(), 1e-14);
    EXPECT_LT((offsetAboutPivot(seed, pose, pivot_m) - offset).norm(), 1e-14);
  }
}

TEST(Scaled, ScalesBothBoxesAndKeepsThePivot) {
  SeedUncertainty uncertainty;
  uncertainty.translation_m = {0.01, 0.02, 0.03};
  uncertainty.rotation_rad = {0.1, 0.2, 0.3};
  uncertainty.pivot_in_camera_m = {1.0, 2.0, 3.0};
  const SeedUncertainty twice = scaled(uncertainty, 2.0);
  EXPECT_EQ(twice.translation_m, Eigen::Vector3d(0.02, 0.04, 0.06));
  EXPECT_EQ(twice.rotation_rad, Eigen::Vector3d(0.2, 0.4, 0.6));
  EXPECT_EQ(twice.pivot_in_camera_m, Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace boresight::test
