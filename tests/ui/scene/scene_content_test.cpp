// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_content.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "sessions/trace/scene_render.h"
#include "tests/support/random_pose.h"
#include "tests/ui/scene/scene_fixture.h"
#include "ui/scene/scene_aim.h"

namespace boresight::ui {
namespace {

TEST(SceneContent, IsEmptyWithoutACase) {
  const ViewState state;
  EXPECT_TRUE(sceneContent(state).empty());
}

TEST(SceneContent, HoldsTheCamerasOfTheRunAtTheCursor) {
  ViewState state;
  test::showRun(state);
  const SceneContent content = sceneContent(state);
  ASSERT_EQ(content.frusta.size(), 3u);
  for (const Frustum& frustum : content.frusta) {
    const Pose pose = poseOf(state, frustum.role).value();
    EXPECT_LT((pose * frustum.apex_m).norm(), 1e-12);
    // Its corners project to the image's.
    const Camera& camera = content.one->source.camera;
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, pose * frustum.corner_m[2], pixel));
    EXPECT_NEAR(pixel.x(), camera.width - 0.5, 1e-4);
    EXPECT_NEAR(pixel.y(), camera.height - 0.5, 1e-4);
  }
  EXPECT_EQ(content.trail_m.size(), state.snapshot()->iterations.size() + 1);
  EXPECT_EQ(content.trail_now, state.cursor().iteration + 1);
  state.setNudgedPose(state.shownPose());
  EXPECT_EQ(sceneContent(state).frusta.size(), 4u);
}

