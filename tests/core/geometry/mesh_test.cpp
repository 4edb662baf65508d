// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

/// A mesh that owns its arrays.
struct OwnedMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<ScenePart> parts = {ScenePart{}};

  MeshView view() const { return {vertices, faces, part_of_face, parts}; }

  void addFace(std::int32_t a, std::int32_t b, std::int32_t c, std::uint16_t part = 0) {
    faces.push_back(Face{{a, b, c}});
    part_of_face.push_back(part);
  }
};

OwnedMesh tetrahedron() {
  OwnedMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.faces = {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}};
  mesh.part_of_face.assign(4, 0);
  return mesh;
}

/// n x n squares of two triangles each.
OwnedMesh grid(int n) {
  OwnedMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.vertices.emplace_back(static_cast<float>(i), static_cast<float>(j), 0.0f);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int corner = j * (n + 1) + i;
      mesh.addFace(corner, corner + 1, corner + n + 2);
      mesh.addFace(corner, corner + n + 2, corner + n + 1);
    }
  return mesh;
}

/// The adjacency by its definition: faces, and their sides, per edge.
std::vector<std::array<std::int32_t, 3>> bruteAdjacency(const OwnedMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, std::size_t>>> sides_of_edge;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& v = mesh.faces[f].vertex;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      sides_of_edge[std::minmax(v[i], v[(i + 1) % 3])].emplace_back(f, i);
  }
  std::vector<std::array<std::int32_t, 3>> result(mesh.faces.size(), {-1, -1, -1});
  for (const auto& [edge, sides] : sides_of_edge) {
    if (sides.size() != 2) continue;
    for (const std::size_t k : {0, 1})
      result[sides[k].first][sides[k].second] = static_cast<std::int32_t>(sides[1 - k].first);
  }
  return result;
}

void expectBruteAdjacency(const OwnedMesh& mesh) {
  Arena counter;
  MeshAdjacency adjacency;
  ASSERT_EQ(buildAdjacency(mesh.view(), counter, adjacency), Status::kOk);
  EXPECT_EQ(adjacency.size(), 0u);

  std::vector<std::byte> block(counter.highWater());
  Arena arena(block);
  ASSERT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
  EXPECT_EQ(arena.used(), counter.used());
  EXPECT_EQ(arena.highWater(), counter.highWater());
  EXPECT_LT(arena.used(), arena.highWater()) << "the scratch was not given back";
  const auto expected = bruteAdjacency(mesh);
  ASSERT_EQ(adjacency.size(), expected.size());
  for (std::size_t f = 0; f < expected.size(); ++f)
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(adjacency.beyond(static_cast<std::int32_t>(f), i),
                expected[f][static_cast<std::size_t>(i)])
          << "face " << f;
}

TEST(FaceList, ReadsBothFormsAlike) {
  OwnedMesh mesh = grid(9);
  mesh.vertices.resize(kShortVertices, Eigen::Vector3f::Zero());
  mesh.addFace(65535, 0, 65534);
  std::vector<ShortFace> faces;
  for (const Face& face : mesh.faces)
    std::ranges::transform(face.vertex, faces.emplace_back().begin(),
                           [](std::int32_t i) { return static_cast<std::uint16_t>(i); });
  const FaceList wide = mesh.faces;
  const FaceList narrow{std::span<const ShortFace>(faces)};
  for (const FaceList& list : {wide, narrow}) {
    ASSERT_EQ(list.size(), mesh.faces.size());
    std::size_t at = 0;
    for (const Face& face : list) {
      EXPECT_EQ(face.vertex, mesh.faces[at].vertex);
      EXPECT_EQ(list[at].vertex, mesh.faces[at].vertex);
      ++at;
    }
    EXPECT_EQ(at, mesh.faces.size());
    std::size_t visited = 0;
    list.forEach(3, 20, [&](std::size_t i, const auto& vertex) {
      EXPECT_EQ(i, visited++);
      EXPECT_TRUE(std::ranges::equal(vertex, mesh.faces[3 + i].vertex));
    });
    EXPECT_EQ(visited, 20u);
    EXPECT_EQ(list.first(5).size(), 5u);
  }
  MeshView view = mesh.view();
  view.faces = narrow;
  EXPECT_EQ(validateMesh(view), Status::kOk);
}

TEST(BuildAdjacency, HoldsMoreFacesThan16BitsCount) {
  expectBruteAdjacency(grid(182));  // 66248 faces
}

TEST(BuildAdjacency, EqualsTheDefinitionOnRandomFaces) {
  Random random = randomFor("BuildAdjacency.EqualsTheDefinition");
  for (int i = 0; i < 100; ++i) {
    OwnedMesh mesh;
    const std::uint32_t vertices = 3 + random.below(30);
    mesh.vertices.resize(vertices, Eigen::Vector3f::Zero());
    const std::uint32_t faces = 1 + random.below(120);
    const auto any = [&] { return static_cast<std::int32_t>(random.below(vertices)); };
    for (std::uint32_t f = 0; f < faces; ++f) mesh.addFace(any(), any(), any());
    expectBruteAdjacency(mesh);
  }
}

