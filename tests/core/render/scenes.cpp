// SPDX-License-Identifier: Apache-2.0
#include "tests/core/render/scenes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::testing {

std::int32_t SceneMesh::addVertex(const Eigen::Vector3d& p) {
  vertices.push_back(p.cast<float>());
  return static_cast<std::int32_t>(vertices.size()) - 1;
}

void SceneMesh::addFace(std::int32_t a, std::int32_t b, std::int32_t c, int part) {
  faces.push_back(Face{{a, b, c}});
  part_of_face.push_back(static_cast<std::uint16_t>(part));
}

void SceneMesh::addQuad(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, const Eigen::Vector3d& d, int part) {
  const std::int32_t ia = addVertex(a);
  const std::int32_t ib = addVertex(b);
  const std::int32_t ic = addVertex(c);
  const std::int32_t id = addVertex(d);
  addFace(ia, ib, ic, part);
  addFace(ia, ic, id, part);
}

void SceneMesh::addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                       const Pose& placed, int part) {
  std::int32_t corner[8];
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                               (i & 4) != 0 ? 1.0 : -1.0);
    corner[i] = addVertex(placed * Eigen::Vector3d(centre + half.cwiseProduct(sign)));
  }
  const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& side : sides) {
    addFace(corner[side[0]], corner[side[1]], corner[side[2]], part);
    addFace(corner[side[0]], corner[side[2]], corner[side[3]], part);
  }
}

void SceneMesh::addCylinder(const Eigen::Vector3d& centre, double radius, double half_height,
                            int facets, bool caps, int part) {
  const auto first = static_cast<std::int32_t>(vertices.size());
  for (int i = 0; i < facets; ++i) {
    const double angle = 2.0 * M_PI * i / facets;
    const Eigen::Vector3d rim(radius * std::cos(angle), 0.0, radius * std::sin(angle));
    addVertex(centre + rim - Eigen::Vector3d(0, half_height, 0));
    addVertex(centre + rim + Eigen::Vector3d(0, half_height, 0));
  }
  for (int i = 0; i < facets; ++i) {
    const std::int32_t a = first + 2 * i;
    const std::int32_t b = first + 2 * ((i + 1) % facets);
    addFace(a, a + 1, b + 1, part);
    addFace(a, b + 1, b, part);
  }
  if (!caps) return;
  const std::int32_t low = addVertex(centre - Eigen::Vector3d(0, half_height, 0));
  const std::int32_t high = addVertex(centre + Eigen::Vector3d(0, half_height, 0));
  for (int i = 0; i < facets; ++i) {
    const std::int32_t a = first + 2 * i;
    const std::int32_t b = first + 2 * ((i + 1) % facets);
    addFace(low, a, b, part);
    addFace(high, b + 1, a + 1, part);
  }
}

Camera pinholeCamera(int width, int height, double focal_px) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal_px;
  camera.fy = focal_px * 1.01;
  camera.cx = 0.5 * width - 3.25;
  camera.cy = 0.5 * height + 2.5;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera brownCamera(int width, int height, double focal_px, double k1) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kBrownConrady;
  camera.distortion = {k1, -0.3 * k1, 0.0006, -0.0004, 0.02, 0.0, 0.0, 0.0};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera fisheyeCamera(int width, int height, double focal_px) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kKannalaBrandt;
  camera.distortion = {0.02, -0.01, 0.003, -0.0005, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera skewMirroredCamera(int width, int height, double focal_px) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kCahvor;
  camera.fy = -1.02 * focal_px;
  camera.cahv.skew_px = 0.15 * focal_px;
  camera.cahv.optical_axis = Eigen::Vector3d(0.02, 0.015, 1.0).normalized();
  camera.cahv.radial = {0.002, -0.2, 0.04};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera pupilCamera(int width, int height, double focal_px, double entrance_m) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kCahvore;
  camera.cahv.optical_axis = Eigen::Vector3d(0.003, -0.002, 1.0).normalized();
  camera.cahv.radial = {0.000002, 0.0075, -0.0056};
  camera.cahv.entrance_m = {entrance_m, 0.0, 0.0};
  camera.cahv.linearity = 0.37;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Rendered render(const SceneMesh& mesh, const Camera& camera, const Pose& camera_from_station,
                const RenderOptions& options, int band_rows, bool plainly) {
  Rendered out;
  out.memory.resize(std::size_t{24} << 20);
  Arena arena(out.memory);
  EXPECT_EQ(buildAdjacency(mesh.view(), arena, out.adjacency), Status::kOk);
  RayGrid rays;
  EXPECT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
  out.edges = createEdgeRender(camera.width, camera.height, options, arena);
  EdgeRenderer renderer;
  EXPECT_EQ(renderer.create(mesh.view(), out.adjacency, camera.width, camera.height, options, arena,
                            band_rows),
            Status::kOk);
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  out.depth_m.assign(pixels, -1.0F);
  out.face.assign(pixels, -7);
  out.intensity.assign(pixels, 7);
  out.normal.assign(pixels, Eigen::Vector3f::Constant(7.0F));
  renderer.drawPlainly(plainly);
  EXPECT_EQ(renderer.begin(rays, camera_from_station, out.edges,
                           {out.depth_m, out.face, out.intensity, out.normal}),
            Status::kOk);
  bool done = false;
  while (!done && out.steps < 100000) {
    EXPECT_EQ(renderer.step(done), Status::kOk);
    ++out.steps;
  }
  return out;
}

Pose poseOf(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  Pose pose;
  pose.rotation = rotationExp(rotation_rad);
  pose.translation_m = translation_m;
  return pose;
}

void expectEqual(const EdgeRender& a, const EdgeRender& b) {
  ASSERT_EQ(a.pixel_count, b.pixel_count);
  for (std::int32_t i = 0; i < a.pixel_count; ++i) {
    const EdgePixel& p = a.pixel(i);
    const EdgePixel& q = b.pixel(i);
    EXPECT_TRUE(p.x == q.x && p.y == q.y && p.depth_m == q.depth_m && p.face == q.face &&
                p.normal_x == q.normal_x && p.normal_y == q.normal_y && p.offset == q.offset &&
                p.kind == q.kind)
        << p.x << " " << p.y;
  }
  for (int y = 0; y < a.camera.height; ++y)
    for (int word = 0; word < a.edges.words_per_row; ++word) {
      EXPECT_EQ(a.edges.row(y)[word], b.edges.row(y)[word]);
      EXPECT_EQ(a.mask.row(y)[word], b.mask.row(y)[word]);
    }
}

}  // namespace boresight::testing
