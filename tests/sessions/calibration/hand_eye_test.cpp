// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/hand_eye.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/coverage.h"
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

TEST(HandEye, SigmasHoldTheErrors) {
  Random random = randomFor("HandEye.Sigmas");
  std::array<std::vector<double>, 6> errors;
  for (int draw = 0; draw < 1000; ++draw) {
    const Truth truth{randomPose(random), randomPose(random)};
    const HandEye result = calibrateHandEye(
        posturesOf(truth, 10, false, random),
        perturbed(0.02 * test::normalVector6(random), truth.camera_from_end_effector));
    EXPECT_TRUE(result.undetermined.empty());
    const Vector6d error =
        perturbationBetween(result.camera_from_end_effector, truth.camera_from_end_effector);
    const Vector6d sigma = result.covariance.diagonal().cwiseSqrt();
    for (int i = 0; i < 6; ++i) errors[static_cast<std::size_t>(i)].push_back(error[i] / sigma[i]);
  }
  for (const std::vector<double>& component : errors) test::expectGaussianCoverage(component);
}

TEST(HandEye, EachStationHasItsOwnPlaceInTheBase) {
  Random random = randomFor("HandEye.Stations");
  const Truth first{randomPose(random), randomPose(random)};
  const Truth second{first.camera_from_end_effector, randomPose(random)};
  std::vector<ArmPosture> postures = posturesOf(first, 6, false, random);
  for (ArmPosture posture : posturesOf(second, 6, false, random)) {
    posture.station = 1;
    postures.push_back(posture);
  }
  const HandEye result = calibrateHandEye(postures, first.camera_from_end_effector);
  EXPECT_TRUE(result.undetermined.empty());
  EXPECT_LT(result.noise_factor, 2.0);
  ASSERT_EQ(result.base_from_station.size(), 2u);
  EXPECT_LT(perturbationBetween(result.base_from_station[1], second.base_from_station).norm(), 0.1);
  const Vector6d sigma = result.covariance.diagonal().cwiseSqrt();
  const Vector6d error =
      perturbationBetween(result.camera_from_end_effector, first.camera_from_end_effector);
  EXPECT_LT(error.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 4.0);
  postures[0].station = 5;
  EXPECT_THROW((void)calibrateHandEye(postures, Pose()), std::invalid_argument);
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