TEST(SceneContent, EachCameraCarriesThePartsThatAreFixedToIt) {
  ViewState state;
  test::showRun(state);
  const std::size_t before = sceneContent(state).frusta.front().lines.size();
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
  state.setCase(held);
  const SceneContent content = sceneContent(state);
  ASSERT_GE(content.frusta.size(), 1u);
  for (const Frustum& frustum : content.frusta) {
    const Pose pose = poseOf(state, frustum.role).value();
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

TEST(SceneContent, CameraOfARejectedRunLooksRejected) {
  ViewState state;
  test::showRun(state);
  auto run = std::make_shared<sessions::LocalizationTrace>(*state.snapshot());
  run->status = LocalizationStatus::kPnpFailed;
  state.setSnapshot(run);
  for (const Frustum& frustum : sceneContent(state).frusta) {
    const bool estimate = frustum.role == PoseRole::kEstimate;
    EXPECT_EQ(frustum.rejected, estimate);
    if (!estimate) continue;
    EXPECT_NE(frustum.color, poseRoleStyle(PoseRole::kEstimate).color);
    EXPECT_GT(frustum.lines.size(), 20u) << "dots";
  }
}

TEST(SceneContent, TellsInliersFromOutliersAsThePoseDid) {
  ViewState state;
  test::showRun(state);
  const SceneContent content = sceneContent(state);
  const sessions::IterationTrace& iteration = *state.iteration();
  ASSERT_EQ(content.points.size(), iteration.templates.size());
  int inliers = 0;
  for (const ScenePoint& point : content.points)
    if (point.kind == ScenePointKind::kInlier) ++inliers;
  EXPECT_EQ(inliers, iteration.pnp.inlier_count);
  for (std::size_t i = 0; i < iteration.template_of.size(); ++i) {
    const auto of = static_cast<std::size_t>(iteration.template_of[i]);
    EXPECT_EQ(content.points[of].residual_px, iteration.pnp.residual_px[i]);
    EXPECT_EQ(content.points[of].at_m, iteration.templates[of].point_in_station_m);
  }
}

TEST(SceneContent, ShowsTheEdgePlacesOfARefinement) {
  ViewState state;
  test::showRun(state);
  for (int i = 0; i < static_cast<int>(state.snapshot()->iterations.size()); ++i) {
    state.setCursor({i, Stage::kFinished});
    if (state.iteration()->kind != IterationKind::kRefine) continue;
    const SceneContent content = sceneContent(state);
    EXPECT_EQ(content.points.size(), state.iteration()->refinement.samples.size());
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
    double drawn = 0.0;
    double period = 0.0;
    double length = 0.0;
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
  std::vector<Eigen::Vector3f> vertices;
  for (int i = 0; i < 8; ++i)
    vertices.emplace_back(static_cast<float>(i & 1), static_cast<float>((i >> 1) & 1),
                          static_cast<float>((i >> 2) & 1));
  const std::vector<Face> faces = {{{0, 1, 3}}, {{0, 3, 2}}, {{4, 5, 7}}, {{4, 7, 6}},
                                   {{0, 1, 5}}, {{0, 5, 4}}, {{2, 3, 7}}, {{2, 7, 6}},
                                   {{0, 2, 6}}, {{0, 6, 4}}, {{1, 3, 7}}, {{1, 7, 5}}};
  const std::vector<std::uint16_t> part_of_face(12, 0);
  const std::vector<ScenePart> parts(1);
  const MeshView cube = {vertices, faces, part_of_face, parts};
  const auto edges = sharpEdges(cube);
  EXPECT_EQ(edges.size(), 12u);
  for (const auto& edge : edges)
    EXPECT_EQ(
        (vertices[static_cast<std::size_t>(edge[0])] - vertices[static_cast<std::size_t>(edge[1])])
            .norm(),
        1.0F);
}

/// Two squares behind each other, seen from straight ahead: the near one is smaller.
struct Stack {
  SceneContent content;
  Viewpoint view;

  Stack() {
    auto value = std::make_shared<sessions::LoadedCase>();
    for (const float z : {0.0F, 0.1F}) {
      const auto first = static_cast<std::int32_t>(value->scene.vertices_in_station_m.size());
      const float half = z == 0.0F ? 0.05F : 0.1F;
      for (const auto& [x, y] :
           {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
        value->scene.vertices_in_station_m.emplace_back(x, y, z);
      value->scene.faces.push_back({{first, first + 1, first + 2}});
      value->scene.faces.push_back({{first, first + 2, first + 3}});
    }
    value->scene.part_of_face.assign(4, 0);
    value->scene.parts.resize(1);
    content.one = value;
    content.bounds.minimum_m = {-0.1, -0.1, 0.0};
    content.bounds.maximum_m = {0.1, 0.1, 0.1};
    view.view_from_station.translation_m = {0.0, 0.0, 0.5};
    view.camera = test::makePinhole(400, 400, 500.0);
  }

  void addTemplate(const Eigen::Vector3d& at_m) {
    ScenePoint point;
    point.at_m = at_m;
    point.template_index = static_cast<int>(content.points.size());
    content.points.push_back(point);
  }
  QPointF at(const Eigen::Vector3d& at_m) const { return view.toCanvas(at_m).value(); }
};

TEST(PickTemplate, TakesTheNearestWithinReach) {
  Stack stack;
  stack.addTemplate({0.01, 0.0, 0.0});
  stack.addTemplate({0.02, 0.0, 0.0});
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.012, 0.0, 0.0})), 0);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.018, 0.0, 0.0})), 1);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.03, 0.0})), -1);
}

TEST(PickTemplate, SeesNoneBehindAFace) {
  Stack stack;
  stack.addTemplate({0.0, 0.0, 0.1});   // behind the near square
  stack.addTemplate({0.09, 0.0, 0.1});  // next to it
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.0, 0.1})), -1);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.09, 0.0, 0.1})), 1);
}

TEST(PickTemplate, LeavesOutPlacesThatAreNoTemplates) {
  Stack stack;
  stack.addTemplate({0.0, 0.0, 0.0});
  stack.content.points[0].template_index = -1;
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.0, 0.0})), -1);
}

}  // namespace
}  // namespace boresight::ui
