// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// First hit of a ray from the camera centre (Moller-Trumbore; independent of the rasterizer).
struct RayHit {
  int face = -1;
  double depth_m = 0.0;
};

class RayCaster {
 public:
  RayCaster(const SceneMesh& mesh, const Pose& camera_from_station, double near_plane_m);
  RayHit cast(const Eigen::Vector3d& ray) const;
  /// Distance in px from a pixel to the nearest projected edge of any triangle, or to where the
  /// nearest surface changes in another way (near plane, intersection), found by probing: true when
  /// the hit is the same face all over a disc of this radius.
  bool sameFaceAround(const Camera& camera, const Eigen::Vector2d& pixel, double radius_px,
                      int face) const;
  /// z of the face's plane along a ray.
  double planeDepth(int face, const Eigen::Vector3d& ray) const;

 private:
  struct Triangle {
    Eigen::Vector3d corner, edge1, edge2;
  };
  std::vector<Triangle> triangles_;
  double near_plane_m_;
};

RayCaster::RayCaster(const SceneMesh& mesh, const Pose& camera_from_station, double near_plane_m)
    : near_plane_m_(near_plane_m) {
  for (const Face& face : mesh.faces) {
    Eigen::Vector3d v[3];
    for (std::size_t i = 0; i < 3; ++i)
      v[i] =
          camera_from_station *
          Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(face.vertex[i])].cast<double>());
    triangles_.push_back({v[0], v[1] - v[0], v[2] - v[0]});
  }
}

RayHit RayCaster::cast(const Eigen::Vector3d& ray) const {
  RayHit hit;
  hit.depth_m = 1e300;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const Eigen::Vector3d p = ray.cross(t.edge2);
    const double determinant = t.edge1.dot(p);
    if (determinant == 0.0) continue;
    const Eigen::Vector3d s = -t.corner;
    const double u = s.dot(p) / determinant;
    if (u < 0.0 || u > 1.0) continue;
    const Eigen::Vector3d q = s.cross(t.edge1);
    const double v = ray.dot(q) / determinant;
    if (v < 0.0 || u + v > 1.0) continue;
    const double depth = t.edge2.dot(q) / determinant;
    if (depth < near_plane_m_ || depth >= hit.depth_m) continue;
    hit.depth_m = depth;
    hit.face = static_cast<int>(i);
  }
  return hit;
}

bool RayCaster::sameFaceAround(const Camera& camera, const Eigen::Vector2d& pixel, double radius_px,
                               int face) const {
  for (int i = 0; i < 8; ++i) {
    const double angle = M_PI * i / 4.0;
    Eigen::Vector3d ray;
    if (!unproject(camera, pixel + radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                   ray))
      return false;
    if (cast(ray).face != face) return false;
  }
  return true;
}

double RayCaster::planeDepth(int face, const Eigen::Vector3d& ray) const {
  const Triangle& t = triangles_[static_cast<std::size_t>(face)];
  const Eigen::Vector3d normal = t.edge1.cross(t.edge2);
  return normal.dot(t.corner) / normal.dot(ray);
}

/// Triangles of all sizes and attitudes, some behind the camera, some across the near plane.
SceneMesh triangleSoup(Random& random, int count) {
  SceneMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double size = std::exp(random.uniform(-4.5, 0.7));
    const Eigen::Vector3d centre(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7),
                                 random.uniform(-0.2, 1.5));
    Eigen::Vector3d corner[3];
    for (auto& c : corner)
      c = centre + size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    if (i % 7 == 0) corner[2] = corner[1] + 1e-3 * (corner[2] - corner[1]);  // a sliver
    mesh.addFace(mesh.addVertex(corner[0]), mesh.addVertex(corner[1]), mesh.addVertex(corner[2]));
  }
  return mesh;
}

