// SPDX-License-Identifier: Apache-2.0
#include "core/search/twin_test.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// A plate with two equal boxes; `mark` adds a cylinder beside one of them, which a half turn about
/// z brings beside the other.
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

std::vector<Twin> twinsOf(const Case& scene) {
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
  TwinTest test;
  EXPECT_EQ(buildAdjacency(from.mesh, arena, adjacency), Status::kOk);
  EXPECT_EQ(renderer.create(from.mesh, adjacency, TwinTest::kLongestView_px,
                            TwinTest::kLongestView_px, RenderOptions(), arena),
            Status::kOk);
  EXPECT_EQ(test.create(ColorView::kChannels, arena), Status::kOk);
  int steps = 0;
  if (test.begin(problem, scene.truth, renderer))
    while (!test.step() && steps < 100000) ++steps;
  EXPECT_LT(steps, 100000);
  return {test.twins().begin(), test.twins().end()};
}

TEST(TwinTest, MeshThatAHalfTurnLeavesAsItIs_HasNoTwin) {
  const Shown shown(plateWithTwoBoxes(false), plateWithTwoBoxes(false));
  EXPECT_TRUE(twinsOf(shown.scene).empty());
}

TEST(TwinTest, MarkThatTheImageShows_LeavesNoTwinOfAsMuchEvidence) {
  const Shown shown(plateWithTwoBoxes(true), plateWithTwoBoxes(true));
  for (const Twin& twin : twinsOf(shown.scene)) EXPECT_GT(twin.margin_nats, 5.0);
}

TEST(TwinTest, PoseTurnedByHalfATurn_HasTheTruthForATwinOfMoreEvidence) {
  Shown shown(plateWithTwoBoxes(true), plateWithTwoBoxes(true));
  const Pose truth = shown.scene.truth;
  shown.scene.truth.rotation = truth.rotation * rotationExp({0.0, 0.0, kPi});
  const std::vector<Twin> twins = twinsOf(shown.scene);
  ASSERT_FALSE(twins.empty());
  EXPECT_LT(twins[0].margin_nats, -5.0);
  EXPECT_LT(twins[0].similarity, 0.95);
  EXPECT_LT(meanDisplacement_px(shown.scene.solid, shown.scene.camera, truth,
                                twins[0].camera_from_station),
            2.0);
}

TEST(SurfaceAxes, OfABox_AreItsOwnTheShortestFirst) {
  Solid solid;
  solid.addBox(0.01, -0.02, 0.06, 0.03, 0.4, 0.1, 0.12, 0.5);
  const SurfaceAxes surface = surfaceAxesOf(solid.view());
  EXPECT_LT((surface.middle_m - Eigen::Vector3d(0.01, -0.02, 0.11)).norm(), 1e-6);
  const Eigen::Vector3d longest(cosine(0.4), sine(0.4), 0.0);
  EXPECT_NEAR(std::abs(surface.axes.col(0).z()), 1.0, 1e-5);
  EXPECT_NEAR(std::abs(surface.axes.col(2).dot(longest)), 1.0, 1e-5);
  EXPECT_LT((surface.axes.transpose() * surface.axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace boresight::test
