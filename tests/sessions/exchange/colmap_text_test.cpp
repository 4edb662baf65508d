// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/colmap_text.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/files/errors.h"
#include "tests/sessions/exchange/posed_images.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::preparedCamera;

/// Images as text, written to a folder and read from it.
class ColmapText : public testing::Test {
 protected:
  void writeImages(std::span<const PosedImage> images) const {
    writeColmapText(folder_ / "", images);
  }
  std::vector<PosedImage> readImages() const { return readColmapText(folder_ / ""); }
  const test::TemporaryFolder folder_;
};

TEST_F(ColmapText, RoundTripIsExact) {
  Random random = test::randomFor("ColmapText.RoundTrip");
  const std::vector<PosedImage> images =
      test::randomImages(random,
                         {preparedCamera(CameraModel::kPinhole),
                          preparedCamera(CameraModel::kBrownConrady, {-0.1, 0.02, 1e-4, -2e-4}),
                          preparedCamera(CameraModel::kBrownConrady,
                                         {-0.1, 0.02, 1e-4, -2e-4, 0.01, 0.001, 0.0, 1e-5}),
                          preparedCamera(CameraModel::kKannalaBrandt, {0.03, -0.01, 0.004, 0.001})},
                         10);
  writeImages(images);
  const std::vector<PosedImage> read = readImages();
  ASSERT_EQ(read.size(), images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(read[i].id, images[i].id);
    EXPECT_EQ(read[i].name, images[i].name);
    EXPECT_EQ(read[i].camera_from_station, images[i].camera_from_station);
    EXPECT_EQ(read[i].camera.distortion, images[i].camera.distortion);
    EXPECT_EQ(read[i].camera.model, images[i].camera.model);
    EXPECT_DOUBLE_EQ(read[i].camera.cx, images[i].camera.cx);
    EXPECT_DOUBLE_EQ(read[i].camera.cy, images[i].camera.cy);
  }
}

TEST_F(ColmapText, IsWhatColmapReads) {
  const Pose pose{Eigen::Quaterniond::Identity(), {0.5, 0.25, 2.0}};
  const PosedImage image{7, "a.png", preparedCamera(CameraModel::kPinhole), pose};
  writeImages({&image, 1});
  // Half a pixel further: COLMAP's origin is the corner of the image.
  EXPECT_THAT(folder_.read("cameras.txt"),
              HasSubstr("\n1 PINHOLE 640 480 700.25 701.125 319.875 241.6\n"));
  EXPECT_THAT(folder_.read("images.txt"), HasSubstr("\n7 1 0 0 0 0.5 0.25 2 1 a.png\n\n"));
}

TEST_F(ColmapText, PointsOfSeveralImagesAreOnePointWithATrack) {
  const Camera camera = preparedCamera(CameraModel::kPinhole);
  const Pose pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.0}};
  std::vector<PosedImage> images = {{3, "0.png", camera, pose}, {4, "1.png", camera, pose}};
  const Eigen::Vector3d shared(0.0, 0.0, 0.0), own(0.1, 0.0, 0.0);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(project(camera, pose * shared, pixel));
  images[0].points = {{own, {10.0, 20.0}}, {shared, pixel + Eigen::Vector2d(0.5, 0.0)}};
  images[1].points = {{shared, pixel}};
  writeImages(images);
  EXPECT_THAT(folder_.read("images.txt"), HasSubstr(" 1 0.png\n10.5 20.5 1 "));
  const std::string points = folder_.read("points3D.txt");
  EXPECT_THAT(points, HasSubstr("\n2 0 0 0 128 128 128 0.25 3 1 4 0\n")) << points;
  EXPECT_THAT(points, HasSubstr("\n1 0.1 0 0 128 128 128 "));
  EXPECT_EQ(readImages().at(1).name, "1.png");
}

