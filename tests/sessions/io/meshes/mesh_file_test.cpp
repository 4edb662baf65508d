// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "core/base/random.h"
#include "core/geometry/mesh.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/sessions/io/meshes/mesh_samples.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using namespace boresight::test;  // NOLINT: the samples are this file's vocabulary

struct Extent {
  double volume_m3 = 0.0;  ///< positive when the faces are seen from outside
  double area_m2 = 0.0;
};

Extent extentOf(const Mesh& mesh) {
  Extent extent;
  for (const Face& face : mesh.faces) {
    Eigen::Vector3d corner[3];
    for (std::size_t i = 0; i < 3; ++i)
      corner[i] = mesh.vertices_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
    extent.volume_m3 += corner[0].dot(corner[1].cross(corner[2])) / 6.0;
    extent.area_m2 += 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  }
  return extent;
}

/// A closed, outward cube whatever the format: 8 vertices, 12 faces, the right place and volume.
void expectCube(const Mesh& mesh, double scale = 1.0) {
  EXPECT_EQ(mesh.vertices_m.size(), 8u);
  EXPECT_EQ(mesh.faces.size(), 12u);
  EXPECT_TRUE(mesh.info.minimum_m.isApprox(scale * Eigen::Vector3d(-1, -1, 9), 1e-6));
  EXPECT_TRUE(mesh.info.maximum_m.isApprox(scale * Eigen::Vector3d(1, 1, 11), 1e-6));
  EXPECT_NEAR(extentOf(mesh).volume_m3 / std::pow(scale, 3), 8.0, 1e-5);
  EXPECT_NEAR(extentOf(mesh).area_m2 / (scale * scale), 24.0, 1e-5);
  const std::vector<std::uint16_t> part_of_face(mesh.faces.size(), 0);
  const std::array<ScenePart, 1> parts = {};
  EXPECT_EQ(validateMesh({mesh.vertices_m, mesh.faces, part_of_face, parts}), Status::kOk);
}

class ReadMesh : public FolderTest {
 protected:
  Mesh read(const std::string& name, const std::string& content, const std::string& unit = "m") {
    return readMesh(folder_.write(name, content), unit);
  }
  std::string error(const std::string& name, const std::string& content,
                    const std::string& unit = "m") {
    return folder_.message([&] { (void)read(name, content, unit); });
  }
  /// What is said of a mesh in a folder of its own with this buffer.
  std::string bufferError(const std::string& uri) {
    return error("mesh/cube.gltf", gltf(cube(), kOneNode, R"("uri":")" + uri + R"(",)"), "");
  }
};

/// The cube's quads as one list of strips, each ended by -1, with the elements in either order.
std::string stripsPly(const std::string& encoding) {
  const PolygonMesh mesh = cube();
  std::vector<std::int32_t> strips;
  for (const auto& quad : mesh.polygons)
    for (const std::int32_t index : {quad[0], quad[1], quad[3], quad[2], -1})
      strips.push_back(index);
  // A strip that turns around at doubled vertices has no further triangles.
  strips.insert(strips.end(), {0, 0, 0, 1, 1});
  std::string text = plyHeader(encoding, 8, 0);
  const std::string face = "element face 0\nproperty list uchar int vertex_indices\n";
  text.replace(text.find(face), face.size(),
               "property uchar red\nelement tristrips 1\nproperty list int int vertex_indices\n");
  const auto add = [&](auto value) {
    if (encoding == "ascii")
      text += std::to_string(value) + " ";
    else
      appendNumber(text, value, encoding == "binary_big_endian");
  };
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    for (const float value : vertex) add(value);
    add(std::uint8_t{200});
  }
  add(static_cast<std::int32_t>(strips.size()));
  for (const std::int32_t index : strips) add(index);
  return text;
}

TEST_F(ReadMesh, PlyWithTriangleStrips_IsReadAsTriangles) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
    expectCube(read("strips.ply", stripsPly(encoding)));
  std::string outside = stripsPly("ascii");
  outside.replace(outside.rfind("0 0 0 1 1"), 9, "0 1 8 1 1");
  EXPECT_THAT(error("outside.ply", outside), HasSubstr("vertex 8 does not exist"));
  const std::string whole = stripsPly("binary_little_endian");
  EXPECT_THAT(error("cut.ply", whole.substr(0, whole.size() - 3)), HasSubstr("truncated"));
}

