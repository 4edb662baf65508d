// SPDX-License-Identifier: Apache-2.0
#include "tests/core/render/scenes.h"

#include <algorithm>
#include <cmath>
#include <span>

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

void SceneMesh::addBall(const Eigen::Vector3d& centre, double radius, int rings, int around,
                        double bumps, std::uint64_t seed, int part) {
  Random random(seed);
  const auto first = static_cast<std::int32_t>(vertices.size());
  const auto at = [&](int ring, int i) {
    if (ring == 0) return first;
    return first + 1 + (ring == rings ? (rings - 1) * around : (ring - 1) * around + i % around);
  };
  for (int ring = 0; ring <= rings; ++ring) {
    const int count = ring == 0 || ring == rings ? 1 : around;
    for (int i = 0; i < count; ++i) {
      const double polar = M_PI * ring / rings;
      const double azimuth = 2.0 * M_PI * i / around;
      const Eigen::Vector3d outwards(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                     std::sin(polar) * std::sin(azimuth));
      addVertex(centre + radius * (1.0 + bumps * random.normal()) * outwards);
    }
  }
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      if (ring > 0) addFace(at(ring, i), at(ring, i + 1), at(ring + 1, i), part);
      if (ring < rings - 1) addFace(at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i), part);
    }
}

void SceneMesh::addGridFaces(int first, int columns, int rows) {
  const int stride = columns + 1;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = first + j * stride + i;
      const bool falling = (i + j) % 2 == 0;
      addFace(a, a + 1, falling ? a + stride + 1 : a + stride);
      addFace(falling ? a : a + 1, a + stride + 1, a + stride);
    }
}

Corners SceneMesh::corners(const Face& face) const {
  Corners found;
  for (std::size_t i = 0; i < 3; ++i)
    found[i] = vertices[static_cast<std::size_t>(face.vertex[i])].cast<double>();
  return found;
}

SceneMesh SceneMesh::loose() const {
  SceneMesh mesh;
  for (const Face& face : faces) {
    const auto [a, b, c] = corners(face);
    mesh.addFace(mesh.addVertex(a), mesh.addVertex(b), mesh.addVertex(c));
  }
  return mesh;
}

SceneMesh scattered(std::uint64_t seed, int facets) {
  Random random(seed);
  SceneMesh mesh;
  for (int i = 0; i < 9; ++i)
    mesh.addBox({0, 0, 0}, {random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), 0.05},
                poseOf(Eigen::Vector3d(random.normal(), random.normal(), random.normal()),
                       Eigen::Vector3d(random.uniform(-0.25, 0.25), random.uniform(-0.2, 0.2),
                                       random.uniform(0.0, 0.4))),
                i % 3);
  mesh.addCylinder({0.05, 0, 0}, 0.06, 0.1, facets, true, 1);
  mesh.parts.resize(3);
  mesh.parts[2].match = false;
  return mesh;
}

namespace {

Camera prepared(Camera camera) {
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

}  // namespace

Camera pinholeCamera(int width, int height, double focal_px) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal_px;
  camera.fy = focal_px * 1.01;
  camera.cx = 0.5 * width - 3.25;
  camera.cy = 0.5 * height + 2.5;
  return prepared(camera);
}

Camera brownCamera(int width, int height, double focal_px, double k1) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kBrownConrady;
  camera.distortion = {k1, -0.3 * k1, 0.0006, -0.0004, 0.02, 0.0, 0.0, 0.0};
  return prepared(camera);
}

Camera fisheyeCamera(int width, int height, double focal_px,
                     const std::array<double, 8>& distortion) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kKannalaBrandt;
  camera.distortion = distortion;
  return prepared(camera);
}

Camera skewMirroredCamera(int width, int height, double focal_px) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kCahvor;
  camera.fy = -1.02 * focal_px;
  camera.cahv.skew_px = 0.15 * focal_px;
  camera.cahv.optical_axis = Eigen::Vector3d(0.02, 0.015, 1.0).normalized();
  camera.cahv.radial = {0.002, -0.2, 0.04};
  return prepared(camera);
}

Camera pupilCamera(int width, int height, double focal_px, double entrance_m) {
  Camera camera = pinholeCamera(width, height, focal_px);
  camera.model = CameraModel::kCahvore;
  camera.cahv.optical_axis = Eigen::Vector3d(0.003, -0.002, 1.0).normalized();
  camera.cahv.radial = {0.000002, 0.0075, -0.0056};
  camera.cahv.entrance_m = {entrance_m, 0.0, 0.0};
  camera.cahv.linearity = 0.37;
  return prepared(camera);
}

Pose poseOf(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  return {rotationExp(rotation_rad), translation_m};
}

Rendered::Rendered(const SceneMesh& mesh, const Camera& camera, const RenderOptions& options,
                   int band_rows, int workers) {
  EXPECT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
  EXPECT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
  edges = createEdgeRender(camera.width, camera.height, options, arena);
  EXPECT_EQ(renderer.create(mesh.view(), adjacency, camera.width, camera.height, options, arena,
                            band_rows, workers),
            Status::kOk);
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  depth_m.assign(pixels, -1.0F);
  face.assign(pixels, -7);
  intensity.assign(pixels, 7);
  normal.assign(pixels, Eigen::Vector3f::Constant(7.0F));
}

Status Rendered::finish() {
  Status status = Status::kOk;
  bool done = false;
  for (steps = 0; !done && status == Status::kOk; ++steps) status = renderer.step(done);
  EXPECT_TRUE(done);
  return status;
}

Rendered render(const SceneMesh& mesh, const Camera& camera, const Pose& camera_from_station,
                const RenderOptions& options, int band_rows, bool plainly) {
  Rendered out(mesh, camera, options, band_rows);
  out.renderer.drawPlainly(plainly);
  EXPECT_EQ(out.begin(camera_from_station), Status::kOk);
  EXPECT_EQ(out.finish(), Status::kOk);
  return out;
}

void expectEqual(const EdgeRender& a, const EdgeRender& b, bool complete) {
  const auto bytes = [](const EdgeRender& edges) {
    return std::as_bytes(edges.pixels.first(static_cast<std::size_t>(edges.pixel_count)));
  };
  const auto rows = static_cast<std::size_t>(a.camera.height) + 1;
  EXPECT_EQ(a.pixel_count, b.pixel_count);
  EXPECT_TRUE(std::ranges::equal(bytes(a), bytes(b)));
  EXPECT_TRUE(!complete || std::ranges::equal(a.row_begin.first(rows), b.row_begin.first(rows)));
  EXPECT_TRUE(std::ranges::equal(a.edges.words, b.edges.words));
  EXPECT_TRUE(std::ranges::equal(a.mask.words, b.mask.words));
}

}  // namespace boresight::testing