TEST_F(ColmapText, ReadsSimplerModelsAndPoints) {
  folder_.write("cameras.txt", "# a comment\n2 RADIAL 100 80 90 50 40 0.01 -0.002\n\n");
  folder_.write("images.txt",
                "# a comment\n1 1 0 0 0 0 0 1 2 x y.png\r\n1.5 2.5 -1 3 4 17\n"
                "2 0.6 0 0.8 0 0 0 1 2 b.png\n\n");
  const std::vector<PosedImage> read = readImages();
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].name, "x y.png");
  EXPECT_EQ(read[0].camera.fy, 90.0);
  EXPECT_EQ(read[0].camera.cx, 49.5);
  EXPECT_EQ(read[0].camera.distortion[1], -0.002);
  EXPECT_EQ(read[1].camera_from_station.rotation.y(), 0.8);
}

/// COLMAP's own formulas (its sensor/models.h): a point (u, v, 1), pixels from the image's corner.
TEST_F(ColmapText, FisheyesProjectAsColmapDoes) {
  const double u = 0.31, v = -0.22, f = 210.0, fy = 212.0;
  const double radius = std::hypot(u, v), theta = std::atan(radius);
  const struct {
    const char* line;
    double fy, k[4];
  } models[] = {{"1 SIMPLE_FISHEYE 400 300 210 200.5 150.5", f, {}},
                {"1 FISHEYE 400 300 210 212 200.5 150.5", fy, {}},
                {"1 SIMPLE_RADIAL_FISHEYE 400 300 210 200.5 150.5 0.02", f, {0.02}},
                {"1 RADIAL_FISHEYE 400 300 210 200.5 150.5 0.02 -0.01", f, {0.02, -0.01}},
                {"1 OPENCV_FISHEYE 400 300 210 212 200.5 150.5 0.02 -0.01 0.003 0.001",
                 fy,
                 {0.02, -0.01, 0.003, 0.001}},
                {"1 THIN_PRISM_FISHEYE 400 300 210 212 200.5 150.5 0.02 -0.01 0 0 0.003 0.001 0 0",
                 fy,
                 {0.02, -0.01, 0.003, 0.001}}};
  for (const auto& model : models) {
    SCOPED_TRACE(model.line);
    folder_.write("cameras.txt", std::string(model.line) + "\n");
    folder_.write("images.txt", "1 1 0 0 0 0 0 1 1 a.png\n\n");
    const Camera camera = readImages().at(0).camera;
    double distorted = theta;
    for (int i = 0; i < 4; ++i) distorted += model.k[i] * std::pow(theta, 2 * i + 3);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, {u, v, 1.0}, pixel));
    EXPECT_NEAR(pixel.x(), f * u * distorted / radius + 200.5 - 0.5, 1e-9);
    EXPECT_NEAR(pixel.y(), model.fy * v * distorted / radius + 150.5 - 0.5, 1e-9);
  }
}

TEST_F(ColmapText, NamesWhatIsWrong) {
  const std::string remedy =
      "; undistort the images with COLMAP's image_undistorter and read its model";
  const std::pair<const char*, std::string> cameras[] = {
      {"FOV 10 10 9 9 5 5 1", "no camera model matches FOV" + remedy},
      {"THIN_PRISM_FISHEYE 10 10 9 9 5 5 0.1 0 0 0.001 0 0 0 0",
       "no camera model matches THIN_PRISM_FISHEYE with tangential or thin-prism terms" + remedy},
      {"CATADIOPTRIC 10 10 9 9 5 5 1", "no camera model matches CATADIOPTRIC" + remedy},
      {"PINHOLE 10 10 9 9 5", "cy is missing"},
      {"PINHOLE 10 10 9 9 5 5 5", "has extra values: '5'"},
      {"PINHOLE 10 10 0 9 5 5", "the parameters are not those of a camera"}};
  folder_.write("images.txt", "x");
  const auto message = [&] { return folder_.message([&] { (void)readImages(); }); };
  for (const auto& [camera, refusal] : cameras) {
    folder_.write("cameras.txt", std::string("1 ") + camera + "\n");
    EXPECT_EQ(message(), "cameras.txt: line 1: " + refusal);
  }
  folder_.write("cameras.txt", "1 PINHOLE 10 10 9 9 5 5\n");
  const std::pair<const char*, const char*> images[] = {
      {"\n1 1 0 0 0 0 0 1 2 a.png", "line 2: there is no camera 2"},
      {"1 1 1 0 0 0 0 1 1 a.png", "line 1: the quaternion has not the length 1"},
      {"1 1 0 0 0 0 0 nan 1 a.png", "line 1: the translation: 'nan' is not a finite number"},
      {"1 1 0 0 0 0 0 1 1", "line 1: the image's name is missing"}};
  for (const auto& [image, refusal] : images) {
    folder_.write("images.txt", std::string(image) + "\n\n");
    EXPECT_EQ(message(), std::string("images.txt: ") + refusal);
  }
}

