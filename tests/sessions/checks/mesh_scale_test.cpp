// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/mesh_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "sessions/checks/checks.h"
#include "tests/sessions/checks/drawn_box.h"
#include "tests/sessions/checks/find_check.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

const Eigen::Vector3d kPoint_m(0.02, -0.01, 0.03);

/// The pose in which a camera at `centre_m` sees the station with a mesh `scale` times too large:
/// the point appears farther along its own line of sight.
Pose seenFrom(const Eigen::Vector3d& centre_m, const Pose& camera_from_station, double scale) {
  Pose seen = camera_from_station;
  const Eigen::Vector3d sight_m = camera_from_station * kPoint_m - centre_m;
  seen.translation_m += (scale - 1.0) * sight_m;
  return seen;
}

/// A camera and others of its rig, with errors of the stated sigma along each axis.
ReviewSubject rigOf(const Pose& camera_from_station, double scale, double sigma_m, Random& random,
                    const std::vector<Eigen::Vector3d>& centres_m) {
  const auto noisy = [&](Pose pose) {
    for (int i = 0; i < 3; ++i) pose.translation_m[i] += sigma_m * random.normal();
    return pose;
  };
  ReviewSubject subject;
  subject.camera_from_station =
      noisy(seenFrom(Eigen::Vector3d::Zero(), camera_from_station, scale));
  subject.covariance.picture = test::translationCovariance(sigma_m);
  for (const Eigen::Vector3d& centre_m : centres_m) {
    OtherPose other{"other", noisy(seenFrom(centre_m, camera_from_station, scale)), {}, centre_m};
    other.covariance = subject.covariance;
    subject.other_cameras.push_back(other);
  }
  return subject;
}

TEST(MeshScale, IsRecoveredFromABaseline) {
  Random random = test::randomFor("MeshScale.Recovered");
  Pose pose = test::randomPose(random);
  pose.translation_m = {0.05, -0.02, 0.6};
  for (const double scale : {0.93, 1.0, 1.005, 1.07}) {
    const auto found =
        meshScaleByRig(rigOf(pose, scale, 1e-9, random, {{0.1, 0.0, 0.02}}), kPoint_m);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->change, scale - 1.0, 1e-6);
  }
}

/// The scatter of estimates is the stated sigma; of two cameras less than of one.
TEST(MeshScale, SigmaIsTheScatter) {
  Random random = test::randomFor("MeshScale.Sigma");
  Pose pose;
  pose.translation_m = {0.0, 0.0, 0.5};
  double last_sigma = 1.0;
  for (const auto& centres_m : {std::vector<Eigen::Vector3d>{{0.1, 0.0, 0.0}},
                                std::vector<Eigen::Vector3d>{{0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}}) {
    double squares = 0.0;
    double sigma = 0.0;
    constexpr int kTrials = 2000;
    for (int i = 0; i < kTrials; ++i) {
      const auto found = meshScaleByRig(rigOf(pose, 1.0, 1e-4, random, centres_m), kPoint_m);
      ASSERT_TRUE(found);
      squares += found->change * found->change;
      sigma = found->sigma;
    }
    // The errors of the one camera are in every difference: with two others up to a third more.
    EXPECT_NEAR(std::sqrt(squares / kTrials) / sigma, centres_m.size() == 1 ? 1.0 : 1.1, 0.15);
    EXPECT_LT(sigma, last_sigma);
    last_sigma = sigma;
  }
}

TEST(MeshScale, WithoutABaseline_IsUnknown) {
  Random random = test::randomFor("MeshScale.None");
  for (const auto& centres_m : {std::vector<Eigen::Vector3d>(), {Eigen::Vector3d::Zero()}})
    EXPECT_FALSE(meshScaleByRig(rigOf(Pose(), 1.0, 1e-4, random, centres_m), kPoint_m));
  ReviewSubject unknown = rigOf(Pose(), 1.0, 1e-4, random, {{0.1, 0.0, 0.0}});
  unknown.other_cameras[0].covariance = {};
  EXPECT_FALSE(meshScaleByRig(unknown, kPoint_m));
}

TEST(MeshScale, Check_FailsBeyondWhatIsKnown) {
  const test::DrawnBox box;
  const ReviewSubject subject = box.subject(box.camera_from_station_);
  const Eigen::Vector3d middle_m = matchedBounds(subject.loaded->scene.view()).centre();
  const auto checkWith = [&](double scale, double sigma_m) {
    ReviewSubject rig = subject;
    const Eigen::Vector3d centre_m(0.15, 0.0, 0.0);
    const Eigen::Vector3d sight_m = subject.camera_from_station * middle_m;
    rig.covariance.picture = test::translationCovariance(sigma_m);
    rig.camera_from_station.translation_m += (scale - 1.0) * sight_m;
    OtherPose other{"other", subject.camera_from_station, rig.covariance, centre_m};
    other.camera_from_station.translation_m += (scale - 1.0) * (sight_m - centre_m);
    rig.other_cameras = {other};
    return test::findCheck(test::addedChecks(addAgreementChecks, rig, CheckLimits()), "mesh_scale");
  };
  EXPECT_EQ(checkWith(1.0, 1e-5).state, CheckState::kPassed);
  const Check wrong = checkWith(1.01, 1e-5);
  EXPECT_EQ(wrong.state, CheckState::kFailed);
  EXPECT_THAT(wrong.sentence, HasSubstr(" % smaller than its mesh"));
  EXPECT_EQ(checkWith(1.01, 3e-3).state, CheckState::kPassed) << "within three sigma";
}

}  // namespace
}  // namespace boresight::sessions
