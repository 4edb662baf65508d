// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

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
  mesh.addFace(0, 2, 1);
  mesh.addFace(0, 1, 3);
  mesh.addFace(1, 2, 3);
  mesh.addFace(0, 3, 2);
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

/// The adjacency by its definition: faces per edge, in a map.
std::vector<std::array<std::int32_t, 3>> bruteAdjacency(const OwnedMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<std::int32_t>> faces_of_edge;
  const auto edge = [&mesh](std::size_t f, std::size_t i) {
    const auto& v = mesh.faces[f].vertex;
    return std::pair<int, int>(std::minmax({v[i], v[(i + 1) % 3]}));
  };
  const auto repeats = [&mesh](std::size_t f) {
    const auto& v = mesh.faces[f].vertex;
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3 && !repeats(f); ++i)
      faces_of_edge[edge(f, i)].push_back(static_cast<std::int32_t>(f));
  std::vector<std::array<std::int32_t, 3>> result(mesh.faces.size(), {-1, -1, -1});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3 && !repeats(f); ++i) {
      const auto& sharing = faces_of_edge[edge(f, i)];
      if (sharing.size() != 2) continue;
      const auto self = static_cast<std::int32_t>(f);
      result[f][i] = sharing[0] == self ? sharing[1] : sharing[0];
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

/// The faces of a mesh in 16 bits.
std::vector<ShortFace> shortFaces(const OwnedMesh& mesh) {
  std::vector<ShortFace> faces;
  for (const Face& face : mesh.faces) {
    ShortFace& shortened = faces.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) shortened[i] = static_cast<std::uint16_t>(face.vertex[i]);
  }
  return faces;
}

TEST(FaceList, ReadsBothFormsAlike) {
  OwnedMesh mesh = grid(9);
  mesh.vertices.resize(kShortVertices, Eigen::Vector3f::Zero());
  mesh.addFace(65535, 0, 65534);
  const std::vector<ShortFace> faces = shortFaces(mesh);
  const FaceList wide = mesh.faces;
  const FaceList narrow{std::span<const ShortFace>(faces)};
  ASSERT_EQ(narrow.size(), wide.size());
  std::size_t at = 0;
  for (const Face& face : narrow) {
    EXPECT_EQ(face.vertex, mesh.faces[at].vertex);
    EXPECT_EQ(wide[at].vertex, mesh.faces[at].vertex);
    ++at;
  }
  EXPECT_EQ(at, mesh.faces.size());
  for (const FaceList& list : {wide, narrow}) {
    std::size_t visited = 0;
    list.forEach(3, 20, [&](std::size_t i, const auto& vertex) {
      EXPECT_EQ(i, visited++);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(std::int32_t{vertex[k]}, mesh.faces[3 + i].vertex[k]);
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

TEST(ValidateMesh, AcceptsDegenerateFacesAndLooseVertices) {
  OwnedMesh mesh = tetrahedron();
  mesh.addFace(0, 0, 1);
  mesh.vertices.emplace_back(9.0f, 9.0f, 9.0f);
  EXPECT_EQ(validateMesh(mesh.view()), Status::kOk);
}

TEST(ValidateMesh, RefusesIndicesOutOfBounds) {
  const auto status = [](auto&& change) {
    OwnedMesh mesh = tetrahedron();
    change(mesh);
    return validateMesh(mesh.view());
  };
  EXPECT_EQ(status([](OwnedMesh&) {}), Status::kOk);
  EXPECT_EQ(validateMesh(MeshView{}), Status::kInvalidMesh);
  const auto no_faces = [](OwnedMesh& m) { m.faces.clear(), m.part_of_face.clear(); };
  EXPECT_EQ(status(no_faces), Status::kInvalidMesh);
  EXPECT_EQ(status([](OwnedMesh& m) { m.vertices.clear(); }), Status::kInvalidMesh);
  EXPECT_EQ(status([](OwnedMesh& m) { m.parts.clear(); }), Status::kInvalidMesh);
  EXPECT_EQ(status([](OwnedMesh& m) { m.part_of_face.pop_back(); }), Status::kInvalidMesh);
  EXPECT_EQ(status([](OwnedMesh& m) { m.part_of_face.push_back(0); }), Status::kInvalidMesh);
  EXPECT_EQ(status([](OwnedMesh& m) { m.part_of_face[3] = 1; }), Status::kInvalidMesh);
  for (std::size_t i = 0; i < 3; ++i)
    for (const std::int32_t bad : {-1, 4, std::numeric_limits<std::int32_t>::min()})
      EXPECT_EQ(status([i, bad](OwnedMesh& m) { m.faces[2].vertex[i] = bad; }),
                Status::kInvalidMesh);
}

TEST(ValidateMesh, RefusesNumbersThatAreNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {kInfinity, -kInfinity, kNan})
    for (int i = 0; i < 3; ++i) {
      OwnedMesh mesh = tetrahedron();
      mesh.vertices[3][i] = bad;
      EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
    }
  for (const double bad : {-1.0, static_cast<double>(kInfinity), static_cast<double>(kNan)}) {
    OwnedMesh mesh = tetrahedron();
    mesh.parts[0].normal_threshold_rad = bad;
    EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
    mesh.parts[0] = ScenePart{};
    mesh.parts[0].depth_threshold_m = bad;
    EXPECT_EQ(validateMesh(mesh.view()), Status::kInvalidMesh);
  }
}

/// A tetrahedron of the station and one fixed to the camera.
OwnedMesh withCameraPart() {
  OwnedMesh mesh = tetrahedron();
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.parts.push_back(ScenePart{});
  mesh.parts[1].match = false;
  mesh.parts[1].fixed_to_camera = true;
  for (const auto& corner :
       {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(1, 0, 1), Eigen::Vector3f(0, 1, 1)})
    mesh.vertices.push_back(corner);
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

TEST(MatchedBounds, LeavesOutPartsFixedToTheCamera) {
  EXPECT_EQ(matchedBounds(withCameraPart().view()).maximum_m,
            matchedBounds(tetrahedron().view()).maximum_m);
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
}

TEST(MatchedBounds, IsEmptyWithoutMatchedFaces) {
  OwnedMesh mesh = tetrahedron();
  mesh.parts[0].match = false;
  EXPECT_EQ(matchedBounds(mesh.view()).diagonal(), 0.0);
}

}  // namespace
}  // namespace boresight::test