/// Without the empty lines, every second image would be taken for the points of the one before.
TEST_F(ColmapText, ImageInPlaceOfPoints_IsRefused) {
  folder_.write("cameras.txt", "1 PINHOLE 10 10 9 9 5 5\n");
  const std::string image = "1 0 0 0 0 0 1 1 ";
  const std::string refusal =
      " is no list of points (x y id), which follows each image: write an empty line for an image "
      "without points";
  const auto message = [&](const std::string& text) {
    folder_.write("images.txt", text);
    return folder_.message([&] { (void)readImages(); });
  };
  const std::string first = "1 " + image + "a.png\n", second = "2 " + image + "b 1.png\n";
  EXPECT_EQ(message(first + "# none\n" + second), "images.txt: line 2:" + refusal);
  EXPECT_EQ(message(first + second), "images.txt: line 2:" + refusal);
  EXPECT_EQ(message(first + "\n" + second + "3 " + image + "c.png\n"),
            "images.txt: line 4:" + refusal);
  for (const char* points : {"\n", " \r\n", "1 2e0 -1\r\n", "\n\n", "+1. .5 +7\t1 2 3\n"})
    EXPECT_EQ(message(first + points + second), "(nothing)") << points;
  EXPECT_EQ(readImages().size(), 2u);
}

TEST_F(ColmapText, BadPoint_IsRefusedWithItsField) {
  folder_.write("cameras.txt", "1 PINHOLE 10 10 9 9 5 5\n");
  const std::pair<const char*, const char*> points[] = {
      {"1.5 2 x", "the id of point 1: 'x' is not a whole number"},
      {"1.5 2 3 4 5 6.5", "the id of point 2: '6.5' is not a whole number"},
      {"1.5 2", "the id of point 1 is missing"},
      {"1 2 3 4", "y of point 2 is missing"},
      {"1,5 2 3", "x of point 1: '1,5' is not a number: write a decimal point"},
      {"1 nan 3", "y of point 1: 'nan' is not a finite number"},
      {"1 2 3 4\xC2\xA0"
       "5 6",
       "x of point 2: '4\xC2\xA0"
       "5' is not a number: write its digits, "
       "sign and the blanks around it in ASCII"}};
  for (const auto& [line, refusal] : points) {
    folder_.write("images.txt", "1 1 0 0 0 0 0 1 1 a.png\n" + std::string(line) + "\n");
    EXPECT_EQ(folder_.message([&] { (void)readImages(); }),
              std::string("images.txt: line 2: ") + refusal);
  }
}

TEST_F(ColmapText, LinesThatEndInCrAloneAndPaddedText_AreRead) {
  for (const std::string& padding : {std::string(), std::string("\x1a"), std::string(9, '\0')}) {
    folder_.write("cameras.txt", "# Number of cameras: 1\r1 PINHOLE 10 10 9 9 5 5\r" + padding);
    folder_.write("images.txt",
                  "# a\r1 1 0 0 0 0 0 1 1 a.png\r\r2 1 0 0 0 0 0 1 1 b.png\r1 2 3\r" + padding);
    const std::vector<PosedImage> images = readImages();
    ASSERT_EQ(images.size(), 2u);
    EXPECT_EQ(images[1].name, "b.png");
  }
}