/// Compares a render with ray casting at every pixel whose surroundings show one face.
void expectLikeRayCasting(const SceneMesh& mesh, const Camera& camera, const Pose& pose) {
  RenderOptions options;
  options.max_edge_pixels = 400000;
  const Rendered rendered = render(mesh, camera, pose, options);
  const RayCaster caster(mesh, pose, CameraScene::kNearPlane_m);
  int compared = 0;
  int wrong_face = 0;
  double worst_depth = 0.0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      if (!unproject(camera, Eigen::Vector2d(x, y), ray)) {
        EXPECT_EQ(rendered.faceAt(x, y), -1);
        continue;
      }
      const RayHit hit = caster.cast(ray);
      if (hit.face == rendered.faceAt(x, y)) {
        ++compared;
        if (hit.face < 0) continue;
        const double plane = caster.planeDepth(hit.face, ray);
        const double depth = static_cast<double>(rendered.depthAt(x, y));
        const double error = std::abs(depth - plane) / plane;
        if (error > 1e-6 && caster.sameFaceAround(camera, Eigen::Vector2d(x, y), 0.1, hit.face))
          worst_depth = std::max(worst_depth, error);
      } else if (caster.sameFaceAround(camera, Eigen::Vector2d(x, y), 0.1, hit.face)) {
        ++wrong_face;
      }
    }
  }
  EXPECT_EQ(wrong_face, 0);
  EXPECT_LE(worst_depth, 1e-6);
  EXPECT_GT(compared, camera.width * camera.height * 9 / 10);
}

TEST(Rasterizer, SoupInPinholeCameraLikeRayCasting) {
  Random random(1);
  for (int i = 0; i < 4; ++i)
    expectLikeRayCasting(triangleSoup(random, 60), pinholeCamera(150, 117, 160.0), Pose());
}

TEST(Rasterizer, SoupInBrownConradyCameraLikeRayCasting) {
  Random random(2);
  for (int i = 0; i < 4; ++i)
    expectLikeRayCasting(triangleSoup(random, 60), brownCamera(150, 117, 160.0, -0.28), Pose());
}

TEST(Rasterizer, SoupInKannalaBrandtCameraLikeRayCasting) {
  Random random(3);
  for (int i = 0; i < 4; ++i)
    expectLikeRayCasting(triangleSoup(random, 60), fisheyeCamera(150, 117, 80.0), Pose());
}

/// Corners short of 90 deg off the axis, at it and beyond.
TEST(Rasterizer, SoupInVeryWideFieldsLikeRayCasting) {
  Random random(5);
  for (const double focal_px : {54.0, 60.0, 62.0, 66.0, 72.0}) {
    Camera camera = fisheyeCamera(150, 117, focal_px);
    camera.distortion = {};
    ASSERT_EQ(prepareCamera(camera), Status::kOk);
    expectLikeRayCasting(triangleSoup(random, 60), camera, Pose());
  }
}

/// So short a focal length leaves few nodes of rays, and the field ends between them.
TEST(Rasterizer, SoupInAWideFieldOfFewNodesLikeRayCasting) {
  Random random(6);
  Camera camera = fisheyeCamera(45, 47, 19.0);
  camera.distortion = {-0.02, -0.01, 0.002, 0.0};
  for (const double focal_px : {19.0, 20.2, 21.4}) {
    camera.fx = camera.fy = focal_px;
    ASSERT_EQ(prepareCamera(camera), Status::kOk);
    for (int i = 0; i < 4; ++i) expectLikeRayCasting(triangleSoup(random, 60), camera, Pose());
  }
}

TEST(Rasterizer, WideAndTallTrianglesLikeRayCasting) {
  Random random(4);
  for (int i = 0; i < 2; ++i) {
    const SceneMesh mesh = triangleSoup(random, 25);
    expectLikeRayCasting(mesh, pinholeCamera(701, 40, 400.0), Pose());
    expectLikeRayCasting(mesh, brownCamera(701, 40, 400.0, -0.25), Pose());
    expectLikeRayCasting(mesh, brownCamera(40, 701, 400.0, 0.1), Pose());
  }
}

