// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/scene_mesh.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "sessions/io/files/errors.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/sessions/io/meshes/mesh_samples.h"

namespace boresight::sessions {
namespace {

class SceneMeshTest : public FolderTest {
 protected:
  void SetUp() override {
    folder_.write("cube.ply", test::binaryPly(test::cube(), false));
    cube_ = readMesh(folder_ / "cube.ply", "m");
    part_.mesh = folder_ / "cube.ply";
    part_.mesh_unit = "m";
  }
  static Pose turned(double angle_rad, const Eigen::Vector3d& translation_m) {
    return {rotationExp(Eigen::Vector3d(0, 0, angle_rad)), translation_m};
  }
  std::string refusal(const std::vector<PartSource>& parts) const {
    return folder_.message([&] { (void)readScene(parts); });
  }
  Mesh cube_;
  PartSource part_;  ///< the cube in metres
};

TEST_F(SceneMeshTest, Parts_ArePlacedByTheirTransforms) {
  SceneMesh scene;
  ScenePart matched, occluder;
  matched.depth_threshold_m = 0.001;
  occluder.match = false;
  addPart(scene, cube_, Pose(), matched);
  addPart(scene, cube_, turned(std::numbers::pi / 2, Eigen::Vector3d(100, 0, 0)), occluder);
  const MeshView view = scene.view();
  EXPECT_EQ(validateMesh(view), Status::kOk);
  ASSERT_EQ(view.vertices_in_station_m.size(), 16u);
  ASSERT_EQ(view.faces.size(), 24u);
  EXPECT_EQ(view.parts[0].depth_threshold_m, 0.001);
  EXPECT_FALSE(view.parts[1].match);
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3f& v = cube_.vertices_m[i];
    EXPECT_TRUE(scene.vertices_in_station_m[8 + i].isApprox(
        Eigen::Vector3f(100.0F - v.y(), v.x(), v.z()), 1e-6F));
  }
  for (std::size_t f = 0; f < 12; ++f) {
    EXPECT_EQ(view.part_of_face[f], 0);
    EXPECT_EQ(view.part_of_face[12 + f], 1);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(view.faces[12 + f].vertex[i], cube_.faces[f].vertex[i] + 8);
  }
  EXPECT_EQ(matchedVertices(view), cube_.vertices_m) << "placed without a transform";
  EXPECT_NEAR(matchedBounds(view).maximum_m.x(), 1.0, 1e-6);
}

/// Vertices are stored in single precision, in STATION too.
TEST_F(SceneMeshTest, PartFarFromTheStationsOrigin_IsRefused) {
  part_.mesh_unit = "cm";
  part_.frame_from_mesh.translation_m.x() = 100.0;
  EXPECT_EQ(refusal({part_}), "(nothing)");
  part_.frame_from_mesh.translation_m.x() = 5000.0;
  EXPECT_EQ(refusal({part_}),
            "cube.ply: vertices: the mesh is 5000 m from the origin, where coordinates are rounded "
            "to 0.4883 mm: move the origin to the mesh");
}

TEST_F(SceneMeshTest, ReadsPartsFromFiles) {
  part_.mesh_unit = "cm";
  const SceneMesh scene = readScene(std::vector{part_});
  EXPECT_EQ(scene.faces.size(), 12u);
  EXPECT_EQ(scene.infos.at(0).unit, "cm");
  part_.state.role = PartRole::kOccludes;
  EXPECT_EQ(refusal({part_}), "cube.ply: role: no part of the station is matched");
  EXPECT_THROW((void)readScene({}), InputError);
  part_.mesh = folder_ / "none.ply";
  EXPECT_EQ(refusal({part_}), "none.ply: no such file");
}

TEST_F(SceneMeshTest, PartsFixedToTheCamera_ComeLast) {
  PartSource station = part_;
  station.albedo = 0.25;
  PartSource gripper = station;
  gripper.frame = kCameraFrame;
  gripper.frame_from_mesh.translation_m.z() = 0.5;
  gripper.state.role = PartRole::kOccludes;
  std::vector<std::size_t> checked;
  const SceneMesh scene =
      readScene(std::vector{gripper, station}, {},
                [&](std::size_t part, const std::string&) { checked.push_back(part); });
  EXPECT_EQ(checked, (std::vector<std::size_t>{1, 0}));
  const MeshView view = scene.view();
  ASSERT_EQ(validateMesh(view), Status::kOk);
  EXPECT_TRUE(view.parts[0].match && view.parts[1].fixed_to_camera);
  EXPECT_EQ(scene.albedo_of_part, (std::vector{0.25, 0.25}));
  EXPECT_EQ(firstVertexInCamera(view), 8u);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_EQ(view.vertices_in_station_m[8 + i],
              Eigen::Vector3f(cube_.vertices_m[i] + Eigen::Vector3f(0, 0, 0.5F)));
  EXPECT_EQ(matchedVertices(view).size(), 8u);
  const MeshView still = stationView(scene);
  EXPECT_EQ(still.vertices_in_station_m.size(), 8u);
  EXPECT_EQ(still.faces.size(), 12u);
  EXPECT_EQ(validateMesh(still), Status::kOk);
}

TEST_F(SceneMeshTest, PartsThatAreNotUsed_AreNotRead) {
  PartSource station = part_, missing = part_;
  missing.mesh = folder_ / "none.ply";
  for (const PartState& state :
       {PartState{PartRole::kMatched, false}, PartState{PartRole::kIgnored, true}}) {
    missing.state = state;
    EXPECT_EQ(readScene(std::vector{missing, station}).parts.size(), 1u);
  }
  station.state.present = false;
  EXPECT_EQ(refusal({station, missing}), "cube.ply: role: no part of the station is matched");
}

TEST_F(SceneMeshTest, SuspectsAWrongUnit) {
  // A station 0.4 m away, 0.3 m across: as it is, in millimetres taken for metres, the reverse.
  const Pose seed = turned(0.1, Eigen::Vector3d(0.01, 0.02, 0.4));
  const auto concern = [&seed](double scale) {
    return scaleConcern(
        {scale * Eigen::Vector3d(-0.1, -0.1, 0.0), scale * Eigen::Vector3d(0.1, 0.1, 0.1)}, seed);
  };
  EXPECT_EQ(concern(1.0), "");
  EXPECT_EQ(concern(1000.0),
            "the mesh measures 300 m across, but the seed's camera is 400.6 mm away");
  EXPECT_EQ(concern(0.001),
            "the mesh measures 0.3 mm across, but the seed's camera is 400.6 mm away");
  // A camera inside a hall, and one whose frame is the station's.
  EXPECT_EQ(concern(50.0), "");
  EXPECT_EQ(scaleConcern({{-0.1, -0.1, 0.3}, {0.1, 0.1, 0.5}}, Pose()), "");
}

TEST_F(SceneMeshTest, NamesTheFileOfAWrongUnit) {
  Mesh large = cube_;
  for (Eigen::Vector3f& vertex : large.vertices_m) vertex *= 100.0F;
  const auto message = [&](double z_m) {
    SceneMesh scene;
    addPart(scene, large, Pose(), ScenePart());
    return folder_.message(
        [&] { requirePlausibleScale(scene, turned(0.0, Eigen::Vector3d(0, 0, z_m))); });
  };
  EXPECT_EQ(message(0.4), "(nothing)") << "the camera is 900 m from the box";
  EXPECT_EQ(message(-900.5), "(nothing)");
  for (Eigen::Vector3f& vertex : large.vertices_m) vertex.z() -= 1000.0F;
  EXPECT_EQ(message(0.4),
            "cube.ply: mesh_unit: the mesh measures 346.4 m across, but the seed's camera is 400 "
            "mm away (unit 'm'): check the unit");
}

}  // namespace
}  // namespace boresight::sessions
