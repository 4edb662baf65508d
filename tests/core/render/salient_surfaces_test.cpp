// SPDX-License-Identifier: Apache-2.0
// What is an edge and what is not: thresholds, curved and grazing surfaces, parts, borders.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// Two plates that meet along the y axis at a ridge, bent by an angle.
SceneMesh ridge(double angle_deg) {
  SceneMesh mesh;
  const double half = 0.5 * angle_deg * M_PI / 180.0;
  const Eigen::Vector3d left(-2.0 * std::cos(half), 0, 2.0 * std::sin(half));
  const Eigen::Vector3d right(2.0 * std::cos(half), 0, 2.0 * std::sin(half));
  const Eigen::Vector3d top(0.011, -2, 0.6);
  const Eigen::Vector3d bottom(0.011, 2, 0.6);
  const std::int32_t a = mesh.addVertex(top);
  const std::int32_t b = mesh.addVertex(bottom);
  const std::int32_t c = mesh.addVertex(bottom + left);
  const std::int32_t d = mesh.addVertex(top + left);
  const std::int32_t e = mesh.addVertex(bottom + right);
  const std::int32_t f = mesh.addVertex(top + right);
  mesh.addFace(a, b, c, 0);
  mesh.addFace(a, c, d, 0);
  mesh.addFace(a, e, b, 0);
  mesh.addFace(a, f, e, 0);
  return mesh;
}

/// A plate that hides the right part of a parallel one, `step_m` nearer along z.
SceneMesh stepOf(double step_m, double slope = 0.0) {
  SceneMesh mesh;
  const auto at = [slope](double x, double y, double z) {
    return Eigen::Vector3d(x, y, z + slope * y);
  };
  mesh.addQuad(at(0.0071, -1, 0.5), at(1, -1, 0.5), at(1, 1, 0.5), at(0.0071, 1, 0.5), 0);
  mesh.addQuad(at(-1, -1, 0.5 + step_m), at(1, -1, 0.5 + step_m), at(1, 1, 0.5 + step_m),
               at(-1, 1, 0.5 + step_m), 1);
  mesh.parts.resize(2);
  return mesh;
}

int countEdges(const SceneMesh& mesh, const Camera& camera, const Pose& pose = Pose()) {
  return render(mesh, camera, pose).edges.pixel_count;
}

TEST(SalientEdges, NormalThreshold) {
  for (const Camera& camera :
       {pinholeCamera(120, 100, 150.0), brownCamera(120, 100, 150.0, -0.2)}) {
    for (const double roll : {0.0, 0.4, 1.1}) {
      const Pose pose = poseOf(Eigen::Vector3d(0, 0, roll), Eigen::Vector3d::Zero());
      EXPECT_EQ(countEdges(ridge(25.0), camera, pose), 0);
      EXPECT_EQ(countEdges(ridge(29.0), camera, pose), 0);
      EXPECT_GE(countEdges(ridge(31.0), camera, pose), 100);
      EXPECT_GE(countEdges(ridge(35.0), camera, pose), 100);
      SceneMesh valley = ridge(-35.0);
      EXPECT_GE(countEdges(valley, camera, pose), 100);
      valley.parts[0].normal_threshold_rad = 40.0 * M_PI / 180.0;
      EXPECT_EQ(countEdges(valley, camera, pose), 0);
    }
  }
}

