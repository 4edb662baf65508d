// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/problem.h"

#include <gtest/gtest.h>

#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

TEST(SeedConcern, NamesAStationBehindTheCameraOrOutOfView) {
  const test::ExampleCase example("bc");
  const auto concern = [&example](const Eigen::Vector3d& moved_m) {
    Pose seed = example.seed.camera_from_station;
    seed.translation_m += moved_m;
    return seedConcern(example.camera, example.scene.view(), seed);
  };
  EXPECT_EQ(concern({0.0, 0.0, 0.0}), "");
  EXPECT_EQ(concern({0.15, 0.0, 0.0}), "") << "it is partly in view";
  EXPECT_THAT(concern({0.0, 0.0, -2.0}), HasSubstr("behind the camera"));
  EXPECT_THAT(concern({2.0, 0.0, 0.0}), HasSubstr("out of view"));
  EXPECT_THAT(concern({0.0, -2.0, 0.0}), HasSubstr("out of view"));
}

TEST(SeedConcernOfAWall, AcceptsFacesThatCoverTheImageWithoutAVertexInIt) {
  const std::vector<Eigen::Vector3f> vertices = {
      {-50.0F, -50.0F, 0.0F}, {50.0F, -50.0F, 0.0F}, {0.0F, 80.0F, 0.0F}};
  const std::vector<Face> faces = {{{0, 1, 2}}};
  const std::vector<std::uint16_t> part_of_face = {0};
  const std::vector<ScenePart> parts(1);
  Pose pose;
  pose.translation_m = {0.0, 0.0, 1.0};
  EXPECT_EQ(
      seedConcern(test::makePinhole(640, 480, 600.0), {vertices, faces, part_of_face, parts}, pose),
      "");
}

}  // namespace
}  // namespace boresight::sessions
