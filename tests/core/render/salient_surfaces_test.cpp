// SPDX-License-Identifier: Apache-2.0
// Which places are salient edges: thresholds, curved and grazing surfaces, parts, borders.
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
  const Eigen::Vector3d corners[] = {top,        bottom,         bottom + left,
                                     top + left, bottom + right, top + right};
  for (const Eigen::Vector3d& corner : corners) mesh.addVertex(corner);
  mesh.addFace(0, 1, 2);
  mesh.addFace(0, 2, 3);
  mesh.addFace(0, 4, 1);
  mesh.addFace(0, 5, 4);
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
        EXPECT_EQ(edgesInRow(rendered.edges, y), step_m > 0.005 ? 1 : 0);
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
  EXPECT_EQ(countEdges(mesh, camera), camera.height);
  mesh.parts[0].match = false;
  EXPECT_EQ(countEdges(mesh, camera), 0);
  // The nearer part's edge counts although what it hides is not matched.
  mesh.parts[0].match = true;
  mesh.parts[1].match = false;
  EXPECT_EQ(countEdges(mesh, camera), camera.height);
}

TEST(SalientEdges, OccludingEdgeAppearsOnceWithTheNearerDepth) {
  const Camera camera = brownCamera(160, 120, 170.0, -0.2);
  const Rendered rendered = render(stepOf(0.3), camera, Pose());
  for (int y = 0; y < camera.height; ++y) EXPECT_EQ(edgesInRow(rendered.edges, y), 1);
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
    EXPECT_FLOAT_EQ(pixel.depth_m, 0.5F);
    EXPECT_EQ(pixel.kind, kEdgeOccluding);
    EXPECT_LT(pixel.normal_x, -100);
  }
}

/// A floor that recedes from 1.0 to 1.3 m between two rows, and the lower end of a wall at 1.1 m
/// between them: the wall is the nearer one where it ends, although its pixel is farther.
TEST(SalientEdges, NearerIsTheOneThatEndsNotTheOneWithTheNearerPixel) {
  Camera camera = pinholeCamera(60, 60, 200.0);
  camera.fy = 200.0;
  for (const double side : {1.0, -1.0}) {  // a floor, or a ceiling
    camera.cy = 30.0 - 10.0 * side;
    for (const double below : {3.15, 3.3, 3.45, 3.6}) {
      SceneMesh mesh;
      mesh.addQuad({-9, 0.02 * side, 0.1}, {9, 0.02 * side, 0.1}, {9, 0.02 * side, 50},
                   {-9, 0.02 * side, 50});
      ASSERT_GT(0.02 / (below / 200.0), 1.1);
      const double y = 1.1 * below / 200.0 * side;
      mesh.addQuad({-1, -side, 1.1}, {1, -side, 1.1}, {1, y, 1.1}, {-1, y, 1.1});
      const Rendered rendered = render(mesh, camera, Pose());
      const double edge_row = camera.cy + below * side;
      const int row = static_cast<int>(std::floor(edge_row + 0.5));
      for (int x = 0; x < camera.width; ++x) {
        const std::int32_t found = findEdgePixel(rendered.edges, x, row);
        ASSERT_GE(found, 0) << edge_row;
        const EdgePixel& pixel = rendered.edges.pixel(found);
        EXPECT_FLOAT_EQ(pixel.depth_m, 1.1F);
        EXPECT_EQ(pixel.normal_y, 127 * side);
        EXPECT_NEAR(pixel.offset / 100.0, (edge_row - row) * side, 0.006);
      }
    }
  }
}

/// Plates that touch without sharing vertices: one of them is recorded all along, not either by
/// chance.
TEST(SalientEdges, TouchingSurfacesAreRecordedConsistently) {
  const Pose pose = poseOf(Eigen::Vector3d(0, 0.3, 0.2), Eigen::Vector3d(-0.1, 0.0, 0.05));
  const Rendered rendered = render(ridge(80.0).loose(), pinholeCamera(120, 100, 150.0), pose);
  int left = 0;
  int right = 0;
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
    if (!isBorder(pixel)) (pixel.face < 2 ? left : right) += 1;
  }
  EXPECT_GT(left + right, 80);
  EXPECT_TRUE(left == 0 || right == 0) << left << " " << right;
}