/// Depths differ along z: on a sloping plate a step of s in the plates' own z is s / (1 - slope
/// y/z).
TEST(SalientEdges, DepthThreshold) {
  for (const Camera& camera :
       {pinholeCamera(120, 100, 150.0), brownCamera(120, 100, 150.0, -0.2)}) {
    EXPECT_EQ(countEdges(stepOf(0.004), camera), 0);
    EXPECT_EQ(countEdges(stepOf(0.0049), camera), 0);
    EXPECT_EQ(countEdges(stepOf(0.0051), camera), camera.height);
    EXPECT_EQ(countEdges(stepOf(0.006), camera), camera.height);
    for (const double slope : {0.8, 2.0}) {
      const Rendered rendered = render(stepOf(0.004, slope), camera, Pose());
      for (int y = 0; y < camera.height; ++y) {
        Eigen::Vector3d ray;
        ASSERT_TRUE(unproject(camera, Eigen::Vector2d(60, y), ray));
        const double step_m = 0.004 / (1.0 - slope * ray.y());
        if (std::abs(step_m - 0.005) < 2e-4) continue;
        EXPECT_EQ(rendered.edges.row_begin[static_cast<std::size_t>(y) + 1] -
                      rendered.edges.row_begin[static_cast<std::size_t>(y)],
                  step_m > 0.005 ? 1 : 0);
      }
    }
  }
}

TEST(SalientEdges, ThresholdsOfTheNearerPart) {
  const Camera camera = pinholeCamera(120, 100, 150.0);
  SceneMesh mesh = stepOf(0.006);
  mesh.parts[0].depth_threshold_m = 0.007;
  EXPECT_EQ(countEdges(mesh, camera), 0);
  mesh.parts[0].depth_threshold_m = 0.005;
  mesh.parts[1].depth_threshold_m = 0.007;
  EXPECT_EQ(countEdges(mesh, camera), camera.height);
}

TEST(SalientEdges, PartsThatAreNotMatchedOccludeAndYieldNothing) {
  const Camera camera = pinholeCamera(120, 100, 150.0);
  SceneMesh mesh = stepOf(0.1);
  const int boundary = countEdges(mesh, camera);
  EXPECT_EQ(boundary, camera.height);
  mesh.parts[0].match = false;
  Rendered rendered = render(mesh, camera, Pose());
  EXPECT_EQ(rendered.edges.pixel_count, 0);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      EXPECT_EQ(rendered.edges.mask.get(x, y), rendered.faceAt(x, y) >= 2);
  // The nearer part's edge counts although what it hides is not matched.
  mesh.parts[0].match = true;
  mesh.parts[1].match = false;
  rendered = render(mesh, camera, Pose());
  EXPECT_EQ(rendered.edges.pixel_count, boundary);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      EXPECT_EQ(rendered.edges.mask.get(x, y),
                rendered.faceAt(x, y) < 2 || rendered.edges.edges.get(x, y));
}

TEST(SalientEdges, OccludingEdgeAppearsOnceWithTheNearerDepth) {
  const Camera camera = brownCamera(160, 120, 170.0, -0.2);
  const Rendered rendered = render(stepOf(0.3), camera, Pose());
  EXPECT_EQ(rendered.edges.pixel_count, camera.height);
  for (int y = 0; y < camera.height; ++y)
    EXPECT_EQ(rendered.edges.row_begin[static_cast<std::size_t>(y) + 1] -
                  rendered.edges.row_begin[static_cast<std::size_t>(y)],
              1);
  for (std::int32_t i = 0; i < rendered.edges.pixel_count; ++i) {
    const EdgePixel& pixel = rendered.edges.pixels[static_cast<std::size_t>(i)];
    EXPECT_FLOAT_EQ(pixel.depth_m, 0.5F);
    EXPECT_EQ(pixel.kind, kEdgeOccluding);
    EXPECT_LT(pixel.normal_x, -100);
  }
}

/// Convex hull (Andrew's monotone chain), counter-clockwise in a frame with y up.
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), less);
  const auto cross = [](const Eigen::Vector2d& o, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
    return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
  };
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Positive outside.
double distanceToHull(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& p) {
  double outside = -1e300;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d along = hull[(i + 1) % hull.size()] - hull[i];
    outside =
        std::max(outside, Eigen::Vector2d(along.y(), -along.x()).dot(p - hull[i]) / along.norm());
  }
  return outside;
}

