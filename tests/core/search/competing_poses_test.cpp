// SPDX-License-Identifier: Apache-2.0
#include "core/search/competing_poses.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/accept/pose_evidence.h"
#include "core/base/math.h"
#include "core/edges/direction_distance.h"
#include "tests/core/localizer/rail_scene.h"
#include "tests/core/search/search_scene.h"

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

/// A plate at the truth with its picture.
struct Shown {
  Case scene = stationCase(1);
  Picture picture;

  explicit Shown(const Solid& mesh) {
    scene.solid = mesh;
    scene.uncertainty = uncertaintyAbout(mesh, scene.truth);
    picture = takePicture(mesh, scene.camera, scene.truth);
    scene.picture = &picture;
  }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
};

std::vector<CompetingPose> competingOf(const Case& scene) {
  const SearchProblem problem = searchOf(scene);
  std::vector<std::byte> block(16 << 20);
  Arena arena(block);
  MeshAdjacency adjacency;
  EdgeRenderer renderer;
  CompetingPoseTest test;
  EXPECT_EQ(buildAdjacency(problem.mesh, arena, adjacency), Status::kOk);
  EXPECT_EQ(renderer.create(problem.mesh, adjacency, CompetingPoseTest::kLongestView_px,
                            CompetingPoseTest::kLongestView_px, RenderOptions(), arena),
            Status::kOk);
  EXPECT_EQ(test.create(ColorView::kChannels, arena), Status::kOk);
  int steps = 0;
  if (test.begin(problem, scene.truth, renderer))
    while (!test.step() && steps < 100000) ++steps;
  EXPECT_LT(steps, 100000);
  return {test.poses().begin(), test.poses().end()};
}

/// Similarity and margin of two poses by their definition, from renders in the finest view.
CompetingPose comparedPlainly(const Case& scene, const Pose& found, const Pose& other) {
  const SearchProblem problem = searchOf(scene);
  std::vector<std::byte> block(4 << 20);
  Arena arena(block);
  ViewEdges view;
  (void)view.create(CompetingPoseTest::kLongestView_px, ColorView::kChannels, arena);
  const ViewSize size{.span_px = kEvidenceSpan_px[0],
                      .margin_px = kViewMargin * kEvidenceSpan_px[0],
                      .most_px = CompetingPoseTest::kLongestView_px};
  EXPECT_TRUE(view.begin(problem, found, size));
  while (!view.step()) {
  }
  const DirectedEdges& image = view.edges();
  const auto pixels = static_cast<std::size_t>(image.width * image.height);
  std::vector<std::uint8_t> direction[2];
  DirectedEdges marks[2] = {image, image};
  for (int k = 0; k < 2; ++k) {
    const Rendering render =
        renderEdges(scene.solid, view.view().camera, view.inView(k == 0 ? found : other));
    direction[k] = directionsOf(render.edges, image.width, image.height);
    marks[k].direction = direction[k];
  }
  double share[2] = {};
  double nats[2] = {};
  std::vector<std::uint8_t> to_image(pixels);
  std::vector<std::uint8_t> to_other(pixels);
  for (int k = 0; k < 2; ++k) {
    int all = 0;
    int alone = 0;
    for (int d = 0; d < kEdgeDirections; ++d) {
      distanceToDirection(image, d, to_image);
      distanceToDirection(marks[1 - k], d, to_other);
      for (std::size_t i = 0; i < pixels; ++i) {
        if (direction[k][i] != d || image.direction[i] == DirectedEdges::kUnseen) continue;
        ++all;
        if (to_other[i] * kDistanceUnit_px < 3.05) continue;
        ++alone;
        const int at = static_cast<int>(i);
        nats[k] += evidenceOfPlace(
                       {static_cast<std::int16_t>(at % image.width),
                        static_cast<std::int16_t>(at / image.width), static_cast<std::uint8_t>(d)},
                       image, to_image, kEvidenceWindow * view.view().span_px)
                       .nats;
      }
    }
    share[k] = alone / static_cast<double>(all);
  }
  return {other, 1.0 - 0.5 * (share[0] + share[1]), (nats[0] - nats[1]) / kAlongEdge_px, false};
}

TEST(CompetingPoses, MeshSymmetricUnderAHalfTurn_HasNoCompetingPose) {
  EXPECT_TRUE(competingOf(Shown(plateWithTwoBoxes(false)).scene).empty());
}

TEST(CompetingPoses, VisibleAsymmetry_GivesTheTruthMoreEvidenceThanItsHalfTurn) {
  Shown shown(plateWithTwoBoxes(true));
  for (const CompetingPose& pose : competingOf(shown.scene)) EXPECT_GT(pose.margin_nats, 5.0);
  const Pose truth = shown.scene.truth;
  shown.scene.truth.rotation = truth.rotation * rotationExp({0.0, 0.0, kPi});
  const std::vector<CompetingPose> competing = competingOf(shown.scene);
  ASSERT_FALSE(competing.empty());
  EXPECT_LT(competing[0].margin_nats, -5.0);
  EXPECT_LT(competing[0].similarity, 0.95);
  for (const CompetingPose& pose : competing) {
    const CompetingPose plain =
        comparedPlainly(shown.scene, shown.scene.truth, pose.camera_from_station);
    EXPECT_NEAR(pose.similarity, plain.similarity, 1e-3);  // poses are rounded
    EXPECT_NEAR(pose.margin_nats, plain.margin_nats, 0.01 * std::abs(plain.margin_nats));
  }
  EXPECT_LT(meanDisplacement_px(shown.scene.solid, shown.scene.camera, truth,
                                competing[0].camera_from_station),
            2.0);
}

TEST(CompetingPoses, RailWithoutVisibleEnds_CompetesWithThePoseOnePitchFurther) {
  const Case scene = railCase(Ends::kOutside, 0.0, 1.7, 3);
  const std::vector<CompetingPose> competing = competingOf(scene);
  ASSERT_FALSE(competing.empty());
  EXPECT_TRUE(std::ranges::any_of(competing, [&scene](const CompetingPose& pose) {
    const double pitches = std::abs(pitchError(scene, pose.camera_from_station).pitches);
    return std::abs(pitches - 1.0) < 0.1;
  }));
}

}  // namespace
}  // namespace boresight::test