TEST(Rasterizer, ClosedMeshesLikeRayCasting) {
  Random random(5);
  for (int i = 0; i < 3; ++i) {
    SceneMesh mesh;
    for (int box = 0; box < 6; ++box)
      mesh.addBox(Eigen::Vector3d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0),
                  Eigen::Vector3d(random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), 0.05),
                  poseOf(Eigen::Vector3d(random.normal(), random.normal(), random.normal()),
                         Eigen::Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2),
                                         random.uniform(0.4, 0.9))));
    mesh.addCylinder(Eigen::Vector3d(0.02, 0.0, 0.6), 0.05, 0.1, 48, true);
    expectLikeRayCasting(mesh, brownCamera(160, 120, 150.0, -0.2),
                         poseOf(Eigen::Vector3d(0.3, 0.2, 0.1), Eigen::Vector3d(0, -0.1, 0.1)));
  }
}

/// A plane cut into triangles whose vertices fall on pixel centres in many places: every pixel is
/// covered, and the one plane is seen everywhere.
TEST(Rasterizer, SharedEdgesThroughPixelCentresLeaveNoCracks) {
  Camera camera = pinholeCamera(96, 80, 100.0);
  camera.fx = camera.fy = 128.0;
  camera.cx = 48.0;
  camera.cy = 40.0;
  ASSERT_EQ(prepareCamera(camera), Status::kOk);
  for (int cell = 1; cell <= 8; cell *= 2) {
    SceneMesh mesh;
    const int n = 64 / cell;
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i)
        mesh.addVertex(Eigen::Vector3d(i * cell / 128.0, j * cell / 128.0, 1.0));
    const int stride = 2 * n + 1;
    for (int j = 0; j < 2 * n; ++j)
      for (int i = 0; i < 2 * n; ++i) {
        const int a = j * stride + i;
        if ((i + j) % 2 == 0) {
          mesh.addFace(a, a + 1, a + stride + 1);
          mesh.addFace(a, a + stride + 1, a + stride);
        } else {
          mesh.addFace(a, a + 1, a + stride);
          mesh.addFace(a + 1, a + stride + 1, a + stride);
        }
      }
    const Rendered rendered = render(mesh, camera, Pose());
    int covered = 0;
    for (const std::int32_t face : rendered.face) covered += face >= 0 ? 1 : 0;
    EXPECT_EQ(covered, camera.width * camera.height) << "cell " << cell;
    EXPECT_EQ(rendered.edges.pixel_count, 0);
  }
}

/// Each face of a fan or a grid drawn alone: together they cover every pixel exactly once.
TEST(Rasterizer, AdjacentTrianglesCoverEveryPixelOnce) {
  Random random(6);
  for (const Camera& camera : {pinholeCamera(64, 48, 64.0), brownCamera(64, 48, 64.0, -0.2)}) {
    SceneMesh fan;
    const std::int32_t hub = fan.addVertex(Eigen::Vector3d(0.013, 0.02, 0.7));
    constexpr int kBlades = 23;
    for (int i = 0; i < kBlades; ++i) {
      const double angle = 2.0 * M_PI * i / kBlades;
      fan.addVertex(Eigen::Vector3d(3.0 * std::cos(angle), 3.0 * std::sin(angle),
                                    0.7 + 0.2 * random.uniform()));
    }
    for (int i = 0; i < kBlades; ++i) fan.addFace(hub, 1 + i, 1 + (i + 1) % kBlades);
    std::vector<int> times(static_cast<std::size_t>(camera.width * camera.height), 0);
    for (int i = 0; i < kBlades; ++i) {
      SceneMesh blade = fan;
      blade.faces = {fan.faces[static_cast<std::size_t>(i)]};
      blade.part_of_face = {0};
      // Whichever way a blade is oriented.
      if (i % 2 == 0) std::swap(blade.faces[0].vertex[0], blade.faces[0].vertex[2]);
      const Rendered rendered = render(blade, camera, Pose());
      for (std::size_t k = 0; k < times.size(); ++k) times[k] += rendered.face[k] >= 0 ? 1 : 0;
    }
    EXPECT_EQ(std::set<int>(times.begin(), times.end()), std::set<int>{1});
  }
}

