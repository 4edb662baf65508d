// SPDX-License-Identifier: Apache-2.0
// Parts that are fixed to the camera: against scenes whose parts were moved by hand, by poses that
// change no bit of a coordinate.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// Half a turn about x: its matrix has the elements 0, 1 and -1 only.
Pose facing(double x_m, double z_m) {
  return {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {x_m, 0.0, z_m}};
}

/// Half a turn about z, as exact.
Pose upsideDown() { return {Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), Eigen::Vector3d::Zero()}; }

/// A bar at z = 0.25 m: x from -1/64 to 1/64 m, y from -1/16 to 1/32 m.
void addBar(const Pose& frame_from_camera, SceneMesh& mesh) {
  mesh.parts.push_back(ScenePart());
  mesh.parts.back().match = false;
  const auto at = [&](double x_m, double y_m) {
    return Eigen::Vector3d(frame_from_camera * Eigen::Vector3d(x_m, y_m, 0.25));
  };
  mesh.addQuad(at(-0x1p-6, -0x1p-4), at(0x1p-6, -0x1p-4), at(0x1p-6, 0x1p-5), at(-0x1p-6, 0x1p-5),
               1);
}

SceneMesh station() {
  SceneMesh mesh;
  mesh.addBox({0.0, 0.0, 0.0}, {0.0625, 0.05, 0.03}, Pose());
  return mesh;
}

SceneMesh withCameraBar() {
  SceneMesh mesh = station();
  addBar(Pose(), mesh);
  mesh.parts[1].fixed_to_camera = true;
  return mesh;
}

std::vector<bool> barPixels(const SceneMesh& mesh, const Rendered& rendered) {
  std::vector<bool> covered;
  for (const std::int32_t face : rendered.face)
    covered.push_back(face >= 0 && mesh.part_of_face[static_cast<std::size_t>(face)] == 1);
  return covered;
}

TEST(CameraParts, StationPoses_DoNotMoveThem) {
  const SceneMesh mesh = withCameraBar();
  const Camera camera = pinholeCamera(200, 160, 320.0);
  const Rendered first = render(mesh, camera, facing(0.0, 0.5));
  const Rendered second = render(mesh, camera, poseOf({2.8, 0.3, -0.4}, {0.02, -0.01, 0.6}));
  EXPECT_EQ(barPixels(mesh, first), barPixels(mesh, second));
  EXPECT_NE(first.edges.pixel_count, second.edges.pixel_count);
  // Where the bar's corners project.
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const double x_m = (x - camera.cx) / camera.fx * 0.25;
      const double y_m = (y - camera.cy) / camera.fy * 0.25;
      const double margin_m = 1e-4;
      const double outside = std::max({std::abs(x_m) - 0x1p-6, -0x1p-4 - y_m, y_m - 0x1p-5});
      if (std::abs(outside) < margin_m) continue;
      EXPECT_EQ(barPixels(mesh, first)[first.at(x, y)], outside < 0.0) << x << " " << y;
    }
}

TEST(CameraParts, Render_EqualsThatOfAPartMovedByHand) {
  const SceneMesh mesh = withCameraBar();
  for (const Camera& camera : {pinholeCamera(200, 160, 320.0), brownCamera(200, 160, 320.0, -0.28),
                               fisheyeCamera(200, 160, 320.0), pupilCamera(200, 160, 320.0, 0.004)})
    for (const double x_m : {0.0, 0.03125, -0.046875}) {
      const Pose pose = facing(x_m, 0.5);
      SceneMesh by_hand = station();
      addBar(pose.inverse(), by_hand);
      const Rendered expected = render(by_hand, camera, pose);
      const Rendered rendered = render(mesh, camera, pose);
      expectEqual(rendered.edges, expected.edges);
      EXPECT_EQ(rendered.depth_m, expected.depth_m);
      EXPECT_EQ(rendered.face, expected.face);
      EXPECT_GT(rendered.edges.pixel_count, 100);
    }
}

TEST(CameraParts, TurnedView_TurnsThem) {
  const Camera camera = pinholeCamera(200, 160, 320.0);
  const Pose pose = facing(0.03125, 0.5);
  const Pose seen = upsideDown() * pose;
  SceneMesh by_hand = station();
  addBar(pose.inverse(), by_hand);
  const Rendered expected = render(by_hand, camera, seen);

  const SceneMesh mesh = withCameraBar();
  Rendered turned(mesh, camera);
  ASSERT_EQ(turned.renderer.begin(turned.rays, seen, turned.edges, {}, upsideDown()), Status::kOk);
  ASSERT_EQ(turned.finish(), Status::kOk);
  expectEqual(turned.edges, expected.edges);
  EXPECT_GT(turned.edges.pixel_count, 100);
}

}  // namespace
}  // namespace boresight::testing
