// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "core/base/random.h"
#include "core/geometry/pose.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

std::vector<Face> soup(std::int32_t triangles) {
  std::vector<Face> faces;
  for (std::int32_t i = 0; i < triangles; ++i) faces.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
  return faces;
}

Mesh welded(const std::vector<Vector3f>& vertices, const std::vector<Face>& faces) {
  Mesh mesh{vertices, faces, {}};
  weldMesh(mesh);
  return mesh;
}

TEST(WeldMesh, JoinsZerosOfEitherSignAndWhatRoundingSeparatedButNotNeighbours) {
  const float step = std::numeric_limits<float>::epsilon();
  const std::vector<Vector3f> vertices = {{1, 0, 0},        {0, 1, 0}, {0, 0, 1},
                                          {1 + step, 0, 0}, {0, 1, 0}, {1 + 40 * step, 0, 0}};
  const Mesh mesh = welded(vertices, soup(2));
  EXPECT_EQ(mesh.vertices_m.size(), 4u);
  EXPECT_EQ(mesh.faces[1].vertex[0], 0);
  EXPECT_EQ(mesh.faces[1].vertex[2], 3);
  const std::vector<Vector3f> zeros = {{0.0F, 0, 0},  {1, 0, 0}, {0, 1, 0},
                                       {-0.0F, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  EXPECT_EQ(welded(zeros, soup(2)).vertices_m.size(), 4u);
}

/// Against comparing every pair: the grid must not lose a neighbour across its cells' borders.
TEST(WeldMesh, FindsTheSameVerticesAsComparingEveryPair) {
  Random random(11);
  for (int round = 0; round < 30; ++round) {
    std::vector<Vector3f> vertices;
    // Clusters about as wide as the tolerance, in coordinates of either sign.
    for (int cluster = 0; cluster < 20; ++cluster) {
      const Vector3f centre = test::randomVector(random, 1.0).cast<float>();
      for (int i = 0; i < 6; ++i)
        vertices.push_back(centre + test::randomVector(random, 4e-7).cast<float>());
    }
    // The corners of a face come from different clusters, so that no face collapses.
    std::vector<Face> faces;
    for (std::int32_t cluster = 0; cluster + 2 < 20; cluster += 3)
      for (std::int32_t i = 6 * cluster; i < 6 * cluster + 6; ++i)
        faces.push_back({{i, i + 6, i + 12}});
    const float tolerance = weldTolerance(vertices);
    std::vector<Vector3f> kept;
    const Mesh mesh = welded(vertices, faces);
    ASSERT_EQ(mesh.faces.size(), faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vector3f& vertex = vertices[static_cast<std::size_t>(faces[f].vertex[corner])];
        std::size_t expected = 0;
        while (expected < kept.size() &&
               !((kept[expected] - vertex).cwiseAbs().maxCoeff() <= tolerance))
          ++expected;
        if (expected == kept.size()) kept.push_back(vertex);
        ASSERT_EQ(static_cast<std::size_t>(mesh.faces[f].vertex[corner]), expected);
      }
    EXPECT_EQ(mesh.vertices_m, kept);
    EXPECT_EQ(mesh.info.merged_vertices, static_cast<std::int64_t>(3 * faces.size() - kept.size()));
  }
}

Vector3d areaVector(const std::vector<Vector3f>& vertices, const std::array<std::int32_t, 3>& t) {
  const auto v = [&](std::size_t i) -> Vector3d {
    return vertices[static_cast<std::size_t>(t[i])].cast<double>();
  };
  return 0.5 * (v(1) - v(0)).cross(v(2) - v(0));
}

std::vector<std::int32_t> allOf(const std::vector<Vector3f>& vertices) {
  std::vector<std::int32_t> corners(vertices.size());
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

/// Sum of the triangles' areas, each taken positive: equal to the polygon's area only when they
/// neither overlap nor reach outside.
double coveredArea(const std::vector<Vector3f>& vertices, const std::vector<Face>& faces) {
  double area = 0.0;
  for (const Face& face : faces) area += areaVector(vertices, face.vertex).norm();
  return area;
}

/// Star-shaped polygons around a centre, in random planes: their area is the sum of the slices.
TEST(TriangulatePolygon, CoversConcavePolygonsOnceWithTheirWinding) {
  Random random(6);
  for (int round = 0; round < 500; ++round) {
    const std::size_t count = 4 + random.below(20);
    const Eigen::Quaterniond turn =
        rotationExp(Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
    std::vector<Vector3f> vertices;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle =
          2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      const double radius = random.uniform(0.2, 2.0);
      vertices.push_back(
          (turn * Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.5)).cast<float>());
    }
    const Vector3d centre = turn * Vector3d(0, 0, 0.5);
    Vector3d area = Vector3d::Zero();
    for (std::size_t i = 0; i < count; ++i)
      area += 0.5 * (vertices[i].cast<double>() - centre)
                        .cross(vertices[(i + 1) % count].cast<double>() - centre);
    std::vector<Face> faces;
    ASSERT_TRUE(triangulatePolygon(vertices, allOf(vertices), faces));
    ASSERT_EQ(faces.size(), count - 2);
    EXPECT_NEAR(coveredArea(vertices, faces), area.norm(), 1e-5);
    for (const Face& face : faces)
      EXPECT_GT(areaVector(vertices, face.vertex).dot(area.normalized()), -1e-6);
  }
}

TEST(TriangulatePolygon, TakesCornersOnAStraightLineAndLeavesATriangleAsItIs) {
  const std::vector<Vector3f> vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0},
                                          {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  std::vector<Face> faces;
  EXPECT_TRUE(triangulatePolygon(vertices, allOf(vertices), faces));
  EXPECT_EQ(faces.size(), 5u);
  EXPECT_NEAR(coveredArea(vertices, faces), 4.0, 1e-12);
  std::vector<Face> triangle;
  EXPECT_TRUE(triangulatePolygon(vertices, std::vector<std::int32_t>{6, 3, 4}, triangle));
  ASSERT_EQ(triangle.size(), 1u);
  EXPECT_EQ(triangle[0].vertex, (std::array<std::int32_t, 3>{6, 3, 4}));
}

TEST(TriangulatePolygon, FansWhatHasNoInside) {
  // A bow tie, four points on a line, one point four times.
  const std::vector<std::vector<Vector3f>> polygons = {
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
      {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
  for (const auto& vertices : polygons) {
    std::vector<Face> faces;
    (void)triangulatePolygon(vertices, allOf(vertices), faces);
    EXPECT_EQ(faces.size(), 2u);
  }
  std::vector<Face> faces;
  EXPECT_FALSE(triangulatePolygon(std::vector<Vector3f>(2000, Vector3f::Zero()),
                                  std::vector<std::int32_t>(2000, 0), faces));
  EXPECT_EQ(faces.size(), 1998u);
}

}  // namespace
}  // namespace boresight::sessions
