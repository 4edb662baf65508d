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

/// First hits of rays from the camera centre (Moller-Trumbore; independent of the rasterizer).
class RayCaster {
 public:
  RayCaster(const SceneMesh& mesh, const Pose& camera_from_station) {
    for (const Face& face : mesh.faces) {
      const auto [a, b, c] = mesh.corners(face);
      const Eigen::Vector3d corner = camera_from_station * a;
      triangles_.push_back(
          {corner, camera_from_station * b - corner, camera_from_station * c - corner});
    }
  }

  /// The face that is hit, or -1.
  int cast(const Eigen::Vector3d& ray) const {
    int face = -1;
    double nearest_m = 1e300;
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
      if (depth < CameraScene::kNearPlane_m || depth >= nearest_m) continue;
      face = static_cast<int>(i);
      nearest_m = depth;
    }
    return face;
  }

  /// True when the hit is the same face all over a disc of 0.1 px, found by probing: the pixel is
  /// not next to an edge of any triangle, the near plane or an intersection.
  bool sameFaceAround(const Camera& camera, const Eigen::Vector2d& pixel, int face) const {
    for (int i = 0; i < 8; ++i) {
      const double angle = M_PI * i / 4.0;
      Eigen::Vector3d ray;
      if (!unproject(camera, pixel + 0.1 * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                     ray) ||
          cast(ray) != face)
        return false;
    }
    return true;
  }

  /// z of the face's plane along a ray.
  double planeDepth(int face, const Eigen::Vector3d& ray) const {
    const Triangle& t = triangles_[static_cast<std::size_t>(face)];
    const Eigen::Vector3d normal = t.edge1.cross(t.edge2);
    return normal.dot(t.corner) / normal.dot(ray);
  }

 private:
  struct Triangle {
    Eigen::Vector3d corner, edge1, edge2;
  };
  std::vector<Triangle> triangles_;
};

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
  const RayCaster caster(mesh, pose);
  int compared = 0;
  int wrong = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      if (!unproject(camera, Eigen::Vector2d(x, y), ray)) {
        EXPECT_EQ(rendered.faceAt(x, y), -1);
        continue;
      }
      const int face = caster.cast(ray);
      if (face == rendered.faceAt(x, y)) {
        ++compared;
        if (face < 0) continue;
        const double plane = caster.planeDepth(face, ray);
        if (std::abs(static_cast<double>(rendered.depthAt(x, y)) - plane) <= 1e-6 * plane) continue;
      }
      wrong += caster.sameFaceAround(camera, Eigen::Vector2d(x, y), face) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(compared, camera.width * camera.height * 9 / 10);
}

TEST(Rasterizer, TriangleSoupsLikeRayCasting) {
  std::vector<Camera> very_wide;  // corners short of 90 deg off the axis, at it and beyond
  for (const double focal_px : {54.0, 60.0, 62.0, 66.0, 72.0})
    very_wide.push_back(fisheyeCamera(150, 117, focal_px, {}));
  // So short a focal length leaves few nodes of rays, and the field ends between them.
  std::vector<Camera> few_nodes;
  for (const double focal_px : {19.0, 20.2, 21.4}) {
    Camera& camera = few_nodes.emplace_back(fisheyeCamera(45, 47, 19.0, {-0.02, -0.01, 0.002}));
    camera.fx = camera.fy = focal_px;
    ASSERT_EQ(prepareCamera(camera), Status::kOk);
  }
  const struct {
    std::uint64_t seed;
    int soups;
    std::vector<Camera> cameras;
  } cases[] = {{1, 4, {pinholeCamera(150, 117, 160.0)}},
               {2, 4, {brownCamera(150, 117, 160.0, -0.28)}},
               {3, 4, {fisheyeCamera(150, 117, 80.0)}},
               {5, 1, very_wide},
               {6, 4, few_nodes}};
  for (const auto& [seed, soups, cameras] : cases) {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (const Camera& camera : cameras)
      for (int i = 0; i < soups; ++i)
        expectLikeRayCasting(triangleSoup(random, 60), camera, Pose());
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
    mesh.addGridFaces(0, 2 * n, 2 * n);
    const Rendered rendered = render(mesh, camera, Pose());
    EXPECT_GE(std::ranges::min(rendered.face), 0) << "cell " << cell;
    EXPECT_EQ(rendered.edges.pixel_count, 0);
  }
}

/// How often pixels are covered by the faces of a mesh, each drawn alone.
std::set<int> timesCovered(const SceneMesh& mesh, const Camera& camera) {
  std::vector<int> times(static_cast<std::size_t>(camera.width * camera.height), 0);
  for (const Face& face : mesh.faces) {
    SceneMesh alone = mesh;
    alone.faces = {face};
    alone.part_of_face = {0};
    const Rendered rendered = render(alone, camera, Pose());
    for (std::size_t k = 0; k < times.size(); ++k) times[k] += rendered.face[k] >= 0 ? 1 : 0;
  }
  return {times.begin(), times.end()};
}

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
      // Whichever way a blade is oriented.
      const std::int32_t next = 1 + (i + 1) % kBlades;
      fan.addFace(i % 2 == 0 ? next : hub, 1 + i, i % 2 == 0 ? hub : next);
    }
    EXPECT_EQ(timesCovered(fan, camera), std::set<int>{1});
  }
}

/// The same with spokes that run exactly through pixel centres, the hub's too.
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
  for (int i = 0; i < 16; ++i) fan.addFace(hub, 1 + i, 1 + (i + 1) % 16);
  EXPECT_EQ(timesCovered(fan, camera), std::set<int>{1});
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
  const Eigen::Vector3d corners[] = {{0.0, 0.0, 1.0},  {0.1, 0.0, 1.0},  {0.2, 0.0, 1.0},
                                     {0.0, 0.1, -1.0}, {0.1, 0.1, -1.0}, {0.1, 0.2, -1.0}};
  for (const Eigen::Vector3d& corner : corners) mesh.addVertex(corner);
  mesh.addFace(0, 0, 1);
  mesh.addFace(0, 1, 2);
  mesh.addFace(0, 0, 0);
  mesh.addFace(3, 4, 5);  // behind the camera
  const Rendered rendered = render(mesh, pinholeCamera(64, 64, 64.0), Pose());
  EXPECT_EQ(rendered.face, std::vector<std::int32_t>(64 * 64, -1));
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
