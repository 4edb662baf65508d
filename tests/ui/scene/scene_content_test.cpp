// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_content.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "sessions/trace/scene_render.h"
#include "tests/support/box_mesh.h"
#include "tests/support/random_pose.h"
#include "tests/ui/scene/scene_fixture.h"
#include "ui/scene/scene_aim.h"

namespace boresight::ui {
namespace {

class SceneContentTest : public ::testing::Test {
 protected:
  SceneContentTest() { test::showRun(state_); }

  ViewState state_;
};

TEST_F(SceneContentTest, HoldsTheCamerasOfTheRunAtTheCursor) {
  EXPECT_TRUE(sceneContent(ViewState()).empty()) << "there is no case";
  const SceneContent content = sceneContent(state_);
  ASSERT_EQ(content.frusta.size(), 3u);
  for (const Frustum& frustum : content.frusta) {
    const Pose pose = poseOf(state_, frustum.role).value();
    EXPECT_LT((pose * frustum.apex_m).norm(), 1e-12);
    // Its corners project to the image's.
    const Camera& camera = content.one->source.camera;
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, pose * frustum.corner_m[2], pixel));
    EXPECT_NEAR(pixel.x(), camera.width - 0.5, 1e-4);
    EXPECT_NEAR(pixel.y(), camera.height - 0.5, 1e-4);
  }
  EXPECT_EQ(content.trail_m.size(), state_.snapshot()->iterations.size() + 1);
  EXPECT_EQ(content.trail_now, state_.cursor().iteration + 1);
  state_.setNudgedPose(state_.shownPose());
  EXPECT_EQ(sceneContent(state_).frusta.size(), 4u);
}

/// Edges of a million faces were searched again for each stroke of the mask: 1.4 s.
TEST_F(SceneContentTest, SameMesh_IsWhatAnEditOfTheMaskLeaves_NotAnotherPart) {
  const SceneContent before = sceneContent(state_);
  const auto edited = [](const auto& change) {
    auto next = std::make_shared<sessions::LoadedCase>();
    next->source = test::sceneCase()->source;
    next->scene = test::sceneCase()->scene;
    change(next->source);
    SceneContent content;
    content.one = next;
    return content;
  };
  EXPECT_TRUE(sameMesh(before, edited([](auto& source) { source.ignore_strokes.emplace_back(); })));
  EXPECT_FALSE(sameMesh(before, edited([](auto& source) { source.parts.clear(); })));
  EXPECT_FALSE(sameMesh(before, SceneContent()));
  EXPECT_TRUE(sameMesh(SceneContent(), SceneContent()));
}

TEST_F(SceneContentTest, EachCameraCarriesThePartsThatAreFixedToIt) {
  const std::size_t before = sceneContent(state_).frusta.front().lines.size();
  auto held = std::make_shared<sessions::LoadedCase>();
  held->source = test::sceneCase()->source;
  held->image = test::sceneCase()->image;
  held->scene = test::sceneCase()->scene;
  sessions::Mesh finger;
  finger.vertices_m = {{0.0F, 0.0F, 0.2F}, {0.01F, 0.0F, 0.2F}, {0.0F, 0.01F, 0.2F}};
  finger.faces = {Face{{0, 1, 2}}};
  ScenePart part;
  part.match = false;
  part.fixed_to_camera = true;
  sessions::addPart(held->scene, finger, Pose(), part, 1.0);
  state_.setCase(held);
  const SceneContent content = sceneContent(state_);
  ASSERT_GE(content.frusta.size(), 1u);
  for (const Frustum& frustum : content.frusta) {
    const Pose pose = poseOf(state_, frustum.role).value();
    const auto distance_m = [&pose](const Eigen::Vector3d& at_m) {
      return (pose * at_m - Eigen::Vector3d(0.01, 0.0, 0.2)).norm();
    };
    double nearest_m = 1.0;
    for (const SceneLine& line : frustum.lines)
      nearest_m = std::min({nearest_m, distance_m(line.first), distance_m(line.second)});
    EXPECT_LT(nearest_m, 1e-8) << "an edge begins or ends at the finger's tip";
  }
  EXPECT_EQ(content.frusta.front().lines.size(), before + 3);
  EXPECT_EQ(content.mesh().faces.size(), test::sceneCase()->scene.faces.size());
}

TEST_F(SceneContentTest, CameraOfARejectedRunLooksRejected) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*state_.snapshot());
  run->status = LocalizationStatus::kPnpFailed;
  state_.setSnapshot(run);
  for (const Frustum& frustum : sceneContent(state_).frusta) {
    EXPECT_EQ(frustum.rejected, frustum.role == PoseRole::kEstimate);
    if (!frustum.rejected) continue;
    EXPECT_NE(frustum.color, poseRoleStyle(PoseRole::kEstimate).color);
    EXPECT_GT(frustum.lines.size(), 20u) << "dots";
  }
}