/// A convex tessellated surface: the only edges are its mesh's true silhouette, unbiased. At its
/// corners a pixel holds two lines.
void expectOnlySilhouette(const SceneMesh& mesh, const Camera& camera, const Pose& pose,
                          int corners) {
  std::vector<Eigen::Vector2d> projected;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, pose * Eigen::Vector3d(vertex.cast<double>()), pixel));
    projected.push_back(pixel);
  }
  const std::vector<Eigen::Vector2d> hull = convexHull(projected);
  const Rendered rendered = render(mesh, camera, pose);
  ASSERT_GT(rendered.edges.pixel_count, 80);
  double mean = 0.0;
  double mean_offset = 0.0;
  int inside = 0;
  int far_off = 0;
  for (std::int32_t i = 0; i < rendered.edges.pixel_count; ++i) {
    const EdgePixel& pixel = rendered.edges.pixels[static_cast<std::size_t>(i)];
    const double distance = distanceToHull(hull, Eigen::Vector2d(pixel.x, pixel.y));
    if (distance < -0.75) ++inside;
    EXPECT_LT(distance, 0.75);
    mean += distance / rendered.edges.pixel_count;
    const double error = pixel.offset / 100.0 + distance;
    mean_offset += error / rendered.edges.pixel_count;
    far_off += std::abs(error) > 0.03 ? 1 : 0;
  }
  EXPECT_EQ(inside, 0);
  EXPECT_LT(std::abs(mean), 0.05);
  EXPECT_LT(std::abs(mean_offset), 0.01);
  EXPECT_LE(far_off, corners);
}

TEST(SalientEdges, TessellatedCylinderShowsItsSilhouetteOnly) {
  for (const int facets : {48, 96, 400}) {
    for (const double focal_px : {120.0, 400.0, 1500.0}) {
      SceneMesh mesh;
      mesh.addCylinder(Eigen::Vector3d(0, 0, 0), 0.05, 0.07, facets, false);
      mesh.addCylinder(Eigen::Vector3d(0, 0, 0), 0.05, 0.07, facets, true);
      mesh.faces.erase(mesh.faces.begin(), mesh.faces.begin() + 2 * facets);
      mesh.part_of_face.resize(mesh.faces.size());
      // Seen from the side, so that the caps are hidden; rolled by some angle.
      for (const double roll : {0.1, 0.3, 1.2}) {
        const Pose pose = poseOf(Eigen::Vector3d(0, 0, roll), Eigen::Vector3d(0.003, 0.002, 0.6));
        expectOnlySilhouette(mesh, pinholeCamera(440, 440, focal_px), pose, 5);
      }
    }
  }
}

SceneMesh sphereOf(double radius, int rings) {
  SceneMesh mesh;
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < around; ++i) {
      const double theta = M_PI * j / rings;
      const double phi = 2.0 * M_PI * i / around;
      if ((j == 0 || j == rings) && i > 0) continue;
      mesh.addVertex(radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                              std::sin(theta) * std::sin(phi)));
    }
  const auto at = [rings, around](int j, int i) {
    if (j == 0) return 0;
    if (j == rings) return 1 + (rings - 1) * around;
    return 1 + (j - 1) * around + i % around;
  };
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) {
      if (j > 0) mesh.addFace(at(j, i), at(j + 1, i), at(j, i + 1));
      if (j < rings - 1) mesh.addFace(at(j, i + 1), at(j + 1, i), at(j + 1, i + 1));
    }
  return mesh;
}

TEST(SalientEdges, TessellatedSphereShowsItsSilhouetteOnly) {
  for (const int rings : {24, 60}) {
    expectOnlySilhouette(sphereOf(0.08, rings), pinholeCamera(300, 300, 600.0),
                         poseOf(Eigen::Vector3d(0.3, 0.4, 0.1), Eigen::Vector3d(0, 0, 0.6)), 25);
  }
}

