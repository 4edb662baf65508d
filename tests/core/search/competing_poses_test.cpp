// SPDX-License-Identifier: Apache-2.0
#include "core/search/competing_poses.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

/// A plate with two equal boxes; `mark` adds a cylinder next to one of them, which a half turn
/// about z brings next to the other.
Solid plateWithTwoBoxes(bool mark) {
  Solid solid;
  solid.addBox(0.0, 0.0, 0.08, 0.05, 0.0, 0.0, 0.01, 0.5);
  solid.addBox(-0.05, 0.01, 0.012, 0.02, 0.0, 0.01, 0.04, 0.6);
  solid.addBox(0.05, -0.01, 0.012, 0.02, 0.0, 0.01, 0.04, 0.6);
  if (mark) solid.addCylinder(-0.01, 0.025, 0.018, 0.01, 0.05, 0.7);
  return solid;
}

/// A picture of `shown`, for runs of `scene.solid` at the truth.
struct Shown {
  Case scene = stationCase(1);
  Picture picture;

  Shown(const Solid& mesh, const Solid& shown) {
    scene.solid = mesh;
    scene.uncertainty = uncertaintyAbout(mesh, scene.truth);
    picture = takePicture(shown, scene.camera, scene.truth);
    scene.picture = &picture;
  }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
};

std::vector<CompetingPose> competingOf(const Case& scene) {
  const LocalizationProblem from = scene.problem();
  const SearchProblem problem{from.image,
                              from.color,
                              from.ignore,
                              from.camera,
                              from.mesh,
                              matchedBounds(from.mesh),
                              from.camera_from_station_seed,
                              from.uncertainty};
  std::vector<std::byte> block(16 << 20);
  Arena arena(block);
  MeshAdjacency adjacency;
  EdgeRenderer renderer;
  CompetingPoseTest test;
  EXPECT_EQ(buildAdjacency(from.mesh, arena, adjacency), Status::kOk);
  EXPECT_EQ(renderer.create(from.mesh, adjacency, CompetingPoseTest::kLongestView_px,
                            CompetingPoseTest::kLongestView_px, RenderOptions(), arena),
            Status::kOk);
  EXPECT_EQ(test.create(ColorView::kChannels, arena), Status::kOk);
  int steps = 0;
  if (test.begin(problem, scene.truth, renderer))
    while (!test.step() && steps < 100000) ++steps;
  EXPECT_LT(steps, 100000);
  return {test.poses().begin(), test.poses().end()};
}

TEST(CompetingPoses, MeshSymmetricUnderAHalfTurn_HasNoCompetingPose) {
  const Shown shown(plateWithTwoBoxes(false), plateWithTwoBoxes(false));
  EXPECT_TRUE(competingOf(shown.scene).empty());
}

TEST(CompetingPoses, VisibleAsymmetry_LeavesNoCompetingPoseOfEqualEvidence) {
  const Shown shown(plateWithTwoBoxes(true), plateWithTwoBoxes(true));
  for (const CompetingPose& pose : competingOf(shown.scene)) EXPECT_GT(pose.margin_nats, 5.0);
}

TEST(CompetingPoses, PoseTurnedByHalfATurn_CompetesWithTheTruthWhichHasMoreEvidence) {
  Shown shown(plateWithTwoBoxes(true), plateWithTwoBoxes(true));
  const Pose truth = shown.scene.truth;
  shown.scene.truth.rotation = truth.rotation * rotationExp({0.0, 0.0, kPi});
  const std::vector<CompetingPose> competing = competingOf(shown.scene);
  ASSERT_FALSE(competing.empty());
  EXPECT_LT(competing[0].margin_nats, -5.0);
  EXPECT_LT(competing[0].similarity, 0.95);
  EXPECT_LT(meanDisplacement_px(shown.scene.solid, shown.scene.camera, truth,
                                competing[0].camera_from_station),
            2.0);
}

TEST(CompetingPoses, RailWithoutVisibleEnds_CompetesWithThePoseOnePitchFurther) {
  const Case scene = railCase(Ends::kOutside, 0.0, 1.7, 3);
  const std::vector<CompetingPose> competing = competingOf(scene);
  ASSERT_FALSE(competing.empty());
  double nearest_pitches = 1e9;
  for (const CompetingPose& pose : competing) {
    const double pitches = std::abs(pitchError(scene, pose.camera_from_station).pitches);
    nearest_pitches = std::min(nearest_pitches, std::abs(pitches - 1.0));
  }
  EXPECT_LT(nearest_pitches, 0.1);
}

}  // namespace
}  // namespace boresight::test
