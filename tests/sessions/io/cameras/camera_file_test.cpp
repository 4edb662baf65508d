// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/images/camera_of_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include <nlohmann/json.hpp>

#include "core/base/random.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_writer.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::PlanetaryCamera;

using OrderedJson = nlohmann::ordered_json;

std::string cameraText(const std::string& rest) {
  return R"({"format": "boresight-camera", "version": 1, )" + rest + "}";
}

constexpr const char* kSize = R"("width": 2048, "height": 1024, )";
constexpr const char* kFocus = R"("fx": 3100.5, "fy": 3101, "cx": 1023.5, "cy": 511.5)";

class ReadCamera : public FolderTest {
 protected:
  Camera read(const std::string& rest) {
    return readCamera(folder_.write("camera.json", cameraText(rest)));
  }
  std::string error(const std::string& rest) {
    return folder_.message([&] { (void)read(rest); });
  }
};

/// An entry of the public image feed of Mars 2020, against the same vectors in a camera.json.
TEST_F(ReadCamera, ReadsTheMetadataOfARawImage) {
  const std::string start =
      R"x({"imageid": "NRF_0731", "dimension": "(1288,968)", "site": 36, "drive": 1610,)x"
      R"( "subframe_rect": [2545.0, 1.0, 2576.0, 1936.0], "scale_factor": 2,)"
      R"( "camera_model_type": "CAHVORE", "camera_model_component_list": ")";
  const std::string components =
      "(0.57409,0.460145,-1.94506);(-0.811535,0.532626,0.240282);(-824.337,-1223.95,0.351512);"
      "(-496.164,321.169,1666.04);(-0.811482,0.533042,0.23954);(0.000000424,0.0517186,-0.0187155);"
      "(0.000000012,0.00000003,-0.000000003);2;0.0";
  const auto file = folder_.write("metadata.json", start + components + "\"}");
  const CameraFile metadata = readCameraFile(file);
  const Camera written = read(
      R"("model": "cahvore", "width": 1288, "height": 968, "C": [0.57409, 0.460145, -1.94506],)"
      R"( "A": [-0.811535, 0.532626, 0.240282], "H": [-824.337, -1223.95, 0.351512],)"
      R"( "V": [-496.164, 321.169, 1666.04], "O": [-0.811482, 0.533042, 0.23954],)"
      R"( "R": [4.24e-07, 0.0517186, -0.0187155], "E": [1.2e-08, 3e-08, -3e-09],)"
      R"( "cahvore_type": 2, "cahvore_parameter": 0.0)");
  EXPECT_EQ(metadata.camera, written);
  ASSERT_TRUE(metadata.reference);
  EXPECT_EQ(metadata.reference->frame, (FrameName{"ROVER_NAV_FRAME", {36, 1610}}));
  for (const std::string& wrong : {std::string("(1,2)"), std::string("(1,nan)"), components + ";x"})
    EXPECT_THAT(folder_.message([&] {
      (void)readCameraFile(folder_.write("wrong.json", start + wrong + "\"}"));
    }),
                HasSubstr("wrong.json: camera_model_component_list: "));
}

TEST_F(ReadCamera, ReadsEveryModel) {
  Camera expected = test::makePinhole(2048, 1024, 3100.5);
  expected.fy = 3101.0;
  ASSERT_EQ(prepareCamera(expected), Status::kOk);
  EXPECT_EQ(read(std::string(R"("model": "pinhole", )") + kSize + kFocus), expected);

  for (const char* dist : {"[-0.1, 0.05, 0.001, -0.002]", "[-0.1, 0.05, 0.001, -0.002, 0.01]",
                           "[-0.1, 0.05, 0.001, -0.002, 0.01, 0.02, 0.03, 0.04]"}) {
    const Camera brown = read(std::string(R"("model": "brown_conrady", )") + kSize + kFocus +
                              R"(, "dist": )" + dist);
    EXPECT_EQ(brown.model, CameraModel::kBrownConrady);
    EXPECT_EQ(brown.distortion[0], -0.1);
    EXPECT_EQ(brown.distortion[3], -0.002);
    Eigen::Vector2d pixel;
    EXPECT_TRUE(project(brown, Eigen::Vector3d(0.01, 0.02, 1.0), pixel)) << "not prepared";
  }
  const Camera fisheye = read(std::string(R"("model": "kannala_brandt", )") + kSize + kFocus +
                              R"(, "dist": [0.01, 0.002, 0.0003, 0.00004])");
  EXPECT_EQ(fisheye.model, CameraModel::kKannalaBrandt);
  EXPECT_EQ(fisheye.distortion[3], 0.00004);
}