/// A ground plane of many triangles seen at a degree or two.
TEST(SalientEdges, GrazingPlanesHaveNoEdgesInside) {
  Random random(9);
  for (const double slope : {0.02, 0.05, 0.3}) {
    SceneMesh mesh;
    constexpr int kCells = 30;
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        const double x = -3.0 + 6.0 * (i + 0.3 * random.uniform()) / kCells;
        const double z = 0.3 + 3.0 * (j + 0.3 * random.uniform()) / kCells;
        mesh.addVertex(Eigen::Vector3d(x, 0.02 + slope * 0.3 - slope * 0.02 * z, z));
      }
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const int a = j * (kCells + 1) + i;
        mesh.addFace(a, a + 1, a + kCells + 2);
        mesh.addFace(a, a + kCells + 2, a + kCells + 1);
      }
    const Rendered rendered = render(mesh, brownCamera(200, 160, 220.0, -0.1), Pose());
    for (std::int32_t i = 0; i < rendered.edges.pixel_count; ++i)
      EXPECT_NE(rendered.edges.pixels[static_cast<std::size_t>(i)].kind & kEdgeBorder, 0);
  }
}

TEST(SalientEdges, InterpenetratingBoxesMeetInALine) {
  SceneMesh mesh;
  mesh.addBox({0, 0, 0}, {0.1, 0.1, 0.05}, Pose(), 0);
  mesh.addBox({0, 0, 0}, {0.05, 0.05, 0.05},
              poseOf(Eigen::Vector3d(0.5, 0.6, 0.2), Eigen::Vector3d(0, 0, -0.05)), 1);
  mesh.parts.resize(2);
  const Camera camera = pinholeCamera(240, 200, 500.0);
  const Rendered rendered =
      render(mesh, camera, poseOf(Eigen::Vector3d(0.2, 0.1, 0.0), Eigen::Vector3d(0, 0, 0.6)));
  // Wherever the visible part changes there is an edge pixel on one of the two pixels.
  int changes = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x + 1 < camera.width; ++x) {
      const std::int32_t a = rendered.faceAt(x, y);
      const std::int32_t b = rendered.faceAt(x + 1, y);
      if (a < 0 || b < 0 || (a < 12) == (b < 12)) continue;
      ++changes;
      EXPECT_TRUE(rendered.edges.edges.get(x, y) || rendered.edges.edges.get(x + 1, y));
    }
  EXPECT_GT(changes, 50);
}

TEST(SalientEdges, NoEdgesAtTheImageBorderTheNearPlaneOrTheEndOfTheValidField) {
  SceneMesh mesh;
  mesh.addQuad({-5, 0.05, -1}, {5, 0.05, -1}, {5, 0.05, 400}, {-5, 0.05, 400});
  RenderOptions options;
  options.near_plane_m = 0.08;
  const Camera camera = pinholeCamera(100, 100, 60.0);
  const Rendered rendered = render(mesh, camera, Pose(), options);
  int rows_with_edges = 0;
  for (int y = 0; y < camera.height; ++y)
    if (rendered.edges.row_begin[static_cast<std::size_t>(y) + 1] >
        rendered.edges.row_begin[static_cast<std::size_t>(y)])
      ++rows_with_edges;
  EXPECT_EQ(rendered.faceAt(50, 99), -1);
  EXPECT_GE(rendered.faceAt(50, 80), 0);
  // The sides and the horizon of the ground are there; where the near plane cuts it is not.
  for (std::int32_t i = 0; i < rendered.edges.pixel_count; ++i) {
    const EdgePixel& pixel = rendered.edges.pixels[static_cast<std::size_t>(i)];
    EXPECT_GT(pixel.depth_m, 0.2F);
  }
  EXPECT_GT(rows_with_edges, 0);

  SceneMesh wall;
  wall.addQuad({-50, -50, 1}, {50, -50, 1}, {50, 50, 1}, {-50, 50, 1});
  EXPECT_EQ(countEdges(wall, brownCamera(200, 150, 90.0, -0.35)), 0);
}

}  // namespace
}  // namespace boresight::testing
