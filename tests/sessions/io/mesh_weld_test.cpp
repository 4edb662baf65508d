// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace boresight::sessions {
namespace {

using Eigen::Vector3f;

std::vector<Face> soup(std::int32_t triangles) {
  std::vector<Face> faces;
  for (std::int32_t i = 0; i < triangles; ++i) faces.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
  return faces;
}

TEST(WeldMesh, JoinsEqualPositionsInTheOrderOfAppearance) {
  const std::vector<Vector3f> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                          {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  const WeldedMesh welded = weldMesh(vertices, soup(2));
  ASSERT_EQ(welded.vertices.size(), 4u);
  EXPECT_EQ(welded.vertices[3], Vector3f(1, 1, 0));
  EXPECT_EQ(welded.merged_vertices, 2);
  ASSERT_EQ(welded.faces.size(), 2u);
  EXPECT_EQ(welded.faces[1].vertex, (std::array<std::int32_t, 3>{2, 1, 3}));
}

TEST(WeldMesh, JoinsNegativeAndPositiveZero) {
  const std::vector<Vector3f> vertices = {{0.0F, 0, 0},  {1, 0, 0}, {0, 1, 0},
                                          {-0.0F, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  EXPECT_EQ(weldMesh(vertices, soup(2)).vertices.size(), 4u);
}

TEST(WeldMesh, JoinsWhatRoundingSeparatedButNotNeighbours) {
  const float step = std::numeric_limits<float>::epsilon();
  const std::vector<Vector3f> vertices = {{1, 0, 0},        {0, 1, 0}, {0, 0, 1},
                                          {1 + step, 0, 0}, {0, 1, 0}, {1 + 40 * step, 0, 0}};
  const WeldedMesh welded = weldMesh(vertices, soup(2));
  EXPECT_EQ(welded.vertices.size(), 4u);
  EXPECT_EQ(welded.faces[1].vertex[0], 0);
  EXPECT_EQ(welded.faces[1].vertex[2], 3);
}

TEST(WeldMesh, LeavesOutCollapsedFacesAndUnusedVertices) {
  const std::vector<Vector3f> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 0, 0}};
  const WeldedMesh welded = weldMesh(vertices, {{{0, 1, 2}}, {{0, 1, 4}}});
  EXPECT_EQ(welded.faces.size(), 1u);
  EXPECT_EQ(welded.collapsed_faces, 1);
  EXPECT_EQ(welded.unused_vertices, 1);
  EXPECT_EQ(welded.vertices.size(), 3u);
}

/// Against comparing every pair: the grid must not lose a neighbour across its cells' borders.
TEST(WeldMesh, FindsTheSameVerticesAsComparingEveryPair) {
  Random random(11);
  for (int round = 0; round < 30; ++round) {
    std::vector<Vector3f> vertices;
    // Clusters about as wide as the tolerance, in coordinates of either sign.
    for (int cluster = 0; cluster < 20; ++cluster) {
      const Vector3f centre(static_cast<float>(random.uniform(-1, 1)),
                            static_cast<float>(random.uniform(-1, 1)),
                            static_cast<float>(random.uniform(-1, 1)));
      for (int i = 0; i < 6; ++i) {
        Vector3f vertex = centre;
        for (int axis = 0; axis < 3; ++axis)
          vertex[axis] += static_cast<float>(random.uniform(-4e-7, 4e-7));
        vertices.push_back(vertex);
      }
    }
    // The corners of a face come from different clusters, so that no face collapses.
    std::vector<Face> faces;
    for (std::int32_t cluster = 0; cluster + 2 < 20; cluster += 3)
      for (std::int32_t i = 6 * cluster; i < 6 * cluster + 6; ++i)
        faces.push_back({{i, i + 6, i + 12}});
    const float tolerance = weldTolerance(vertices);
    std::vector<Vector3f> kept;
    const WeldedMesh welded = weldMesh(vertices, faces);
    ASSERT_EQ(welded.faces.size(), faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vector3f& vertex = vertices[static_cast<std::size_t>(faces[f].vertex[corner])];
        std::size_t expected = 0;
        while (expected < kept.size() &&
               !((kept[expected] - vertex).cwiseAbs().maxCoeff() <= tolerance))
          ++expected;
        if (expected == kept.size()) kept.push_back(vertex);
        ASSERT_EQ(static_cast<std::size_t>(welded.faces[f].vertex[corner]), expected);
      }
    EXPECT_EQ(welded.vertices, kept);
    EXPECT_EQ(welded.merged_vertices, static_cast<std::int64_t>(3 * faces.size() - kept.size()));
  }
}

}  // namespace
}  // namespace boresight::sessions