TEST_F(ReadCamera, NamesWhatIsWrong) {
  const std::string whole = std::string(kSize) + kFocus;
  const std::string pinhole = R"("model": "pinhole", )";
  const std::string brown = R"("model": "brown_conrady", )" + whole;
  const std::pair<std::string, std::string> refusals[] = {
      {whole, "model: missing"},
      {R"("model": "lens", )" + whole,
       "model: unknown camera model 'lens' (pinhole, brown_conrady, kannala_brandt, cahv, cahvor "
       "or cahvore is needed)"},
      {pinhole + R"("width": 0, "height": 5, )" + kFocus, "width: 0 is outside 1 .. 16384"},
      {pinhole + R"("width": 20.5, "height": 5, )" + kFocus, "width: not an integer (is 20.5)"},
      {pinhole + R"("width": 20000, "height": 5, )" + kFocus, "width: 20000 is outside 1 .. 16384"},
      {pinhole + kSize + R"("fx": -3100, "fy": 3100, "cx": 5, "cy": 5)",
       "fx: -3100 is outside 0.001 .. 1e+07"},
      {pinhole + kSize + R"("fx": 3100, "cx": 5, "cy": 5)", "fy: missing"},
      {pinhole + whole + R"(, "dist": [0.1, 0, 0, 0])",
       "dist[0]: a pinhole camera has no distortion (use brown_conrady)"},
      {brown, "dist: missing"},
      {brown + R"(, "dist": [0.1, 0.2, 0.3])",
       "dist: brown_conrady needs 4, 5 or 8 coefficients, 3 given"},
      {brown + R"(, "dist": [0, 0, 0, "x"])", "dist[3]: not a number (is a string)"},
      {R"("model": "kannala_brandt", )" + whole + R"(, "dist": [0, 0, 0, 0, 0])",
       "dist: kannala_brandt needs 4 coefficients, 5 given"}};
  for (const auto& [camera, refusal] : refusals)
    EXPECT_EQ(error(camera), "camera.json: " + refusal);
  EXPECT_EQ(error(pinhole + whole + R"(, "dist": [0, 0, 0, 0])"), "(nothing)");
}

TEST_F(ReadCamera, TakesAStatedSigmaOfTheCalibrationAndWritesItBack) {
  const std::string pinhole = std::string(R"("model": "pinhole", )") + kSize + kFocus;
  const auto with = [&](const std::string& sigma) {
    return readCameraFile(
        folder_.write("b.json", cameraText(pinhole + ", \"calibration_sigma\": " + sigma)));
  };
  EXPECT_FALSE(readCameraFile(folder_.write("a.json", cameraText(pinhole))).calibration_sigma);
  const CameraFile read = with(R"({"focal_relative": 0.001, "principal_point_px": 0.7})");
  EXPECT_EQ(read.calibration_sigma, (StatedCalibration{0.001, 0.7}));
  writeCamera(folder_ / "c.json", read);
  EXPECT_EQ(readCameraFile(folder_ / "c.json").calibration_sigma, read.calibration_sigma);
  for (const char* one : {R"({"focal_relative": 0.001})", R"({"principal_point_px": 0.7})"}) {
    const CameraFile partly = with(one);
    EXPECT_NE(partly.calibration_sigma->focal_relative.has_value(),
              partly.calibration_sigma->principal_point_px.has_value());
    writeCamera(folder_ / "d.json", partly);
    EXPECT_EQ(readCameraFile(folder_ / "d.json").calibration_sigma, partly.calibration_sigma);
  }
  for (const char* wrong : {R"({})", R"({"focal_relative": -1, "principal_point_px": 0})",
                            R"({"focal_relative": 0.5, "principal_point_px": 0})",
                            R"({"focal_relative": 0, "principal_point_px": 0, "focal_px": 1})"})
    EXPECT_THAT(folder_.message([&] { (void)with(wrong); }), HasSubstr("calibration_sigma"))
        << wrong;
}

