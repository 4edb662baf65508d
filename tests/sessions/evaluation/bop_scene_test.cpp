// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_scene.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "tests/sessions/exchange/posed_images.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

/// With the ids 1, 2, ...
std::vector<BopObject> objectsOf(const std::vector<PosedImage>& images) {
  std::vector<BopObject> objects;
  for (const PosedImage& image : images)
    objects.push_back({image, static_cast<int>(objects.size()) + 1});
  return objects;
}

TEST(BopScene, RoundTrip_IsEqual) {
  const test::TemporaryFolder folder;
  Random random = test::randomFor("BopScene.ComesBack");
  const std::vector<PosedImage> images =
      test::randomImages(random, {test::preparedCamera(CameraModel::kPinhole, {})}, 8);
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

TEST(BopScene, Layout_IsThatOfTheBopToolkit) {
  const test::TemporaryFolder folder;
  PosedImage image;
  image.id = 3;
  image.camera = test::preparedCamera(CameraModel::kPinhole, {});
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

TEST(BopScene, UnsupportedCamera_IsRefused) {
  const test::TemporaryFolder folder;
  PosedImage image;
  image.camera = test::preparedCamera(CameraModel::kBrownConrady, {-0.1});
  EXPECT_THAT(folder.message([&] { writeBopScene(folder / "", objectsOf({image})); }),
              HasSubstr("undistort"));
  image.camera = test::preparedCamera(CameraModel::kPinhole, {});
  EXPECT_THROW(writeBopScene(folder / "", objectsOf({image, image})), OutputError);
}

TEST(BopScene, NamesWhatIsWrong) {
  const test::TemporaryFolder folder;
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

std::vector<BopResult> randomResults(Random& random, int count) {
  std::vector<BopResult> results;
  for (int i = 0; i < count; ++i)
    results.push_back({1 + i / 4, i % 4, 1 + i % 3, random.uniform(0.0, 1.0),
                       test::randomPose(random), i % 2 == 0 ? -1.0 : 0.25});
  return results;
}

std::vector<std::string> splitAt(const std::string& text, char sign) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, sign);) parts.push_back(part);
  return parts;
}

std::vector<double> numbersOf(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& number : splitAt(text, ' ')) numbers.push_back(std::stod(number));
  return numbers;
}

/// What bop_toolkit's check_results_bop19.py and load_bop_results demand, restated.
TEST(BopResults, KeepsTheRulesOfTheFormat) {
  const test::TemporaryFolder folder;
  Random random = test::randomFor("BopResults.Rules");
  const auto results = randomResults(random, 40);
  writeBopResults(folder / "boresight_os-test.csv", results);
  std::ifstream stream(folder / "boresight_os-test.csv");
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "scene_id,im_id,obj_id,score,R,t,time");
  std::size_t i = 0;
  for (; std::getline(stream, line); ++i) {
    const auto fields = splitAt(line, ',');
    ASSERT_EQ(fields.size(), 7u);
    EXPECT_EQ(std::stoi(fields[0]), results[i].scene_id);
    EXPECT_EQ(std::stoi(fields[1]), results[i].image_id);
    EXPECT_EQ(std::stoi(fields[2]), results[i].object_id);
    EXPECT_EQ(std::stod(fields[3]), results[i].score);
    const auto rotation = numbersOf(fields[4]);
    const auto translation_mm = numbersOf(fields[5]);
    ASSERT_EQ(rotation.size(), 9u);
    ASSERT_EQ(translation_mm.size(), 3u);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> matrix(rotation.data());
    EXPECT_LT((matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Eigen::Vector3d point_mm(10.0, -20.0, 30.0);
    const Eigen::Vector3d in_camera_mm = matrix * point_mm + Eigen::Vector3d(translation_mm.data());
    EXPECT_LT((1e-3 * in_camera_mm - results[i].camera_from_station * (1e-3 * point_mm)).norm(),
              1e-12);
    EXPECT_EQ(std::stod(fields[6]), results[i].seconds);
  }
  EXPECT_EQ(i, results.size());
}

TEST(BopResults, RefusesWhatTheFormatDoesNotAllow) {
  const test::TemporaryFolder folder;
  Random random = test::randomFor("BopResults.Refuses");
  const std::vector<BopResult> good(2, randomResults(random, 1)[0]);
  std::vector<BopResult> other_time = good, no_image = good, no_number = good;
  other_time[1].seconds = 0.5;
  no_image[1].image_id = -1;
  no_number[1].camera_from_station.translation_m.x() = NAN;
  for (const auto& results : {other_time, no_image, no_number})
    EXPECT_THROW(writeBopResults(folder / "r.csv", results), OutputError);
}

}  // namespace
}  // namespace boresight::sessions
