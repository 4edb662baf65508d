// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "tests/sessions/exchange/posed_images.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::preparedCamera;
using test::randomFor;
using test::TemporaryFolder;
using testing::HasSubstr;

/// With the ids 1, 2, ...
std::vector<BopObject> objectsOf(const std::vector<PosedImage>& images) {
  std::vector<BopObject> objects;
  for (const PosedImage& image : images)
    objects.push_back({image, static_cast<int>(objects.size()) + 1});
  return objects;
}

TEST(BopScene, ComesBack) {
  const TemporaryFolder folder;
  Random random = randomFor("BopScene.ComesBack");
  const std::vector<PosedImage> images =
      test::randomImages(random, {preparedCamera(CameraModel::kPinhole, {})}, 8);
  writeBopScene(folder / "", objectsOf(images));
  const std::vector<BopObject> read = readBopScene(folder / "");
  ASSERT_EQ(read.size(), images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(read[i].object_id, static_cast<int>(i) + 1);
    EXPECT_EQ(read[i].image.id, images[i].id);
    EXPECT_EQ(read[i].image.camera.fx, images[i].camera.fx);
    EXPECT_EQ(read[i].image.camera.cy, images[i].camera.cy);
    EXPECT_LT(perturbationBetween(read[i].image.camera_from_station, images[i].camera_from_station)
                  .norm(),
              1e-12);
  }
}

TEST(BopScene, IsWhatItsToolsRead) {
  const TemporaryFolder folder;
  PosedImage image;
  image.id = 3;
  image.camera = preparedCamera(CameraModel::kPinhole, {});
  image.camera_from_station.translation_m = {0.0625, -0.125, 0.5};
  image.camera_from_station.rotation = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  writeBopScene(folder / "", objectsOf({image}));
  const auto gt = nlohmann::json::parse(folder.read("scene_gt.json"));
  const auto cameras = nlohmann::json::parse(folder.read("scene_camera.json"));
  EXPECT_EQ(gt["3"][0]["cam_t_m2c"], nlohmann::json({62.5, -125.0, 500.0}));
  EXPECT_EQ(gt["3"][0]["cam_R_m2c"],
            nlohmann::json({1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0}));
  EXPECT_EQ(gt["3"][0]["obj_id"], 1);
  EXPECT_EQ(cameras["3"]["cam_K"],
            nlohmann::json({700.25, 0.0, 319.375, 0.0, 701.125, 241.1, 0.0, 0.0, 1.0}));
  EXPECT_EQ(cameras["3"]["depth_scale"], 1.0);
}

TEST(BopScene, RefusesWhatTheFormatCannotSay) {
  const TemporaryFolder folder;
  PosedImage image;
  image.camera = preparedCamera(CameraModel::kBrownConrady, {-0.1});
  EXPECT_THAT(folder.message([&] { writeBopScene(folder / "", objectsOf({image})); }),
              HasSubstr("undistort"));
  image.camera = preparedCamera(CameraModel::kPinhole, {});
  EXPECT_THROW(writeBopScene(folder / "", objectsOf({image, image})), OutputError);
}

TEST(BopScene, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error = [&folder](const std::string& cameras, const std::string& objects) {
    folder.write("scene_camera.json", cameras);
    folder.write("scene_gt.json", objects);
    return folder.message([&] { (void)readBopScene(folder / ""); });
  };
  const std::string camera = R"({"0": {"cam_K": [9, 0, 5, 0, 9, 5, 0, 0, 1], "depth_scale": 1}})";
  const std::string object =
      R"([{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 1], "obj_id": 1}])";
  EXPECT_EQ(error(camera, "{\"0\": " + object + "}"), "(nothing)");
  EXPECT_EQ(error(camera, "{\"1\": " + object + "}"),
            "scene_gt.json: 1: scene_camera.json has no such image");
  EXPECT_EQ(error(camera, "{\"x\": " + object + "}"),
            "scene_gt.json: x: 'x' is not a number from 0 on");
  EXPECT_THAT(error(R"({"0": {"cam_model": {}}})", "{}"),
              HasSubstr("only pinhole cameras (cam_K)"));
  EXPECT_THAT(error(camera, R"({"0": [{"cam_R_m2c": [2, 0, 0, 0, 1, 0, 0, 0, 1],
                               "cam_t_m2c": [0, 0, 1], "obj_id": 1}]})"),
              HasSubstr("is not a rotation"));
}

}  // namespace
}  // namespace boresight::sessions
