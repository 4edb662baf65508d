// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/hand_eye.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::randomFor;
using test::randomPose;

constexpr double kRotation_rad = 2e-3;
constexpr double kTranslation_m = 1e-3;

struct Truth {
  Pose camera_from_end_effector;
  Pose base_from_station;
};

Vector6d noise(Random& random) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = random.normal() * (i < 3 ? kRotation_rad : kTranslation_m);
  return xi;
}

/// Postures whose end effectors are off by the stated sigmas; turned about one axis only on demand.
std::vector<ArmPosture> posturesOf(const Truth& truth, int count, bool about_one_axis,
                                   Random& random) {
  std::vector<ArmPosture> postures;
  for (int i = 0; i < count; ++i) {
    Vector6d xi = Vector6d::Zero();
    for (int axis = about_one_axis ? 2 : 0; axis < 3; ++axis) xi[axis] = random.uniform(-0.7, 0.7);
    Pose camera_from_station = perturbed(xi, Pose());
    camera_from_station.translation_m = {random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                                         random.uniform(0.3, 0.6)};
    const Pose base_from_end_effector =
        truth.base_from_station * camera_from_station.inverse() * truth.camera_from_end_effector;
    // Right perturbation: in the end effector's frame.
    postures.push_back({base_from_end_effector * perturbed(noise(random), Pose()),
                        camera_from_station, kRotation_rad, kTranslation_m});
  }
  return postures;
}

TEST(HandEye, TruthLiesWithinThreeSigma) {
  Random random = randomFor("HandEye.ThreeSigma");
  int outside = 0;
  Vector6d squares = Vector6d::Zero();
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Truth truth{randomPose(random), randomPose(random)};
    const auto postures = posturesOf(truth, 12, false, random);
    const HandEye result = calibrateHandEye(
        postures, perturbed(0.02 * test::normalVector6(random), truth.camera_from_end_effector));
    EXPECT_TRUE(result.undetermined.empty());
    const Vector6d error =
        perturbationBetween(result.camera_from_end_effector, truth.camera_from_end_effector);
    const Vector6d normalized = error.cwiseQuotient(result.covariance.diagonal().cwiseSqrt());
    outside += normalized.cwiseAbs().maxCoeff() > 3.0;
    squares += normalized.cwiseAbs2() / kTrials;
  }
  // One of six exceeds 3 sigma in 1.6 % of the trials: 3.2 of 200, and 8 in 1 of 70.
  EXPECT_LE(outside, 8);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(squares[i], 1.0, 4.0 * std::sqrt(2.0 / kTrials)) << i;
}

/// Where nothing is known of the place, residuals begin at a hundred sigmas and more.
TEST(HandEye, IsFoundFromAStartThatIsFarOff) {
  Random random = randomFor("HandEye.Far");
  for (int trial = 0; trial < 20; ++trial) {
    Vector6d place;
    for (int i = 0; i < 6; ++i) place[i] = random.uniform(-0.3, 0.3);
    const Truth truth{perturbed(place, Pose()), randomPose(random)};
    const HandEye result = calibrateHandEye(posturesOf(truth, 12, false, random), Pose());
    EXPECT_LT(
        perturbationBetween(result.camera_from_end_effector, truth.camera_from_end_effector).norm(),
        0.02);
    EXPECT_LT(result.noise_factor, 2.0);
  }
}

TEST(HandEye, TurnsAboutOneAxisLeaveADirectionOpenAndTwoPosturesAreRefused) {
  Random random = randomFor("HandEye.OneAxis");
  const Truth truth{Pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.39}}, randomPose(random)};
  const HandEye result =
      calibrateHandEye(posturesOf(truth, 12, true, random), truth.camera_from_end_effector);
  ASSERT_FALSE(result.undetermined.empty());
  EXPECT_NE(result.undetermined[0].text.find("translation_z_m"), std::string::npos)
      << result.undetermined[0].text;
  EXPECT_THROW((void)calibrateHandEye(posturesOf(truth, 2, false, random), Pose()),
               std::invalid_argument)
      << "three postures are needed";
}

}  // namespace
}  // namespace boresight::sessions