/// A rounded ridge, its rounding of many faces within a pixel: the crease is where it turns half.
TEST(SalientEdges, FilletWithinAPixelIsACreaseInItsMiddle) {
  const Camera camera = pinholeCamera(160, 120, 300.0);
  for (const int facets : {5, 8}) {
    SceneMesh mesh;
    // The outline in (x, z): a 45 deg slope, an arc, the other slope.
    constexpr double kRadius = 4e-4;  // 0.2 px
    std::vector<Eigen::Vector2d> outline{{-1.0, 0.6 + 1.0}};
    for (int i = 0; i <= facets; ++i) {
      const double angle = (-45.0 + 90.0 * i / facets) * M_PI / 180.0;
      outline.emplace_back(kRadius * std::sin(angle),
                           0.6 + kRadius * (std::sqrt(2.0) - std::cos(angle)));
    }
    outline.emplace_back(1.0, 0.6 + 1.0);
    for (const Eigen::Vector2d& point : outline) {
      mesh.addVertex({point.x(), -2.0, point.y()});
      mesh.addVertex({point.x(), 2.0, point.y()});
    }
    for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(outline.size()); ++i) {
      mesh.addFace(2 * i, 2 * i + 1, 2 * i + 2);
      mesh.addFace(2 * i + 2, 2 * i + 1, 2 * i + 3);
    }
    for (const double roll : {0.1, 0.4}) {
      const Pose pose = poseOf(Eigen::Vector3d(0, 0, roll), Eigen::Vector3d(0.0013, 0, 0));
      const Rendered rendered = render(mesh, camera, pose);
      EXPECT_GE(rendered.edges.pixel_count, 100);
      const Eigen::Vector2d across(std::cos(roll), std::sin(roll));
      double mean = 0.0;
      for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
        const Eigen::Vector2d ray((pixel.x - camera.cx) / camera.fx,
                                  (pixel.y - camera.cy) / camera.fy);
        // The ridge's plane of symmetry, seen edge-on but for 1.3 mm: x' = 0.0013 cos(roll).
        const Eigen::Vector2d at = ray * (0.6 + kRadius * (std::sqrt(2.0) - 1.0));
        const double distance_px = (at.dot(across) - 0.0013 * std::cos(roll)) / 0.6 * camera.fx;
        const double sign = pixel.normal_x > 0 ? 1.0 : -1.0;
        EXPECT_NEAR(pixel.offset / 100.0, -sign * distance_px, 0.12);
        mean += (pixel.offset / 100.0 * sign + distance_px) / rendered.edges.pixel_count;
      }
      EXPECT_LT(std::abs(mean), 0.05);
    }
  }
}

/// Facets that share no vertices, close to the outline of a large cylinder: each facet's plane
/// leaves the next one by more than the depth threshold within a pixel, but not the other way.
TEST(SalientEdges, CurvedSurfaceOfLooseFacetsHasNoDepthEdges) {
  SceneMesh welded;
  welded.addCylinder(Eigen::Vector3d(0, 0, 0), 0.1, 0.2, 400, false);
  const Camera camera = pinholeCamera(360, 200, 1200.0);
  const Rendered rendered = render(
      welded.loose(), camera, poseOf(Eigen::Vector3d(0, 0, 0.05), Eigen::Vector3d(0.02, 0, 0.6)));
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) EXPECT_TRUE(isBorder(pixel));
  EXPECT_GT(rendered.edges.pixel_count, 150);
}

/// Where two lines pass through one pixel, the nearer surface's is recorded.
TEST(SalientEdges, NearerLineWinsWhereTwoCross) {
  const Camera camera = pinholeCamera(100, 100, 200.0);
  // The nearer plate ends 0.3 px above the centres of row 40, the farther one between columns.
  Eigen::Vector3d ray;
  ASSERT_TRUE(unproject(camera, Eigen::Vector2d(50.4, 39.7), ray));
  SceneMesh mesh;
  mesh.addQuad({-1, -1, 0.5}, {1, -1, 0.5}, {1, 0.5 * ray.y(), 0.5}, {-1, 0.5 * ray.y(), 0.5});
  mesh.addQuad({-1, -1, 0.8}, {0.8 * ray.x(), -1, 0.8}, {0.8 * ray.x(), 1, 0.8}, {-1, 1, 0.8});
  const Rendered rendered = render(mesh, camera, Pose());
  for (int x = 0; x < camera.width; ++x) {
    const std::int32_t found = findEdgePixel(rendered.edges, x, 40);
    ASSERT_GE(found, 0);
    EXPECT_FLOAT_EQ(rendered.edges.pixel(found).depth_m, 0.5F);
  }
  const std::int32_t below = findEdgePixel(rendered.edges, 50, 41);
  ASSERT_GE(below, 0);
  EXPECT_FLOAT_EQ(rendered.edges.pixel(below).depth_m, 0.8F);
}