TEST_F(ReadCamera, WrittenCamera_IsReadBackExactly) {
  Random random(7);
  for (int i = 0; i < 60; ++i) {
    Camera camera = test::randomCamera(random, static_cast<CameraModel>(i % 3));
    if (i % 2 == 0) std::fill(camera.distortion.begin() + 5, camera.distortion.end(), 0.0);
    ASSERT_EQ(prepareCamera(camera), Status::kOk);
    writeCamera(folder_ / "camera.json", {camera});
    EXPECT_EQ(readCamera(folder_ / "camera.json"), camera);
  }
}

/// As an operator would write it, from the vectors themselves.
OrderedJson written(const PlanetaryCamera& camera) {
  const CahvModel& cahv = camera.cahv;
  OrderedJson json = {{"format", "boresight-camera"}, {"version", 1}};
  json["model"] = cameraModelName(cahv.model);
  json["width"] = camera.width;
  json["height"] = camera.height;
  forVectors(cahv, [&json](const char* key, const Eigen::Vector3d& vector) {
    json[key] = toJson(vector);
  });
  if (cahv.model == CameraModel::kCahvore) {
    json["cahvore_type"] = cahv.type;
    json["cahvore_parameter"] = cahv.parameter;
  }
  json["reference_frame"] = {{"name", "ROVER_NAV_FRAME"}, {"index", {14, 1262, 6}}};
  return json;
}

class CahvCamera : public ::testing::TestWithParam<PlanetaryCamera> {
 protected:
  CameraFile read(const OrderedJson& json) {
    return readCameraFile(folder_.write("camera.json", json.dump()));
  }
  std::string error(const OrderedJson& json) {
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
  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Cahv, CahvCamera, ::testing::ValuesIn(test::planetaryCameras()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(CahvCamera, ReadAndWritten_ProjectsByTheVectorFormulaInItsReferenceFrame) {
  CameraFile file = read(written(GetParam()));
  const Camera camera = file.camera;
  for (int round = 0; round < 2; ++round) {
    expectSights(file);
    EXPECT_EQ(file.reference->frame, (FrameName{"ROVER_NAV_FRAME", {14, 1262, 6}}));
    writeCamera(folder_ / "again.json", file);
    file = readCameraFile(folder_ / "again.json");
  }
  // Without its reference it is given in its own frame, equal to the bit.
  writeCamera(folder_ / "own.json", {camera});
  const CameraFile own = readCameraFile(folder_ / "own.json");
  EXPECT_EQ(own.camera, camera);
  EXPECT_EQ(own.reference->frame.name, "CAMERA");
  EXPECT_EQ(own.reference->camera_from_reference, Pose());
}

TEST_P(CahvCamera, OfASubframeSeesTheSamePoints) {
  OrderedJson json = written(GetParam());
  json["width"] = 320;
  json["height"] = 240;
  json["subframe"] = {{"first_sample", 200}, {"first_line", 120}, {"scale", 2}};
  expectSights(read(json), {200.0, 120.0}, 2.0);
}

TEST_P(CahvCamera, NamesWhatIsWrong) {
  const OrderedJson good = written(GetParam());
  for (const char* key : {"C", "A", "H", "V"}) {
    OrderedJson json = good;
    json.erase(key);
    EXPECT_EQ(error(json), std::string("camera.json: ") + key + ": missing");
    json[key] = {1.0, 2.0};
    EXPECT_THAT(error(json), StartsWith(std::string("camera.json: ") + key));
  }
  for (const auto& [key, value, refusal] : std::vector<std::array<const char*, 3>>{
           {"A", "[1, 1, 1]", "A and O must have length 1"},
           {"fx", "1000", "camera.json: fx: a cahv"},
           {"subframe", R"({"scale": 0})", "camera.json: subframe.scale: 0 is outside"},
           {"reference_frame", R"({"name": ""})", "camera.json: reference_frame.name"},
           {"cahvore_type", "4", "camera.json: cahvore_type: 4 is outside 1 .. 3"}}) {
    if (key == std::string("cahvore_type") && GetParam().cahv.model != CameraModel::kCahvore)
      continue;
    OrderedJson json = good;
    json[key] = OrderedJson::parse(value);
    EXPECT_THAT(error(json), HasSubstr(refusal));
  }
}

}  // namespace
}  // namespace boresight::sessions