/// COLMAP ends its last line; a number cut within its digits shows by nothing else.
TEST_F(ColmapText, LastLineWithoutEnd_IsRefused) {
  const std::string cameras = "1 PINHOLE 10 10 9 9 5 50\n";
  const std::string images = "1 1 0 0 0 0 0 1 1 a.png\n1 2 34\n";
  const std::string refusal =
      ": the last line has no line end: the file may be truncated; add the line end if it is whole";
  folder_.write("images.txt", images);
  for (const std::size_t cut : {1u, 2u}) {
    folder_.write("cameras.txt", cameras.substr(0, cameras.size() - cut));
    EXPECT_EQ(folder_.message([&] { (void)readImages(); }), "cameras.txt" + refusal);
  }
  folder_.write("cameras.txt", cameras);
  for (const std::size_t cut : {1u, 2u, 9u}) {
    folder_.write("images.txt", images.substr(0, images.size() - cut));
    EXPECT_EQ(folder_.message([&] { (void)readImages(); }), "images.txt" + refusal);
  }
}

/// COLMAP states the number of images and cameras in a comment.
TEST_F(ColmapText, TruncatedModel_IsRefused) {
  const std::string cameras = "# Number of cameras: 1\n1 PINHOLE 10 10 9 9 5 5\n";
  std::string images = "# Number of images: 3, mean observations per image: 0.5\r\n";
  for (const char* id : {"1", "2", "3"})
    images += std::string(id) + " 1 0 0 0 0 0 1 1 " + id + ".png\n1.5 2 3\n";
  folder_.write("cameras.txt", cameras);
  folder_.write("images.txt", images);
  EXPECT_EQ(readImages().size(), 3u);
  for (std::size_t size = 1; size <= images.rfind(" 3.png"); ++size) {
    folder_.write("images.txt", images.substr(0, size));
    const std::string message = folder_.message([&] { EXPECT_TRUE(readImages().empty()); });
    EXPECT_TRUE(message != "(nothing)" || size < images.find(',')) << size;
  }
  folder_.write("images.txt", images.substr(0, images.rfind("3 1")));
  EXPECT_EQ(folder_.message([&] { (void)readImages(); }),
            "images.txt: states 3 images, but has 2: it may be truncated, or its comment is "
            "outdated");
  folder_.write("cameras.txt", "# Number of cameras: 2\n1 PINHOLE 10 10 9 9 5 5\n");
  EXPECT_EQ(folder_.message([&] { (void)readImages(); }),
            "cameras.txt: states 2 cameras, but has 1: it may be truncated, or its comment is "
            "outdated");
}

TEST_F(ColmapText, BinaryModelAndMarkedText_AreKnown) {
  folder_.write("cameras.bin", "x");
  EXPECT_EQ(folder_.message([&] { (void)readImages(); }),
            "cameras.txt: no such file, but the binary one: convert the model to text with colmap "
            "model_converter --output_type TXT");
  folder_.write("cameras.txt",
                "\xEF\xBB\xBF"
                "1 PINHOLE 10 10 9 9 5 5\n");
  folder_.write("images.txt",
                "\xEF\xBB\xBF"
                "1 1 0 0 0 0 0 1 1 a.png\n\n");
  EXPECT_EQ(readImages().size(), 1u);
}

TEST_F(ColmapText, RefusesWhatItCouldNotReadBack) {
  PosedImage image{0, "a.png", preparedCamera(CameraModel::kPinhole), Pose()};
  EXPECT_THROW(writeImages({&image, 1}), OutputError);  // id 0
  image.id = 1;
  const PosedImage twice[] = {image, image};
  EXPECT_THROW(writeImages(twice), OutputError);
  image.name = "a\nb";
  EXPECT_THROW(writeImages({&image, 1}), OutputError);
}

}  // namespace
}  // namespace boresight::sessions