TEST_F(ReadMesh, ReadsEveryFormat) {
  expectCube(read("ascii.ply", asciiPly(cube())));
  expectCube(read("little.ply", binaryPly(cube(), false)));
  expectCube(read("big.ply", binaryPly(cube(), true)));
  expectCube(read("CUBE.OBJ", obj(cube())));
  expectCube(read("binary.stl", binaryStl(cube())));
  expectCube(read("tricky.stl", binaryStl(cube(), "solid but binary")));
  expectCube(read("ascii.stl", asciiStl(cube())));
  expectCube(read("cube.glb", glb(cube()), ""));
  folder_.write("cube.bin", gltfBuffer(cube()));
  expectCube(read("cube.gltf", gltf(cube(), kOneNode, R"("uri":"cube.bin",)"), ""));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

TEST_F(ReadMesh, BinaryPlyWhoseHeaderEndsItsLinesInCrLf_IsRead) {
  for (const bool big_endian : {false, true}) {
    const std::string ply = binaryPly(cube(), big_endian);
    const std::size_t body = ply.find("end_header\n") + 11;
    expectCube(read("crlf.ply", replaced(ply.substr(0, body), "\n", "\r\n") + ply.substr(body)));
  }
}

/// Doubles, a name of the list of other programs, colours with alpha, coordinates of a texture
/// behind each face.
TEST_F(ReadMesh, AsciiPlyWithFurtherProperties_IsRead) {
  const PolygonMesh mesh = cube();
  std::string text =
      "ply\nformat ascii 1.0\nobj_info num_cols 512\ncomment TextureFile a.png\n"
      "element vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
      "element face 6\nproperty list uchar int vertex_index\n"
      "property list uchar float texcoord\nend_header\n";
  for (const Eigen::Vector3f& v : mesh.vertices) text += numbersOf(v) + " 10 20 30 255\n";
  for (const auto& quad : mesh.polygons) text += "4" + numbersOf(quad) + " 8 0 0 1 0 1 1 0 1\n";
  expectCube(read("further.ply", text));
}

TEST_F(ReadMesh, PlyWithFacesFirstOrCoordinatesInAnotherOrder_IsReadByTheNames) {
  const std::string text = asciiPly(cube());
  const std::size_t vertex = text.find("element vertex");
  const std::size_t face = text.find("element face");
  const std::size_t body = text.find("end_header\n") + 11;
  const std::size_t faces = text.find("\n4 ", body) + 1;
  expectCube(read("faces.ply", text.substr(0, vertex) + text.substr(face, body - 11 - face) +
                                   text.substr(vertex, face - vertex) + "end_header\n" +
                                   text.substr(faces) + text.substr(body, faces - body)));
  std::string turned = replaced(text.substr(0, body), "float x", "float w");
  turned = replaced(turned, "float z", "float x");
  turned = replaced(turned, "float w", "float z");
  for (const Eigen::Vector3f& v : cube().vertices) turned += numbersOf(v.reverse()) + "\n";
  expectCube(read("turned.ply", turned + text.substr(faces)));
}

/// Ends of lines in CR LF, indices from the end, a fourth coordinate, a material file that is not
/// there.
TEST_F(ReadMesh, ObjOfOtherSystems_IsRead) {
  const PolygonMesh mesh = cube();
  std::string text = "mtllib none.mtl\r\no cube\r\n";
  for (const Eigen::Vector3f& v : mesh.vertices) text += "v " + numbersOf(v) + " 1.0\r\n";
  text += "usemtl steel\r\ns off\r\n";
  for (const auto& quad : mesh.polygons) text += "f" + numbersOf(quad, -8) + "\r\n";
  expectCube(read("other.obj", text));
}

/// -0.16 m is 0A D7 23 BE: its first byte is that of a line end.
TEST_F(ReadMesh, TakesAFirstByteOfTenForData) {
  PolygonMesh mesh = cube();
  mesh.vertices[0].x() = -0.16F;
  for (const bool after_carriage_return : {false, true}) {
    std::string bytes = binaryPly(mesh, false);
    if (after_carriage_return) bytes.insert(bytes.find("end_header") + 10, "\r");
    const Mesh result = read("ten.ply", bytes);
    EXPECT_THAT(result.vertices_m, ::testing::UnorderedElementsAreArray(mesh.vertices));
  }
}

TEST_F(ReadMesh, ConvertsTheStatedUnit) {
  expectCube(read("mesh.ply", asciiPly(cube()), "mm"), 1e-3);
  expectCube(read("mesh.stl", binaryStl(cube()), "in"), 0.0254);
  expectCube(read("mesh.obj", obj(cube()), "cm"), 1e-2);
  expectCube(read("mesh.glb", glb(cube()), "mm"), 1e-3);
  EXPECT_EQ(read("mesh.glb", glb(cube()), "").info.unit, "m");
  EXPECT_EQ(metresPerUnit("um"), 1e-6);
  EXPECT_EQ(metresPerUnit("parsec"), std::nullopt);
}

TEST_F(ReadMesh, NeverGuessesAUnit) {
  EXPECT_EQ(error("mesh.ply", asciiPly(cube()), ""),
            "mesh.ply: mesh_unit: missing: PLY carries no unit (m, cm, mm, um, in, ...)");
  EXPECT_THAT(error("mesh.stl", binaryStl(cube()), ""), HasSubstr("STL carries no unit"));
  EXPECT_THAT(error("mesh.obj", obj(cube()), ""), HasSubstr("OBJ carries no unit"));
  EXPECT_EQ(error("mesh.ply", asciiPly(cube()), "furlong"),
            "mesh.ply: mesh_unit: unknown unit 'furlong' (m, dm, cm, mm, um, in, ft, yd, km)");
}

/// Three nested nodes: scaled unequally, mirrored, turned and moved.
TEST_F(ReadMesh, GltfWithScaledMirroredNestedNodes_HasItsExtentAndPlace) {
  const std::string nodes =
      R"([{"children":[1],"translation":[10,0,0]},)"
      R"({"children":[2],"scale":[-1,1,1],"rotation":[0,0,0.70710678118654757,0.70710678118654757]},)"
      R"({"mesh":0,"scale":[1,2,3],"translation":[0,0,-30]}])";
  const Mesh mesh = read("nested.glb", glb(cube(), nodes), "");
  // Scaled: x in -1 .. 1, y in -2 .. 2, z in -3 .. 3; mirrored along x, then turned from x to y.
  EXPECT_TRUE(mesh.info.minimum_m.isApprox(Eigen::Vector3d(8, -1, -3), 1e-5))
      << mesh.info.minimum_m.transpose();
  EXPECT_TRUE(mesh.info.maximum_m.isApprox(Eigen::Vector3d(12, 1, 3), 1e-5))
      << mesh.info.maximum_m.transpose();
  EXPECT_NEAR(extentOf(mesh).volume_m3, 48.0, 1e-3);
  // A mesh is placed once for each of its nodes.
  const std::string two = R"([{"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[10,0,0]}])";
  const Mesh twice = read("mesh.glb", glb(cube(), two), "");
  EXPECT_EQ(twice.faces.size(), 24u);
  EXPECT_NEAR(twice.info.maximum_m.x(), 11.0, 1e-6);
}

/// Nodes that each have the next one as their child, the last with the mesh.
std::string chainOfNodes(int count) {
  std::string nodes = "[";
  for (int i = 1; i < count; ++i) nodes += "{\"children\":[" + std::to_string(i) + "]},";
  return nodes + "{\"mesh\":0}]";
}