TEST_F(SceneContentTest, TellsInliersFromOutliersAsThePoseDid) {
  const SceneContent content = sceneContent(state_);
  const sessions::IterationTrace& iteration = *state_.iteration();
  ASSERT_EQ(content.points.size(), iteration.templates.size());
  EXPECT_EQ(std::ranges::count(content.points, ScenePointKind::kInlier, &ScenePoint::kind),
            iteration.pnp.inlier_count);
  for (std::size_t i = 0; i < iteration.template_of.size(); ++i) {
    const auto of = static_cast<std::size_t>(iteration.template_of[i]);
    EXPECT_EQ(content.points[of].residual_px, iteration.pnp.residual_px[i]);
    EXPECT_EQ(content.points[of].at_m, iteration.templates[of].point_in_station_m);
  }
}

TEST_F(SceneContentTest, ShowsTheEdgePlacesOfARefinement) {
  for (int i = 0; i < static_cast<int>(state_.snapshot()->iterations.size()); ++i) {
    state_.setCursor({i, Stage::kFinished});
    if (state_.iteration()->kind != IterationKind::kRefine) continue;
    const SceneContent content = sceneContent(state_);
    EXPECT_EQ(content.points.size(), state_.iteration()->refinement.samples.size());
    for (const ScenePoint& point : content.points) EXPECT_EQ(point.template_index, -1);
    return;
  }
  GTEST_SKIP() << "this run has no refinement";
}

TEST(Dashed, CoversTheShareThatTheDashesSay) {
  const SceneLine line = {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 6, 3)};
  std::set<std::size_t> counts;
  for (int i = 0; i < kPoseRoles; ++i) {
    const auto& dashes = poseRoleStyle(static_cast<PoseRole>(i)).dashes;
    double drawn = 0.0, period = 0.0, length = 0.0;
    for (std::size_t part = 0; part < dashes.size(); ++part) {
      period += dashes[part];
      if (part % 2 == 0) drawn += dashes[part];
    }
    const auto pieces = dashed(line, dashes);
    for (const SceneLine& piece : pieces) length += (piece.second - piece.first).norm();
    EXPECT_NEAR(length, 5.0 * (dashes.empty() ? 1.0 : drawn / period), 1e-9);
    EXPECT_EQ(pieces.front().first, line.first);
    counts.insert(pieces.size() * 100 + static_cast<std::size_t>(length * 10));
  }
  EXPECT_EQ(counts.size(), static_cast<std::size_t>(kPoseRoles)) << "two roles look alike";
}

TEST(SharpEdges, OfACubeAreItsTwelve) {
  sessions::SceneMesh cube = test::boxMesh({0.5, 0.5, 0.5});
  for (const std::size_t inwards : {0u, 1u, 6u, 7u, 8u, 9u})  // three sides are wound so
    std::swap(cube.faces[inwards].vertex[0], cube.faces[inwards].vertex[1]);
  const auto edges = sharpEdges(cube.view());
  EXPECT_EQ(edges.size(), 12u);
  for (const SceneLine& edge : edges) EXPECT_EQ((edge.first - edge.second).norm(), 1.0);
}

/// Two squares behind each other, seen from straight ahead: the near one is smaller.
struct Stack {
  SceneContent content;
  Viewpoint view;

  explicit Stack(const std::vector<Eigen::Vector3d>& templates_m) {
    auto value = std::make_shared<sessions::LoadedCase>();
    value->scene.parts.resize(1);
    for (const auto& [z, half] : {std::pair(0.0F, 0.05F), {0.1F, 0.1F}}) {
      const auto first = static_cast<std::int32_t>(value->scene.vertices_in_station_m.size());
      for (const auto& [x, y] :
           {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
        value->scene.vertices_in_station_m.emplace_back(x, y, z);
      test::addQuad(value->scene, first, first + 1, first + 2, first + 3);
    }
    content.one = value;
    content.bounds.minimum_m = {-0.1, -0.1, 0.0};
    content.bounds.maximum_m = {0.1, 0.1, 0.1};
    view.view_from_station.translation_m = {0.0, 0.0, 0.5};
    view.camera = test::makePinhole(400, 400, 500.0);
    for (const Eigen::Vector3d& at_m : templates_m) {
      ScenePoint& point = content.points.emplace_back();
      point.at_m = at_m;
      point.template_index = static_cast<int>(content.points.size()) - 1;
    }
  }

  int pick(const Eigen::Vector3d& at_m) const {
    return pickTemplate(content, view, view.toCanvas(at_m).value());
  }
};

TEST(PickTemplate, TakesTheNearestWithinReach_OfTemplatesAlone) {
  Stack stack({{0.01, 0.0, 0.0}, {0.02, 0.0, 0.0}});
  EXPECT_EQ(stack.pick({0.012, 0.0, 0.0}), 0);
  EXPECT_EQ(stack.pick({0.018, 0.0, 0.0}), 1);
  EXPECT_EQ(stack.pick({0.0, 0.03, 0.0}), -1);
  for (ScenePoint& point : stack.content.points) point.template_index = -1;
  EXPECT_EQ(stack.pick({0.01, 0.0, 0.0}), -1);
}

TEST(PickTemplate, SeesNoneBehindAFace) {
  const Stack stack({{0.0, 0.0, 0.1},     // behind the near square
                     {0.09, 0.0, 0.1}});  // next to it
  EXPECT_EQ(stack.pick({0.0, 0.0, 0.1}), -1);
  EXPECT_EQ(stack.pick({0.09, 0.0, 0.1}), 1);
}

}  // namespace
}  // namespace boresight::ui