/// Triangles thinner than their vertices' rounding have any normal; a smooth surface that holds
/// some stays smooth.
TEST(SalientEdges, NoiseInSliversIsNoCrease) {
  Random random(11);
  const Camera camera = pinholeCamera(200, 150, 150.0);
  SceneMesh mesh;
  // A plate cut in two along a seam that is filled with triangles of a fraction of a micrometre,
  // out of plane by as much.
  constexpr int kPieces = 40;
  std::vector<std::int32_t> upper, lower, middle;
  for (int i = 0; i <= kPieces; ++i) {
    const double x = -1.5 + 3.0 * i / kPieces;
    // The seam runs exactly through the centres of a row of pixels.
    const double y = (75.0 - camera.cy) / camera.fy;
    upper.push_back(mesh.addVertex({x, -2.0, 1.0}));
    lower.push_back(mesh.addVertex({x, 2.0, 1.0}));
    middle.push_back(mesh.addVertex({x, y - 3e-7, 1.0 + 3e-7 * random.normal()}));
    middle.push_back(mesh.addVertex({x, y + 3e-7, 1.0 + 3e-7 * random.normal()}));
  }
  for (std::size_t i = 0; i < kPieces; ++i) {
    mesh.addFace(upper[i], upper[i + 1], middle[2 * i]);
    mesh.addFace(upper[i + 1], middle[2 * i + 2], middle[2 * i]);
    mesh.addFace(middle[2 * i], middle[2 * i + 2], middle[2 * i + 1]);
    mesh.addFace(middle[2 * i + 1], middle[2 * i + 2], middle[2 * i + 3]);
    mesh.addFace(middle[2 * i + 1], middle[2 * i + 3], lower[i]);
    mesh.addFace(middle[2 * i + 3], lower[i + 1], lower[i]);
  }
  const Rendered rendered = render(mesh, camera, Pose());
  int slivers_seen = 0;
  for (const std::int32_t face : rendered.face)
    slivers_seen += face >= 0 && (face % 6 == 2 || face % 6 == 3) ? 1 : 0;
  EXPECT_GT(slivers_seen, 100);
  EXPECT_EQ(rendered.edges.pixel_count, 0);
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
  int far_off = 0;
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
    const double distance = distanceToHull(hull, Eigen::Vector2d(pixel.x, pixel.y));
    EXPECT_LT(std::abs(distance), 0.75);
    mean += distance / rendered.edges.pixel_count;
    const double error = pixel.offset / 100.0 + distance;
    mean_offset += error / rendered.edges.pixel_count;
    far_off += std::abs(error) > 0.03 ? 1 : 0;
  }
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

TEST(SalientEdges, TessellatedSphereShowsItsSilhouetteOnly) {
  for (const int rings : {24, 60}) {
    SceneMesh mesh;
    mesh.addBall({0, 0, 0}, 0.08, rings, 2 * rings);
    expectOnlySilhouette(mesh, pinholeCamera(300, 300, 600.0),
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
    mesh.addGridFaces(0, kCells, kCells);
    const Rendered rendered = render(mesh, brownCamera(200, 160, 220.0, -0.1), Pose());
    for (const EdgePixel& pixel : pixelsOf(rendered.edges)) EXPECT_TRUE(isBorder(pixel));
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
  // The near plane cuts the ground 37.5 px below the centre.
  constexpr double kHeight_m = 0.625 * CameraScene::kNearPlane_m;
  mesh.addQuad({-0.625, kHeight_m, -0.125}, {0.625, kHeight_m, -0.125}, {0.625, kHeight_m, 50},
               {-0.625, kHeight_m, 50});
  const Camera camera = pinholeCamera(100, 100, 60.0);
  const Rendered rendered = render(mesh, camera, Pose());
  EXPECT_EQ(rendered.faceAt(50, 99), -1);
  EXPECT_GE(rendered.faceAt(50, 80), 0);
  // The sides and the horizon of the ground are there; where the near plane cuts it is not.
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) EXPECT_GT(pixel.depth_m, 0.025F);
  EXPECT_GT(rendered.edges.pixel_count, 0);

  SceneMesh wall;
  wall.addQuad({-50, -50, 1}, {50, -50, 1}, {50, 50, 1}, {-50, 50, 1});
  EXPECT_EQ(countEdges(wall, brownCamera(200, 150, 90.0, -0.35)), 0);
}

}  // namespace
}  // namespace boresight::testing