/// Importers exhaust their stack on deep nodes; skins and animations may lead to a circle.
TEST_F(ReadMesh, RefusesNodesThatAreNotTreesOrNestedTooDeep) {
  expectCube(read("deep.glb", glb(cube(), chainOfNodes(256)), ""));
  const std::string deep = "nodes[256]: is nested deeper than 256 nodes, or is its own ancestor";
  const std::pair<std::string, std::string> refusals[] = {
      {R"([{"children":[1,1]},{"mesh":0}])", "nodes[0].children[1]: the node has two parents"},
      {R"([{"children":[1]},{"mesh":0,"children":[0]}])",
       "scenes[0].nodes[0]: the scene's root is another node's child"},
      {R"([{"children":[2]},{"mesh":0}])", "nodes[0].children[0]: 2 is outside 0 .. 1"},
      {R"([{"mesh":0},{"children":[2]},{"children":[1]}])",
       "nodes[1]: is nested deeper than 256 nodes, or is its own ancestor"},
      {chainOfNodes(257), deep},
      {chainOfNodes(100'000), deep},
      {chainOfNodes(100'001), "nodes: 100001 nodes exceed the limit of 100000"}};
  for (const auto& [nodes, refusal] : refusals)
    EXPECT_EQ(error("mesh.glb", glb(cube(), nodes), ""), "mesh.glb: " + refusal);
  EXPECT_EQ(error("deep.gltf", gltf(cube(), chainOfNodes(100'000), ""), ""), "deep.gltf: " + deep);
}

/// Skins, images and animations crash importers, and are not needed.
TEST_F(ReadMesh, Gltf_OnlyTheGeometryIsRead) {
  const std::string rest =
      R"("skins":[{"joints":[1e-320]}],"animations":7,"images":[{"bufferView":99}],)"
      R"("materials":[{"extensions":{"KHR_none":[{}]}}],"asset":)";
  const auto with = [&](std::string json) {
    return json.replace(json.find("\"asset\":"), 8, rest);
  };
  const std::string nodes = R"([{"mesh":0,"skin":0,"camera":-1,"extras":[[]]}])";
  folder_.write("cube.bin", gltfBuffer(cube()));
  expectCube(read("cube.gltf", with(gltf(cube(), nodes, R"("uri":"cube.bin",)")), ""));
  expectCube(read("cube.glb", glb(cube(), nodes), ""));
}

/// The importer follows what their members name without a look.
TEST_F(ReadMesh, RefusesSparseAccessors) {
  std::string json = gltf(cube(), kOneNode, "");
  json.insert(json.find("{\"bufferView\":0") + 1, R"("sparse":{"count":1,"values":{}},)");
  EXPECT_EQ(
      error("sparse.gltf", json, ""),
      "sparse.gltf: accessors[0].sparse: is not read: write the mesh without sparse accessors");
}

TEST_F(ReadMesh, GltfBufferIsReadOnlyInTheMeshsFolder) {
  const auto outside = folder_.write("outside.bin", gltfBuffer(cube()));
  folder_.write("mesh/inside.bin", gltfBuffer(cube()));
  folder_.write("mesh/below/cube 1.bin", gltfBuffer(cube()));
  std::filesystem::create_symlink("../outside.bin", folder_ / "mesh/link.bin");
  std::filesystem::create_symlink("..", folder_ / "mesh/up");
  std::filesystem::create_symlink("inside.bin", folder_ / "mesh/alias.bin");
  for (const char* uri : {"inside.bin", "./inside.bin", "below/cube%201.bin", "alias.bin"})
    EXPECT_EQ(bufferError(uri), "(nothing)") << uri;
  for (const std::string& uri :
       std::vector<std::string>{"../outside.bin", "below/../../outside.bin", "%2e%2e/outside.bin",
                                outside.string(), "/dev/zero", "link.bin", "up/outside.bin"})
    EXPECT_THAT(bufferError(uri), AllOf(StartsWith("mesh/cube.gltf: buffers[0].uri: '"),
                                        HasSubstr("is not in the mesh's folder")))
        << uri;
  ASSERT_EQ(::mkfifo((folder_ / "mesh/pipe.bin").c_str(), 0600), 0);
  EXPECT_EQ(bufferError("pipe.bin"),
            "mesh/pipe.bin: is a pipe, a socket or a device: give a regular file");
}

TEST_F(ReadMesh, GltfBuffersTogetherAreNotLargerThanAMeshMayBe) {
  std::filesystem::create_directory(folder_ / "mesh");
  std::ofstream(folder_ / "mesh/large.bin");
  std::filesystem::resize_file(folder_ / "mesh/large.bin", kMaxMeshFileBytes / 2 + 1);
  const std::string buffer = R"({"uri":"large.bin","byteLength":8})";
  EXPECT_THAT(error("mesh/cube.gltf",
                    R"({"asset":{"version":"2.0"},"buffers":[)" + buffer + "," + buffer + "]}", ""),
              HasSubstr("large.bin: larger than the limit of 255 MB"));
}

/// Importers read other files by themselves where they are let.
TEST_F(ReadMesh, GltfBufferOfABinaryFileIsNotReadFromElsewhere) {
  folder_.write("cube.bin", gltfBuffer(cube()));
  const std::string uri = R"("uri":")" + (folder_ / "cube.bin").string() + R"(",)";
  EXPECT_THAT(error("cube.glb", glbFile(gltf(cube(), kOneNode, uri), ""), ""),
              StartsWith("cube.glb: not a readable GLB"));
}

TEST_F(ReadMesh, HashesTheFileAndTheBuffersOfGltf) {
  const std::string text = asciiPly(cube());
  const auto bytes = std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  EXPECT_EQ(read("mesh.ply", text).info.file_sha256, sha256Text(bytes));
  std::string buffer = gltfBuffer(cube());
  folder_.write("mesh.bin", buffer);
  const std::string scene = gltf(cube(), kOneNode, R"("uri":"mesh.bin",)");
  const std::string before = read("mesh.gltf", scene, "").info.file_sha256;
  buffer[0] ^= 1;
  folder_.write("mesh.bin", buffer);
  EXPECT_NE(read("mesh.gltf", scene, "").info.file_sha256, before);
}

TEST_F(ReadMesh, CountsWhatItLeavesOut) {
  PolygonMesh mesh = cube();
  mesh.vertices.emplace_back(50.0F, 0.0F, 0.0F);  // unused
  mesh.vertices.push_back(mesh.vertices[0]);      // repeated
  mesh.polygons.push_back({0, 9, 1});             // collapses
  const Mesh read_mesh = read("mesh.ply", binaryPly(mesh, false));
  const MeshInfo& info = read_mesh.info;
  EXPECT_EQ(std::tie(info.file_vertices, info.file_polygons), std::tuple(10, 7));
  EXPECT_EQ(std::tie(info.unused_vertices, info.merged_vertices, info.collapsed_faces),
            std::tuple(1, 1, 1));
  EXPECT_EQ(info.notes().size(), 2u);
  expectCube(read_mesh);
}

TEST_F(ReadMesh, CountsSliversAndRefusesNothingButSlivers) {
  PolygonMesh mesh = cube();
  mesh.vertices.emplace_back(0.0F, 0.00001F, 9.0F);
  mesh.vertices.emplace_back(-1.0F, 0.0F, 9.0F);
  mesh.vertices.emplace_back(1.0F, 0.0F, 9.0F);
  mesh.polygons.push_back({8, 9, 10});
  EXPECT_EQ(read("mesh.ply", binaryPly(mesh, false)).info.sliver_faces, 1);
  mesh.polygons = {{8, 9, 10}, {8, 10, 9}};
  EXPECT_EQ(error("mesh.ply", binaryPly(mesh, false)),
            "mesh.ply: faces: all 2 are slivers without area");
  mesh.vertices[8] = Eigen::Vector3f(0.0F, 0.0F, 9.0F);
  EXPECT_THAT(error("mesh.ply", binaryPly(mesh, false)), HasSubstr("slivers"));
  mesh.polygons = {{8, 8, 9}};
  EXPECT_THAT(error("mesh.ply", binaryPly(mesh, false)), HasSubstr("no area"));
}

TEST_F(ReadMesh, TriangulatesConcavePolygons) {
  // An L of area 3, whose fan from the first corner would overlap.
  PolygonMesh mesh;
  mesh.vertices = {{2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}};
  mesh.polygons = {{0, 1, 2, 3, 4, 5}};
  for (const char* name : {"mesh.ply", "mesh.obj"}) {
    const Mesh l = read(name, name[5] == 'p' ? asciiPly(mesh) : obj(mesh));
    EXPECT_EQ(l.faces.size(), 4u);
    EXPECT_NEAR(extentOf(l).area_m2, 3.0, 1e-6);
    EXPECT_EQ(l.info.irregular_polygons, 0);
  }
}

TEST_F(ReadMesh, RefusesPointClouds) {
  PolygonMesh points = cube();
  points.polygons.clear();
  const std::string without_faces =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n0 0 0\n";
  for (const std::string& ply : {asciiPly(points), binaryPly(points, false), without_faces})
    EXPECT_EQ(error("mesh.ply", ply),
              "mesh.ply: the mesh has no faces (a point cloud cannot be rendered)");
  EXPECT_THAT(error("mesh.obj", obj(points)), StartsWith("mesh.obj: "));
  EXPECT_EQ(error("mesh.stl", binaryStl(points)), "mesh.stl: the mesh has no faces");
  EXPECT_THAT(error("lines.obj", obj(points) + "l 1 2\n"), StartsWith("lines.obj: "));
}

TEST_F(ReadMesh, RefusesCoordinatesThatAreNotFinite) {
  constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {not_a_number, std::numeric_limits<float>::infinity()}) {
    PolygonMesh mesh = cube();
    mesh.vertices[5].y() = bad;
    EXPECT_EQ(error("mesh.ply", binaryPly(mesh, false)), "mesh.ply: vertex 5: not a finite number");
    EXPECT_THAT(error("mesh.ply", asciiPly(mesh)), HasSubstr("not a finite number"));
    EXPECT_THAT(error("mesh.stl", binaryStl(mesh)), HasSubstr("not a finite number"));
    EXPECT_THAT(error("mesh.glb", glb(mesh), ""), StartsWith("mesh.glb: "));
  }
  PolygonMesh unused = cube();
  unused.vertices.emplace_back(0.0F, not_a_number, 0.0F);
  EXPECT_EQ(error("mesh.ply", binaryPly(unused, false)), "mesh.ply: vertex 8: not a finite number");
  PolygonMesh far = cube();
  far.vertices[2].x() = 5.2e6F;  // coordinates of a survey
  EXPECT_EQ(error("mesh.ply", binaryPly(far, false)),
            "mesh.ply: vertex 2: is more than 1000 km from the origin: check the unit");
}

TEST_F(ReadMesh, RefusesIndicesOutOfRange) {
  for (const std::int32_t bad : {8, 1000000, -1}) {
    PolygonMesh mesh = cube();
    mesh.polygons[3][1] = bad;
    EXPECT_NE(error("mesh.ply", binaryPly(mesh, false)), "(nothing)") << bad;
    EXPECT_NE(error("mesh.ply", asciiPly(mesh)), "(nothing)") << bad;
    if (bad < 0) continue;  // unsigned in glTF, counted from the end in OBJ
    EXPECT_NE(error("mesh.glb", glb(mesh), ""), "(nothing)") << bad;
    EXPECT_NE(error("mesh.obj", obj(mesh)), "(nothing)") << bad;
  }
}

/// The cube as two solids of six facets.
std::string twoSolids() {
  std::string text = asciiStl(cube());
  std::size_t middle = 0;
  for (int facet = 0; facet < 6; ++facet) middle = text.find("endfacet\n", middle) + 9;
  return text.insert(middle, "endsolid cube\nsolid b\n");
}

TEST_F(ReadMesh, StlOfOtherPrograms_IsRead) {
  const std::string text = asciiStl(cube());
  const std::string mark = "\xEF\xBB\xBF";
  expectCube(read("solids.stl", twoSolids()));
  expectCube(read("empty.stl", "solid 4\nendsolid\n" + text));
  for (const std::string& begin : {std::string(" "), std::string("\r\n\t"), mark, mark + " \n"})
    expectCube(read("begin.stl", begin + text));
  expectCube(read("capitals.stl", upperCase(text)));
  expectCube(read("signs.stl", replaced(replaced(text, " 1.0", " +1.0"), "9.000000", "9.0E+00")));
  expectCube(read("crlf.stl", replaced(text, "\n", "\r\n")));
  expectCube(read("end.stl", text + "\n \n"));
  expectCube(read("padded.stl", binaryStl(cube()) + "\n"));
}

TEST_F(ReadMesh, Stl_TheTrueReasonIsGiven) {
  const std::string text = asciiStl(cube());
  const std::string line = "vertex -1.000000 -1.000000 9.000000\n";
  ASSERT_NE(text.find(line), std::string::npos);
  const auto with = [&](const std::string& changed) {
    return error("a.stl", std::string(text).replace(text.find(line), line.size(), changed));
  };
  EXPECT_THAT(with(line + line), AllOf(StartsWith("a.stl: line "),
                                       HasSubstr("more than three vertices: write triangles")));
  EXPECT_THAT(with("vertex -1,0 -1,0 9,0\n"), HasSubstr("'-1,0' is not a number"));
  EXPECT_THAT(with("vertex -1 -1\n"), HasSubstr(" is not a number"));
  EXPECT_THAT(with(""), HasSubstr("instead of vertex"));
  EXPECT_THAT(error("a.stl", text + "facet"), HasSubstr("'facet' instead of solid"));
  EXPECT_EQ(error("a.stl", obj(cube())),
            "a.stl: not an STL mesh: it begins neither with 'solid' nor as a binary one");
  EXPECT_EQ(error("a.stl", "solid none\nendsolid none\n"),
            "a.stl: the mesh has no faces (a point cloud cannot be rendered)");
  EXPECT_EQ(error("a.stl", twoSolids().substr(0, twoSolids().rfind("endfacet"))),
            "a.stl: the STL mesh is truncated");
  EXPECT_EQ(error("a.stl", text.substr(0, text.find("-1.000000") + 1)),
            "a.stl: the STL mesh is truncated");
}

/// A backslash at the end of a name or comment is that of a folder of Windows.
TEST_F(ReadMesh, ObjNameThatEndsInABackslash_LeavesTheNextLineWhole) {
  const std::string text = obj(cube());
  const std::size_t face = text.rfind("f ");
  for (const std::string& line :
       {std::string("usemtl Steel\\Matte\\"), std::string("g C:\\parts\\ "), std::string("o a\\b"),
        std::string("# from D:\\"), std::string("mtllib C:\\a\\"), std::string("s \\")})
    for (const char* end : {"\n", "\r\n"}) {
      expectCube(read("name.obj", std::string(text).insert(face, line + end)));
      expectCube(read("vertex.obj", std::string(text).insert(text.find("v "), line + end)));
    }
  const std::size_t end = text.find('\n', face);
  expectCube(read("comment.obj", std::string(text).insert(end, " # D:\\")));
}

TEST_F(ReadMesh, ObjWithContinuedIndentedAndTabbedLines_IsRead) {
  std::string text = replaced(replaced(obj(cube()), "f ", "  f\t"), "v ", "\tv ");
  expectCube(read("tabs.obj", text));
  expectCube(read("cr.obj", replaced(text, "\n", "\r")));
  text.insert(text.rfind(' '), " \\\r\n");
  text.insert(text.find("v ") + 2, "\\\n  ");
  expectCube(read("continued.obj", text));
  expectCube(read("marked.obj", "\xEF\xBB\xBF" + text.substr(text.find('\n') + 1)));
}

TEST_F(ReadMesh, Obj_LinesThatCannotBeReadAreNamed) {
  const std::string text = obj(cube());
  const auto with = [&](const std::string& line) { return error("a.obj", line + "\n" + text); };
  EXPECT_EQ(with("v 1,5 2,5 3,5"), "a.obj: line 1: '1,5' is not a number: write a decimal point");
  EXPECT_EQ(with("v\xC2\xA0"
                 "1 2 3"),
            "a.obj: line 1: 'v\xC2\xA0"
            "1' is no keyword: write blanks of ASCII");
  EXPECT_EQ(with("v nan 2 3"), "a.obj: line 1: 'nan' is not a finite number");
  EXPECT_EQ(with("f 0 1 2"), "a.obj: line 1: '0' is not a corner of a face");
  EXPECT_EQ(with("f 1 9 2"), "a.obj: line 1: vertex 9 does not exist (there are 8)");
  EXPECT_EQ(with("v 0 0 0\nf 1 1 -2"), "a.obj: line 2: vertex -2 does not exist (there are 1)");
  EXPECT_EQ(with("v 1 2 # 3"), "a.obj: line 1: a vertex has three coordinates");
  EXPECT_EQ(with("f 1 2 x"), "a.obj: line 1: 'x' is not a corner of a face");
  EXPECT_EQ(with("f 1.5 2 3"), "a.obj: line 1: '1.5' is not a corner of a face");
  EXPECT_EQ(with("f"), "a.obj: line 1: a face has no corners");
  EXPECT_EQ(with("F 1 2 3"), "a.obj: line 1: 'F' is no keyword: they are in lower case");
  EXPECT_THAT(read("a.obj", text + "surf 0 1 0 1 1\ncall b.obj\n").info.notes(),
              ::testing::ElementsAre("2 lines of curves, surfaces or other files: not read"));
  EXPECT_EQ(error("a.obj", "\x89PNG"),
            "a.obj: not an OBJ mesh: it has no line of a vertex (v x y z)");
}

TEST_F(ReadMesh, MarkedOrOneLinePly_IsRead) {
  const std::string text = asciiPly(cube());
  const std::size_t body = text.find("end_header\n") + 11;
  expectCube(
      read("line.ply", text.substr(0, body) + replaced(text.substr(body), "\n", " ") + "\n"));
  expectCube(read("marked.ply", "\xEF\xBB\xBF" + text));
  expectCube(read("binary.ply", "\xEF\xBB\xBF" + binaryPly(cube(), false)));
  EXPECT_EQ(error("a.ply", replaced(text, "float x", "float X")),
            "a.ply: header: the vertices have no properties x, y and z");
  EXPECT_EQ(error("a.ply", replaced(text, "vertex_indices", "corners")),
            "a.ply: header: the faces have no list vertex_indices");
  EXPECT_EQ(error("a.ply", replaced(text, "element face", "elment face")),
            "a.ply: header: bad line 'elment face 6'");
  EXPECT_EQ(error("a.ply", replaced(text, "9.000000", "9,0")),
            "a.ply: line 11: '9,0' is not a number: write a decimal point");
}

/// glTF 2.0, 3.12: a file that requires what a reader does not know is refused.
TEST_F(ReadMesh, GltfThatRequiresAnUnknownExtension_IsRefused) {
  folder_.write("cube.bin", gltfBuffer(cube()));
  const auto with = [&](const std::string& name) {
    std::string json = gltf(cube(), kOneNode, R"("uri":"cube.bin",)");
    json.insert(1,
                R"("extensionsUsed":[")" + name + R"("],"extensionsRequired":[")" + name + "\"],");
    EXPECT_EQ(error("a.gltf", json, ""),
              replaced(error("a.glb", glbFile(json, ""), ""), ".glb", ".gltf"))
        << name;
    return error("a.gltf", json, "");
  };
  const std::string uncompressed = "is not read: export the mesh without compression";
  const std::pair<const char*, std::string> refusals[] = {
      {"EXT_mesh_gpu_instancing", "is not read: export each instance as a node of its own"},
      {"KHR_node_visibility", "is not read: export the visible nodes alone, without the extension"},
      {"KHR_draco_mesh_compression", uncompressed},
      {"EXT_meshopt_compression", uncompressed},
      {"VENDOR_new", "is not known and may change the geometry: export the mesh without it"}};
  for (const auto& [name, refusal] : refusals)
    EXPECT_EQ(with(name), "a.gltf: extensionsRequired[0]: '" + std::string(name) + "' " + refusal);
}

/// KHR_mesh_quantization allows positions of other types than float, and others than positions.
TEST_F(ReadMesh, GltfThatRequiresExtensionsWithoutGeometry_IsRead) {
  const std::string buffer = gltfBuffer(cube());
  for (const char* name :
       {"KHR_mesh_quantization", "KHR_texture_transform", "KHR_materials_unlit",
        "KHR_lights_punctual", "EXT_texture_webp", "KHR_texture_basisu", "EXT_mesh_features",
        "EXT_structural_metadata", "ADOBE_materials_thin_transparency", "FB_ngon_encoding",
        "CESIUM_primitive_outline", "MSFT_lod", "KHR_interactivity", "KHR_physics_rigid_bodies"}) {
    std::string json = gltf(cube(), kOneNode, "");
    json.insert(1, R"("extensionsRequired":[")" + std::string(name) + "\"],");
    const std::string bytes = glbFile(json, glbChunk(std::string("BIN\0", 4), buffer));
    ASSERT_EQ(error("a.glb", bytes, ""), "(nothing)") << name;
    expectCube(read("a.glb", bytes, ""));
  }
}

TEST_F(ReadMesh, GltfPositionsThatAreQuantizedOrCompressed_AreRefused) {
  std::string json = gltf(cube(), kOneNode, "");
  EXPECT_EQ(error("a.gltf", replaced(json, "5126", "5122"), ""),
            "a.gltf: accessors[0].componentType: is not float (5126): export the mesh without "
            "KHR_mesh_quantization");
  EXPECT_EQ(error("a.gltf", replaced(json, R"({"bufferView":0,)", "{"), ""),
            "a.gltf: accessors[0].bufferView: is missing: export the mesh without compression");
  json.insert(json.find(R"({"buffer":0)") + 1,
              R"("extensions":{"EXT_meshopt_compression":{"buffer":0}},)");
  EXPECT_EQ(error("a.gltf", json, ""),
            "a.gltf: bufferViews[0].extensions.EXT_meshopt_compression: is not read: export the "
            "mesh without compression");
}

/// What an optional extension, or the scene, changes about the geometry.
TEST_F(ReadMesh, GltfPartsThatAreNotReadAsTheFileMeans_AreNoted) {
  const auto notes = [&](const std::string& nodes) {
    return read("a.glb", glb(cube(), nodes), "").info.notes();
  };
  using ::testing::ElementsAre;
  using ::testing::IsEmpty;
  EXPECT_THAT(notes(kOneNode), IsEmpty());
  EXPECT_THAT(
      notes(R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}}}])"),
      ElementsAre("1 node with instances (EXT_mesh_gpu_instancing): only one instance was read"));
  EXPECT_THAT(notes(R"([{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}}])"),
              ElementsAre("1 hidden node: read as visible"));
  EXPECT_THAT(notes(R"([{"mesh":0,"skin":0}])"),
              ElementsAre("1 node with a skin: read without its deformation"));
  std::string json = gltf(cube(), kOneNode, "");
  json.insert(json.find("\"indices\""), R"("targets":[{"POSITION":0}],)");
  const std::string second = json.substr(json.find("{\"primitives\""));
  json.insert(json.find("{\"primitives\""), second.substr(0, second.find("}]}") + 3) + ",");
  const std::string bytes = glbFile(json, glbChunk(std::string("BIN\0", 4), gltfBuffer(cube())));
  EXPECT_THAT(read("a.glb", bytes, "").info.notes(),
              ElementsAre("1 mesh part with morph targets: read without them",
                          "1 mesh part outside of the scene: left out"));
  json.replace(json.find("\"nodes\":[0]"), 11, "\"nodes\":[]");
  EXPECT_EQ(error("a.glb", glbFile(json, ""), ""),
            "a.glb: scene: shows no mesh: export the mesh with a scene");
}

/// A double PLY as of a survey; single precision steps by 0.5 mm at 5 km.
TEST_F(ReadMesh, MeshFarFromItsOrigin_IsNotedOrRefused) {
  const auto at = [&](double offset_m) {
    PolygonMesh mesh = cube();
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = 0.05F * vertex + Eigen::Vector3f(static_cast<float>(offset_m), 0.0F, 0.0F);
    return mesh;
  };
  EXPECT_TRUE(read("near.ply", binaryPly(at(100.0), false)).info.notes().empty());
  EXPECT_THAT(read("noted.ply", binaryPly(at(1000.0), false)).info.notes(),
              ::testing::ElementsAre("the mesh is 1000 m from the origin, where coordinates are "
                                     "rounded to 0.06104 mm: move the origin to the mesh"));
  const std::string refusal =
      ": vertices: the mesh is 5000 m from the origin, where coordinates are rounded to 0.4883 mm: "
      "move the origin to the mesh";
  EXPECT_EQ(error("far.ply", binaryPly(at(5000.0), false)), "far.ply" + refusal);
  EXPECT_EQ(error("far.obj", obj(at(5000.0))), "far.obj" + refusal);
  EXPECT_EQ(error("far.stl", asciiStl(at(5000.0))), "far.stl" + refusal);
  const std::string nodes = R"([{"mesh":0,"translation":[5000,0,0],"scale":[0.05,0.05,0.05]}])";
  EXPECT_EQ(error("far.glb", glb(cube(), nodes), ""), "far.glb" + refusal);
  EXPECT_THAT(error("collapsed.ply", binaryPly(at(900'000.0), false)), HasSubstr("rounded to"));
}

/// Wherever a file is cut, it is refused: importers alone would take what is there.
TEST_F(ReadMesh, RefusesEveryTruncation) {
  const std::pair<const char*, std::string> files[] = {
      {"little.ply", binaryPly(cube(), false)},
      {"big.ply", binaryPly(cube(), true)},
      {"ascii.ply", asciiPly(cube())},
      {"binary.stl", binaryStl(cube())},
      {"ascii.stl", asciiStl(cube())},
      {"ascii2.stl", twoSolids()},
      {"mesh.glb", glb(cube())},
      {"strips.ply", stripsPly("binary_little_endian")}};
  for (const auto& [name, content] : files) {
    const bool text = std::string(name).starts_with("ascii");
    // A text without its last line break, or without the name of the solid, is still whole.
    const std::size_t last = content.size() - (text ? 8 : 1);
    for (std::size_t size = 1; size <= last; size += 1 + content.size() / 211) {
      const std::string cut = content.substr(0, size);
      if (cut.substr(std::min(cut.rfind('\n', size - 2) + 1, size)).starts_with("endsolid"))
        continue;  // between two solids nothing shows that one follows
      ASSERT_NE(error(name, cut), "(nothing)") << name << " cut to " << size;
    }
    EXPECT_NE(error(name, content.substr(0, last)), "(nothing)") << name;
  }
  EXPECT_EQ(error("cut.ply", binaryPly(cube(), false).substr(0, 300)),
            "cut.ply: the PLY mesh is truncated");
  const std::string buffer = gltfBuffer(cube());
  const std::string json = gltf(cube(), kOneNode, R"("uri":"cut.bin",)");
  for (std::size_t size = 1; size < buffer.size(); size += 3) {
    folder_.write("cut.bin", buffer.substr(0, size));
    ASSERT_NE(error("cut.gltf", json, ""), "(nothing)") << size;
  }
  folder_.write("cut.bin", buffer);
  for (std::size_t size = 1; size < json.size(); size += 7)
    ASSERT_NE(error("cut.gltf", json.substr(0, size), ""), "(nothing)") << size;
}

/// Of an OBJ only a last line without its end shows that it is cut.
TEST_F(ReadMesh, ObjCutWithinALine_IsRefusedOrNoted) {
  const std::string text = obj(cube());
  for (std::size_t size = 1; size < text.size(); ++size) {
    if (text[size - 1] == '\n') continue;
    const std::string cut = text.substr(0, size);
    if (error("cut.obj", cut) != "(nothing)") continue;
    EXPECT_THAT(read("cut.obj", cut).info.notes(),
                ::testing::Contains(HasSubstr("the file may be truncated")))
        << size;
  }
}

TEST_F(ReadMesh, RefusesOtherFiles) {
  EXPECT_EQ(folder_.message([&] { (void)readMesh(folder_ / "none.ply", "m"); }),
            "none.ply: no such file");
  EXPECT_EQ(error("empty.ply", ""), "empty.ply: the file is empty");
  EXPECT_EQ(error("mesh.step", "ISO-10303-21;"),
            "mesh.step: unknown mesh format '.step' (ply, obj, stl, gltf, glb)");
  EXPECT_EQ(error("mesh", "x"), "mesh: unknown mesh format '' (ply, obj, stl, gltf, glb)");
  // A file whose format's own importer does not know it is not offered to the others.
  const std::string collada =
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
      R"(version="1.4.1"><library_visual_scenes><visual_scene id="s"><node id="n"/>)"
      R"(</visual_scene></library_visual_scenes></COLLADA>)";
  for (const char* name : {"mesh.ply", "mesh.obj", "mesh.stl", "mesh.gltf", "mesh.glb"})
    for (const std::string& other :
         {std::string("\x89PNG\r\n\x1a\n nothing of the kind"), std::string(500, '\0'), collada})
      EXPECT_THAT(error(name, other), StartsWith(name)) << name;
}

/// A count that leaves data over would drop faces without a word.
TEST_F(ReadMesh, RefusesCountsThatTheFileContradicts) {
  const auto with = [](std::string content, const std::string& count) {
    return content.replace(content.find("face 6") + 5, 1, count);
  };
  EXPECT_EQ(error("a.ply", with(asciiPly(cube()), "5")),
            "a.ply: header: declares vertex 8, face 5, but 11 more bytes follow these elements");
  for (const bool big_endian : {false, true})
    EXPECT_EQ(error("b.ply", with(binaryPly(cube(), big_endian), "5")),
              "b.ply: header: declares vertex 8, face 5, but 17 more bytes follow these elements");
  for (const char* count : {"5.5", "6.0", "1e9", "0x6", "-6", "", "six"})
    for (const std::string& content : {asciiPly(cube()), binaryPly(cube(), false)}) {
      EXPECT_THAT(error("c.ply", with(content, count)),
                  AllOf(StartsWith("c.ply: header: bad line 'element face"),
                        HasSubstr(std::string("'") + count + "' is not a whole number")))
          << count;
    }
  EXPECT_THAT(
      error("d.ply", asciiPly(cube()).replace(asciiPly(cube()).rfind("\n4 ") + 1, 1, "4.0")),
      HasSubstr("d.ply: face 5: '4.0' is not the length of a list"));
  expectCube(read("e.ply", asciiPly(cube()) + " \r\n\n"));
  expectCube(read("f.ply", binaryPly(cube(), false) + "\n"));
  std::string stl = binaryStl(cube());
  stl[80] = 11;
  EXPECT_EQ(error("g.stl", stl),
            "g.stl: header: declares 11 facets, but 50 more bytes follow them");
}

TEST_F(ReadMesh, RefusesHugeDeclarationsBeforeReading) {
  EXPECT_EQ(error("mesh.ply", plyHeader("ascii", 5000000, 1) + std::string(10000100, '\n')),
            "mesh.ply: the PLY mesh is truncated");
  EXPECT_THAT(error("mesh.ply", plyHeader("binary_little_endian", 4000000000u, 4000000000u)),
              HasSubstr("too many items"));
  PolygonMesh mesh = cube();
  mesh.polygons.assign(1000001, {0, 1, 2});
  EXPECT_EQ(error("mesh.ply", binaryPly(mesh, false)),
            "mesh.ply: faces: 1000001 exceed the limit of 1000000: decimate the mesh");
}

/// A lost vertex would shift the indices of all later ones.
TEST_F(ReadMesh, ObjVertices_AreTheirThreeCoordinatesHoweverTheyAreWritten) {
  const auto extent_m = [&](const std::string& vertices) {
    const auto file = folder_.write("mesh.obj", vertices + "f 1 3 4\nf 1 3 5\n");
    const Mesh mesh = readMesh(file, "m");
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& vertex : mesh.vertices_m) box.extend(vertex);
    return box.sizes().maxCoeff();
  };
  const std::string plain = "v 0 0 0\nv 0.1 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nv 9 9 9\n";
  EXPECT_FLOAT_EQ(extent_m(plain), 0.1F);
  for (const char* second : {"v .1 0 0", "v +.1 -.0 0", "v 0.1 0 0 0.5", "v 0.1 0 0 .5 .2 1",
                             "v 0.1 0 0 1 1", "v 0.1 0 0 1 0 0 1"}) {
    std::string written = plain;
    written.replace(written.find("v 0.1 0 0"), 9, second);
    EXPECT_FLOAT_EQ(extent_m(written), 0.1F) << second;
  }
}

/// Normals and texture coordinates are not used, whatever they hold.
TEST_F(ReadMesh, ObjFacesAndFurtherLines_AreReadHoweverTheyAreWritten) {
  const std::string text = obj(cube());
  const std::size_t face = text.find("f ");
  const auto corners = [&](const std::string& begin, const std::string& end) {
    std::string changed = text.substr(0, face);
    for (const auto& quad : cube().polygons) {
      changed += "f";
      for (const std::int32_t index : quad)
        changed += " " + begin + std::to_string(index + 1) + end;
      changed += "\n";
    }
    return changed;
  };
  for (const char* line : {"vt .5 .5", "vn .6 .8 0", "vt .5", "vn nan nan nan", "vt 1,5 2,5",
                           "vn -1.#IND 0 0", "vp .1", "s off", "usemtl .5", "o f 1", "g"})
    expectCube(read("line.obj", std::string(text).insert(face, std::string(line) + "\n")));
  for (const auto& [begin, end] : std::vector<std::pair<std::string, std::string>>{
           {"+", ""}, {"+", "/+1"}, {"", "/1/1"}, {"", "//1"}, {"", "/"}, {"0", "//"}})
    expectCube(read("corners.obj", corners(begin, end)));
  expectCube(read("fo.obj", replaced(text, "f ", "fo ")));
  expectCube(read("dots.obj", replaced(text, ".000000", ".")));
  expectCube(read("signs.obj", replaced(replaced(text, " 1.0", " +1.0"), ".000000", ".E+00")));
  expectCube(read("fortran.obj", replaced(text, "11.000000", "1.1D+01")));
  EXPECT_TRUE(read("fo.obj", replaced(text, "f ", "fo ")).info.notes().empty());
}

/// DOS ended texts with Ctrl-Z; some programs fill a file's last block with zeros.
TEST_F(ReadMesh, TextsPaddedBehindTheirEnd_AreRead) {
  const std::string mark = "\x1a";
  folder_.write("cube.bin", gltfBuffer(cube()));
  const std::string json = gltf(cube(), kOneNode, R"("uri":"cube.bin",)");
  const std::string in_glb = gltf(cube(), kOneNode, "");
  for (const std::string& padding : {mark, mark + "\r\n", std::string(100, '\0'), mark + mark}) {
    expectCube(read("padded.gltf", json + padding, ""));
    expectCube(
        read("padded.glb",
             glbFile(in_glb + padding, glbChunk(std::string("BIN\0", 4), gltfBuffer(cube()))), ""));
    expectCube(read("padded.stl", asciiStl(cube()) + padding));
    expectCube(read("padded.obj", obj(cube()) + padding));
    const Mesh ply = read("padded.ply", asciiPly(cube()) + padding);
    expectCube(ply);
    EXPECT_TRUE(ply.info.notes().empty());
  }
  EXPECT_EQ(error("a.ply", asciiPly(cube()).substr(0, 400) + std::string(100, '\0')),
            "a.ply: the PLY mesh is truncated");
}

/// As other programs write numbers that they could not compute.
TEST_F(ReadMesh, AsciiPly_NotFiniteIsReadInOtherPropertiesAndRefusedInCoordinates) {
  const std::string text = asciiPly(cube());
  const std::string z = "property float z\n";
  const std::string with_quality = replaced(text, z, z + "property float quality\n");
  for (const char* value : {"nan", "-nan(ind)", "1.#IND", "-1.#QNAN0", "inf", "-1.#INF"}) {
    std::string ply = with_quality;
    for (const char* end : {" 9.000000\n", " 11.000000\n"})
      ply = replaced(ply, end,
                     std::string(end).substr(0, std::string(end).size() - 1) + " " + value + "\n");
    expectCube(read("a.ply", ply));
    EXPECT_EQ(error("a.ply", replaced(text, " 11.000000", std::string(" ") + value)),
              std::string("a.ply: line 15: '") + value + "' is not a finite number");
  }
}

TEST_F(ReadMesh, AsciiPly_NumbersAreReadHoweverTheyAreWritten) {
  const std::string text = asciiPly(cube());
  expectCube(read("dots.ply", replaced(text, ".000000", ".")));
  expectCube(read("signs.ply", replaced(replaced(text, " 1.0", " +1.0"), ".000000", ".E+00")));
  expectCube(read("fortran.ply", replaced(text, "11.000000", "1.1D+01")));
  expectCube(read("lengths.ply", replaced(text, "\n4 ", "\n+4 ")));
  PolygonMesh small = cube();
  for (Eigen::Vector3f& vertex : small.vertices) vertex *= 0.5F;
  expectCube(read("half.ply", replaced(replaced(asciiPly(small), " 0.5", " .5"), "-0.5", "-.5")),
             0.5);
}

/// Programs of old Macs end lines with CR alone; a binary body may begin with a byte of LF.
TEST_F(ReadMesh, PlyWithLinesThatEndInCrAlone_IsRead) {
  expectCube(read("a.ply", replaced(asciiPly(cube()), "\n", "\r")));
  PolygonMesh mesh = cube();
  for (const float x : {-1.0F, -0.16F})
    for (const bool big_endian : {false, true}) {
      mesh.vertices[0].x() = x;
      const std::string ply = binaryPly(mesh, big_endian);
      const std::size_t body = ply.find("end_header\n") + 11;
      const Mesh result =
          read("b.ply", replaced(ply.substr(0, body), "\n", "\r") + ply.substr(body));
      EXPECT_THAT(result.vertices_m, ::testing::UnorderedElementsAreArray(mesh.vertices));
    }
}

TEST_F(ReadMesh, Gltf1_IsNamed) {
  const std::string json =
      R"({"asset":{"version":"1.0"},"accessors":{"a":{}},"meshes":{"m":{"primitives":[]}}})";
  EXPECT_EQ(error("a.gltf", json, ""), "a.gltf: is glTF 1.0: export the mesh as glTF 2.0");
  EXPECT_EQ(error("a.glb", glbFile(json, ""), ""),
            "a.glb: is glTF 1.0: export the mesh as glTF 2.0");
}

TEST_F(ReadMesh, Utf16WithoutMark_IsNamed) {
  for (const std::string& text : {obj(cube()), asciiPly(cube())})
    for (const bool big_endian : {false, true}) {
      std::string wide;
      for (const char c : text) wide += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
      const char* name = text.starts_with("ply") ? "a.ply" : "a.obj";
      EXPECT_EQ(error(name, wide),
                std::string(name) + ": is UTF-16 or UTF-32 text: save it as UTF-8");
    }
}

}  // namespace
}  // namespace boresight::sessions
