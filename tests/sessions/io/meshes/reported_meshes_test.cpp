// SPDX-License-Identifier: Apache-2.0
// Meshes as exporters, surveyors and scanners write them: files that users of other readers
// reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "sessions/io/meshes/mesh_file.h"
#include "tests/sessions/io/meshes/expect_cube.h"
#include "tests/sessions/io/meshes/mesh_samples.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using namespace boresight::test;  // NOLINT: the samples are this file's vocabulary
using ::testing::HasSubstr;

class ReportedMesh : public ::testing::Test {
 protected:
  Mesh read(const std::string& name, const std::string& content, const std::string& unit = "m") {
    return readMesh(folder_.write(name, content), unit);
  }
  std::string error(const std::string& name, const std::string& content) {
    return folder_.message([&] { (void)read(name, content); });
  }
  TemporaryFolder folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// The header with the ends of lines of another system, the bytes behind it as they are.
std::string withHeaderEnds(const std::string& ply, const std::string& end) {
  const std::size_t body = ply.find("end_header\n") + 11;
  return replaced(ply.substr(0, body), "\n", end) + ply.substr(body);
}

TEST_F(ReportedMesh, BinaryPlyWhoseHeaderEndsItsLinesInCrLf_IsRead) {
  for (const bool big_endian : {false, true})
    expectCube(read("crlf.ply", withHeaderEnds(binaryPly(cube(), big_endian), "\r\n")));
}

/// Doubles, a name of the list of other programs, colours with alpha, coordinates of a texture
/// behind each face.
TEST_F(ReportedMesh, AsciiPlyWithFurtherProperties_IsRead) {
  const PolygonMesh mesh = cube();
  std::string text =
      "ply\nformat ascii 1.0\nobj_info num_cols 512\ncomment TextureFile a.png\n"
      "element vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
      "element face 6\nproperty list uchar int vertex_index\n"
      "property list uchar float texcoord\nend_header\n";
  for (const Eigen::Vector3f& v : mesh.vertices)
    text += std::to_string(double{v.x()}) + " " + std::to_string(double{v.y()}) + " " +
            std::to_string(double{v.z()}) + " 10 20 30 255\n";
  for (const auto& quad : mesh.polygons) {
    text += "4";
    for (const std::int32_t index : quad) text += " " + std::to_string(index);
    text += " 8 0 0 1 0 1 1 0 1\n";
  }
  expectCube(read("further.ply", text));
}

TEST_F(ReportedMesh, ColouredPointsWithoutFaces_AreRefused) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n";
  EXPECT_THAT(error("points.ply", header + "0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n0 0 1 1 2 3\n"),
              HasSubstr("the mesh has no faces"));
}

TEST_F(ReportedMesh, CoordinatesDeclaredInAnotherOrder_AreReadByTheirNames) {
  std::string text = asciiPly(cube());
  const std::size_t body = text.find("end_header\n") + 11;
  std::string turned = replaced(text.substr(0, body), "float x", "float w");
  turned = replaced(turned, "float z", "float x");
  turned = replaced(turned, "float w", "float z");
  for (const Eigen::Vector3f& v : cube().vertices)
    turned +=
        std::to_string(v.z()) + " " + std::to_string(v.y()) + " " + std::to_string(v.x()) + "\n";
  std::size_t faces = body;
  for (int line = 0; line < 8; ++line) faces = text.find('\n', faces) + 1;
  expectCube(read("turned.ply", turned + text.substr(faces)));
}

TEST_F(ReportedMesh, UnusedVertexThatIsNotANumber_IsNamed) {
  PolygonMesh mesh = cube();
  mesh.vertices.emplace_back(0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F);
  EXPECT_EQ(error("unused.ply", binaryPly(mesh, false)),
            "unused.ply: vertex 8: not a finite number");
}

TEST_F(ReportedMesh, BinaryStlWhoseHeaderBeginsWithSolid_IsRead) {
  expectCube(read("solid.stl", binaryStl(cube(), "solid exported by a program")));
}

/// Ends of lines in CR LF, indices from the end, a fourth coordinate, a material file that is not
/// there.
TEST_F(ReportedMesh, ObjOfOtherSystems_IsRead) {
  const PolygonMesh mesh = cube();
  std::string text = "mtllib none.mtl\r\no cube\r\n";
  for (const Eigen::Vector3f& v : mesh.vertices)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + " 1.0\r\n";
  text += "usemtl steel\r\ns off\r\n";
  for (const auto& quad : mesh.polygons) {
    text += "f";
    for (const std::int32_t index : quad) text += " " + std::to_string(index - 8);
    text += "\r\n";
  }
  expectCube(read("other.obj", text));
}

TEST_F(ReportedMesh, CoordinatesOfASurveyFarFromTheOrigin_AreRefused) {
  std::string text = replaced(asciiPly(cube()), "float", "double");
  text = replaced(text, "9.000000\n", "5200009.125\n");
  EXPECT_THAT(error("survey.ply", text), HasSubstr("more than 1000 km from the origin"));
}

/// Three nested nodes: scaled unequally, mirrored, turned and moved.
TEST_F(ReportedMesh, GltfWithScaledMirroredNestedNodes_HasItsExtentAndPlace) {
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
  EXPECT_NEAR(signedVolume_m3(mesh), 48.0, 1e-3);
}

}  // namespace
}  // namespace boresight::sessions
