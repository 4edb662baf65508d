// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cahv_camera.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sessions/io/json_writer.h"
#include "sessions/io/pose_file.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::PlanetaryCamera;
using boresight::test::planetaryCameras;
using boresight::test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// As a person would write it, from the vectors themselves.
nlohmann::ordered_json written(const PlanetaryCamera& camera) {
  const CahvModel& cahv = camera.cahv;
  nlohmann::ordered_json json = {{"format", "boresight-camera"}, {"version", 1}};
  json["model"] = cameraModelName(cahv.model);
  json["width"] = camera.width;
  json["height"] = camera.height;
  json["C"] = toJson(cahv.c_m);
  json["A"] = toJson(cahv.a);
  json["H"] = toJson(cahv.h_px);
  json["V"] = toJson(cahv.v_px);
  if (cahv.model != CameraModel::kCahv) {
    json["O"] = toJson(cahv.o);
    json["R"] = toJson(cahv.r);
  }
  if (cahv.model == CameraModel::kCahvore) {
    json["E"] = toJson(cahv.e_m);
    json["cahvore_type"] = cahv.type;
    json["cahvore_parameter"] = cahv.parameter;
  }
  json["reference_frame"] = {{"name", "ROVER_NAV_FRAME"}, {"index", {14, 1262, 6}}};
  return json;
}

class CahvCamera : public ::testing::TestWithParam<PlanetaryCamera> {
 protected:
  CameraFile read(const nlohmann::ordered_json& json) {
    return readCameraFile(folder_.write("camera.json", json.dump()));
  }
  std::string error(const nlohmann::ordered_json& json) {
    return folder_.message([&] { (void)read(json); });
  }
  /// Places of the reference's points in the image, in px; `shift` by a subframe.
  void expectSights(const CameraFile& file, const Eigen::Vector2d& first = {0.0, 0.0},
                    double scale = 1.0) {
    ASSERT_TRUE(file.reference);
    for (const PlanetaryCamera::Sight& sight : GetParam().sights) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(
          project(file.camera, file.reference->camera_from_reference * sight.point_m, pixel));
      const Eigen::Vector2d half(0.5, 0.5);
      EXPECT_LT((pixel - ((sight.pixel - first + half) / scale - half)).norm(), 1e-8);
    }
  }
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Cahv, CahvCamera, ::testing::ValuesIn(planetaryCameras()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(CahvCamera, ProjectsAsItsVectorsSay) {
  const CameraFile file = read(written(GetParam()));
  expectSights(file);
  EXPECT_EQ(file.reference->frame.name, "ROVER_NAV_FRAME");
  EXPECT_EQ(file.reference->frame.index, (std::vector<std::int64_t>{14, 1262, 6}));
}

TEST_P(CahvCamera, WritesItsVectorsInTheReferenceFrame) {
  writeCamera(folder_ / "again.json", read(written(GetParam())));
  const CameraFile again = readCameraFile(folder_ / "again.json");
  expectSights(again);
  EXPECT_EQ(again.reference->frame.name, "ROVER_NAV_FRAME");
  EXPECT_EQ(again.reference->frame.index, (std::vector<std::int64_t>{14, 1262, 6}));
}

TEST_P(CahvCamera, AloneComesBackBitForBit) {
  const Camera camera = read(written(GetParam())).camera;
  writeCamera(folder_ / "own.json", camera);
  const CameraFile own = readCameraFile(folder_ / "own.json");
  EXPECT_EQ(own.camera, camera);
  EXPECT_EQ(own.reference->frame.name, "CAMERA");
  EXPECT_EQ(own.reference->camera_from_reference, Pose());
}

TEST_P(CahvCamera, OfASubframeSeesTheSamePoints) {
  nlohmann::ordered_json json = written(GetParam());
  json["width"] = 320;
  json["height"] = 240;
  json["subframe"] = {{"first_sample", 200}, {"first_line", 120}, {"scale", 2}};
  expectSights(read(json), {200.0, 120.0}, 2.0);
}

TEST_P(CahvCamera, PlacesAPoseOfItsReferenceFrame) {
  const CameraFile file = read(written(GetParam()));
  const auto pose_file = folder_.write(
      "seed.json", R"({"format": "boresight-pose", "version": 1, "reference_from_station":
                   [[0,-1,0,2],[1,0,0,3],[0,0,1,-4],[0,0,0,1]]})");
  const Pose pose = readPose(pose_file, {file.reference}).camera_from_station;
  const Eigen::Vector3d expected =
      file.reference->camera_from_reference * Eigen::Vector3d(2.0 - 0.5, 3.0 + 0.25, -4.0 + 1.0);
  EXPECT_LT((pose * Eigen::Vector3d(0.25, 0.5, 1.0) - expected).norm(), 1e-14);
}

TEST_P(CahvCamera, NamesWhatIsWrong) {
  const nlohmann::ordered_json good = written(GetParam());
  for (const char* key : {"C", "A", "H", "V"}) {
    nlohmann::ordered_json json = good;
    json.erase(key);
    EXPECT_EQ(error(json), std::string("camera.json: ") + key + ": missing");
    json[key] = {1.0, 2.0};
    EXPECT_THAT(error(json), StartsWith(std::string("camera.json: ") + key));
  }
  nlohmann::ordered_json json = good;
  json["A"] = {1.0, 1.0, 1.0};
  EXPECT_THAT(error(json), HasSubstr("A and O must have length 1"));
  json = good;
  json["fx"] = 1000.0;
  EXPECT_THAT(error(json), StartsWith("camera.json: fx: a cahv"));
  json = good;
  json["subframe"] = {{"scale", 0}};
  EXPECT_THAT(error(json), StartsWith("camera.json: subframe.scale: 0 is outside"));
  json = good;
  json["reference_frame"] = {{"name", ""}};
  EXPECT_THAT(error(json), StartsWith("camera.json: reference_frame.name"));
  if (GetParam().cahv.model != CameraModel::kCahvore) return;
  json = good;
  json["cahvore_type"] = 4;
  EXPECT_EQ(error(json), "camera.json: cahvore_type: 4 is outside 1 .. 3");
}

}  // namespace
}  // namespace boresight::sessions