TEST(BuildAdjacency, SmallArena_IsReported) {
  const OwnedMesh mesh = grid(4);
  Arena counter;
  MeshAdjacency adjacency;
  ASSERT_EQ(buildAdjacency(mesh.view(), counter, adjacency), Status::kOk);
  for (std::size_t bytes = 16; bytes < counter.highWater(); bytes += 16) {
    std::vector<std::byte> block(bytes);
    Arena arena(block);
    EXPECT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kArenaTooSmall);
    EXPECT_EQ(adjacency.size(), 0u);
  }
}

/// The status of a tetrahedron after a change.
template <class Change>
Status statusAfter(Change change) {
  OwnedMesh mesh = tetrahedron();
  change(mesh);
  return validateMesh(mesh.view());
}

template <class Change>
void expectRefused(Change change) {
  EXPECT_EQ(statusAfter(change), Status::kInvalidMesh);
}

TEST(ValidateMesh, AcceptsDegenerateFacesAndLooseVertices) {
  EXPECT_EQ(statusAfter([](OwnedMesh& m) {
              m.addFace(0, 0, 1);
              m.vertices.emplace_back(9.0f, 9.0f, 9.0f);
            }),
            Status::kOk);
}

TEST(ValidateMesh, RefusesIndicesOutOfBounds) {
  EXPECT_EQ(validateMesh(MeshView{}), Status::kInvalidMesh);
  expectRefused([](OwnedMesh& m) { m.faces.clear(), m.part_of_face.clear(); });
  expectRefused([](OwnedMesh& m) { m.vertices.clear(); });
  expectRefused([](OwnedMesh& m) { m.parts.clear(); });
  expectRefused([](OwnedMesh& m) { m.part_of_face.pop_back(); });
  expectRefused([](OwnedMesh& m) { m.part_of_face.push_back(0); });
  expectRefused([](OwnedMesh& m) { m.part_of_face[3] = 1; });
  for (std::size_t i = 0; i < 3; ++i)
    for (const std::int32_t bad : {-1, 4, std::numeric_limits<std::int32_t>::min()})
      expectRefused([=](OwnedMesh& m) { m.faces[2].vertex[i] = bad; });
}

TEST(ValidateMesh, RefusesNumbersThatAreNotFinite) {
  for (const double bad : {kInfinity, -kInfinity, kNan})
    for (int i = 0; i < 3; ++i)
      expectRefused([=](OwnedMesh& m) { m.vertices[3][i] = static_cast<float>(bad); });
  for (const double bad : {-1.0, kInfinity, kNan}) {
    expectRefused([=](OwnedMesh& m) { m.parts[0].normal_threshold_rad = bad; });
    expectRefused([=](OwnedMesh& m) { m.parts[0].depth_threshold_m = bad; });
  }
}

/// A tetrahedron of the station and one fixed to the camera.
OwnedMesh withCameraPart() {
  OwnedMesh mesh = tetrahedron();
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.parts.push_back(ScenePart{});
  mesh.parts[1].match = false;
  mesh.parts[1].fixed_to_camera = true;
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
  mesh.addFace(first, first + 1, first + 2, 1);
  return mesh;
}

TEST(ValidateMesh, PartFixedToTheCamera_IsNeverMatchedAndHasTheLastVertices) {
  OwnedMesh mesh = withCameraPart();
  EXPECT_EQ(validateMesh(mesh.view()), Status::kOk);
  EXPECT_EQ(firstVertexInCamera(mesh.view()), 4u);
  EXPECT_EQ(firstVertexInCamera(tetrahedron().view()), 4u);
  mesh.parts[1].match = true;
  EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
  mesh = withCameraPart();
  mesh.faces.back().vertex[0] = 3;  // also of the station's faces
  EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
  mesh = withCameraPart();
  mesh.vertices.push_back(mesh.vertices[0]);
  mesh.faces[0].vertex[0] = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
}

TEST(MatchedBounds, CoversVerticesOfMatchedFacesOnly) {
  OwnedMesh mesh;
  mesh.vertices = {{1, 2, 3}, {2, 2, 3}, {1, 4, 5}, {-50, 0, 0}, {0, -60, 0}, {0, 0, 70}};
  mesh.parts = {ScenePart{}, ScenePart{}};
  mesh.parts[1].match = false;
  mesh.addFace(3, 4, 5, 1);
  mesh.addFace(0, 1, 2, 0);
  const BoundingBox box = matchedBounds(mesh.view());
  EXPECT_EQ(box.minimum_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(box.maximum_m, Eigen::Vector3d(2, 4, 5));
  EXPECT_EQ(box.centre(), Eigen::Vector3d(1.5, 3, 4));
  EXPECT_DOUBLE_EQ(box.diagonal(), 3.0);
  mesh.parts[0].match = false;
  EXPECT_EQ(matchedBounds(mesh.view()).diagonal(), 0.0);
  EXPECT_EQ(matchedBounds(withCameraPart().view()).maximum_m,
            matchedBounds(tetrahedron().view()).maximum_m);
}

}  // namespace
}  // namespace boresight::test