/// The same with spokes that run exactly through pixel centres.
TEST(Rasterizer, SpokesThroughPixelCentresAreDrawnOnce) {
  Camera camera = pinholeCamera(64, 64, 64.0);
  camera.fx = camera.fy = 64.0;
  camera.cx = camera.cy = 32.0;
  const Eigen::Vector2d spokes[] = {{1, 0},  {2, 1},  {1, 1},  {1, 2},   {0, 1},   {-1, 2},
                                    {-1, 1}, {-2, 1}, {-1, 0}, {-2, -1}, {-1, -1}, {-1, -2},
                                    {0, -1}, {1, -2}, {1, -1}, {2, -1}};
  SceneMesh fan;
  const std::int32_t hub = fan.addVertex({0, 0, 1});
  for (const Eigen::Vector2d& spoke : spokes) fan.addVertex({spoke.x(), spoke.y(), 1.0});
  std::vector<int> times(64 * 64, 0);
  for (int i = 0; i < 16; ++i) {
    SceneMesh blade = fan;
    blade.addFace(hub, 1 + i, 1 + (i + 1) % 16);
    const Rendered rendered = render(blade, camera, Pose());
    for (std::size_t k = 0; k < times.size(); ++k) times[k] += rendered.face[k] >= 0 ? 1 : 0;
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), 64 * 64);  // the hub's pixel too
}

TEST(Rasterizer, NearestWinsThenLowerIndex) {
  SceneMesh mesh;
  const auto square = [&mesh](double z) {
    mesh.addQuad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
  };
  square(1.0);
  square(0.5);
  square(0.5);
  const Rendered rendered = render(mesh, pinholeCamera(40, 30, 50.0), Pose());
  for (const std::int32_t face : rendered.face) EXPECT_TRUE(face == 2 || face == 3);
  for (const float depth : rendered.depth_m) EXPECT_EQ(depth, 0.5F);
}

TEST(Rasterizer, DegenerateAndHiddenFacesDrawNothing) {
  SceneMesh mesh;
  const std::int32_t a = mesh.addVertex({0.0, 0.0, 1.0});
  const std::int32_t b = mesh.addVertex({0.1, 0.0, 1.0});
  const std::int32_t c = mesh.addVertex({0.2, 0.0, 1.0});
  const std::int32_t behind = mesh.addVertex({0.0, 0.1, -1.0});
  const std::int32_t behind2 = mesh.addVertex({0.1, 0.1, -1.0});
  const std::int32_t behind3 = mesh.addVertex({0.1, 0.2, -1.0});
  mesh.addFace(a, a, b);
  mesh.addFace(a, b, c);
  mesh.addFace(a, a, a);
  mesh.addFace(behind, behind2, behind3);
  const Rendered rendered = render(mesh, pinholeCamera(64, 64, 64.0), Pose());
  for (const std::int32_t face : rendered.face) EXPECT_EQ(face, -1);
  EXPECT_EQ(rendered.edges.pixel_count, 0);
}

TEST(SurfaceRender, ShadesLambertFromTheCamera) {
  SceneMesh mesh;
  mesh.addQuad({-1, -1, 1}, {1, -1, 1.3}, {1, 1, 1.3}, {-1, 1, 1});
  const Camera camera = brownCamera(80, 60, 90.0, -0.2);
  const Rendered rendered = render(mesh, camera, Pose());
  const Eigen::Vector3d normal = Eigen::Vector3d(0.15, 0, -1).normalized();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      ASSERT_TRUE(unproject(camera, Eigen::Vector2d(x, y), ray));
      const double expected = 30.0 + 225.0 * std::abs(normal.dot(ray.normalized()));
      EXPECT_NEAR(rendered.intensity[rendered.at(x, y)], expected, 0.51);
      EXPECT_LT((rendered.normal[rendered.at(x, y)].cast<double>() - normal).norm(), 1e-6);
    }
}

}  // namespace
}  // namespace boresight::testing
