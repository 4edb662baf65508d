// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/box_mesh.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using namespace sessions;

std::vector<std::string> codes(const std::vector<RedFlag>& flags) {
  std::vector<std::string> all;
  for (const RedFlag& flag : flags) all.push_back(flag.code);
  return all;
}

const LoadedCase& loadedOs() {
  static const auto loaded = loadCase(makeCase(filesOf(exampleFolder() / "os")).made);
  return *loaded;
}

std::vector<std::string> flagsWith(const std::function<void(SessionCase&)>& change) {
  SessionCase session_case = loadedOs().source;
  change(session_case);
  return codes(inputSheet(*reloadCase(loadedOs(), session_case)).flags);
}

/// "" when there is none.
std::string lineOf(const InputSheet& sheet, const std::string& label) {
  for (const SheetLine& line : sheet.lines)
    if (line.label == label) return line.value;
  return "";
}

TEST(InputSheet, MeasuresTheExample) {
  const SessionCase& session_case = loadedOs().source;
  const InputSheet sheet = inputSheet(loadedOs());
  // 4.8 % of this image is the bright background.
  EXPECT_THAT(codes(sheet.flags), ElementsAre("image_saturated"));
  // Independent figures: a pinhole of the same focal length, and the seed's own translation.
  const double pinhole_deg =
      2.0 * std::atan(0.5 * session_case.camera.width / session_case.camera.fx) / kDegree_rad;
  const double distance_m = session_case.camera_from_station_seed.translation_m.norm();
  EXPECT_NEAR(std::stod(lineOf(sheet, "field of view")), pinhole_deg, 1.0);
  EXPECT_NEAR(std::stod(lineOf(sheet, "seed")), distance_m, 0.1);
  const std::string station = lineOf(sheet, "station");
  const double width_mm = std::stod(station.substr(station.find("the view is ") + 12));
  EXPECT_NEAR(width_mm, 2e3 * distance_m * std::tan(0.5 * pinhole_deg * kDegree_rad),
              0.1 * width_mm);
  for (const SheetLine& line : sheet.lines) EXPECT_FALSE(line.value.empty());
  EXPECT_EQ(lineOf(sheet, "scale, one sigma"), "0.02 %, assumed");
  EXPECT_THAT(lineOf(sheet, "calibration, one sigma"), StartsWith("0.02 % and 0.25 px, assumed"));
  SessionCase stated = session_case;
  stated.mesh_scale_sigma = 0.001;
  EXPECT_EQ(lineOf(inputSheet(*reloadCase(loadedOs(), stated)), "scale, one sigma"), "0.1 %");
}

TEST(InputSheet, FlagsWhatIsProbablyWrong) {
  const std::pair<const char*, void (*)(SessionCase&)> wrongs[] = {
      {"station_small", [](SessionCase& c) { c.parts[0].source.mesh_unit = "mm"; }},
      {"mesh_scale", [](SessionCase& c) { c.parts[0].source.mesh_unit = "km"; }},
      {"station_behind_camera",
       [](SessionCase& c) { c.camera_from_station_seed.translation_m.z() *= -1; }},
      {"station_out_of_view",
       [](SessionCase& c) { c.camera_from_station_seed.translation_m.x() += 5.0; }},
      {"camera_size", [](SessionCase& c) { c.camera.width += 2; }},
      {"camera_off_centre", [](SessionCase& c) { c.camera.cx += 400.0; }},
      {"camera_aspect", [](SessionCase& c) { c.camera.fy *= 1.1; }},
      {"camera_wide",
       [](SessionCase& c) {
         c.camera = makeCamera(CameraModel::kPinhole, c.camera.width, c.camera.height, 35.0);
       }},
      {"camera_corners", [](SessionCase& c) {
         c.camera = makeCamera(CameraModel::kBrownConrady, c.camera.width, c.camera.height,
                               c.camera.fx, {-3.0, 0.0, 0.0, 0.0});
       }}};
  for (const auto& [code, change] : wrongs) EXPECT_THAT(flagsWith(change), Contains(code));
}

TEST(InputSheet, FlagsATruthWhoseSigmaExceedsTheRequirement) {
  const auto with_sigma = [](double sigma_m) {
    return flagsWith([sigma_m](SessionCase& session_case) {
      Matrix6d covariance = 1e-12 * Matrix6d::Identity();
      covariance.bottomRightCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
      setTruth(session_case, session_case.camera_from_station_seed, {}, covariance);
    });
  };
  EXPECT_THAT(with_sigma(1e-5), Not(Contains("truth_uncertain")));
  EXPECT_THAT(with_sigma(5e-3), Contains("truth_uncertain"));
  EXPECT_THAT(flagsWith([](SessionCase& session_case) {
                setTruth(session_case, session_case.camera_from_station_seed,
                         {sessions::TruthOrigin::kRun, "", "", std::string(64, 'a')});
              }),
              Contains("truth_of_run"));
}

/// The example with its pixels changed, since a file with other pixels would be refused.
InputSheet sheetWithPixels(int (*change)(int gray)) {
  LoadedCase changed;
  changed.source = loadedOs().source;
  changed.scene = loadedOs().scene;
  changed.image = loadedOs().image;
  for (std::uint8_t& gray : changed.image.pixels) gray = static_cast<std::uint8_t>(change(gray));
  return inputSheet(changed);
}

TEST(InputSheet, ImageThatCannotCarryAPose_IsFlagged) {
  EXPECT_THAT(codes(sheetWithPixels([](int) { return 255; }).flags),
              AllOf(Contains("image_overexposed"), Contains("image_flat")));
  EXPECT_THAT(codes(sheetWithPixels([](int gray) { return 100 + gray / 64; }).flags),
              AllOf(Contains("image_flat"), Not(Contains("image_overexposed"))));
  const InputSheet same = sheetWithPixels([](int gray) { return gray; });
  EXPECT_THAT(codes(same.flags), ElementsAre("image_saturated"));
  EXPECT_THAT(lineOf(same, "image at the seed"), StartsWith("noise "));
}

TEST(InputSheet, TellsTheInsideOfASurface) {
  const SceneMesh cube = boxMesh({1.0, 1.0, 1.0});
  Random random = randomFor("cube");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = randomVector(random, 2.0);
    EXPECT_EQ(isInside(cube.view(), point), point.cwiseAbs().maxCoeff() < 1.0);
  }
  EXPECT_FALSE(isInside(osExample().scene.view(), {0.0, 0.0, 10.0}));
}

/// An image as a Bayer sensor sees a scene of smooth colours.
std::vector<std::uint8_t> mosaic(int width, int height) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double shade = 0.6 + 0.4 * std::sin(0.05 * x) * std::cos(0.07 * y);
      const double color = y % 2 == 0 ? (x % 2 == 0 ? 220.0 : 130.0) : (x % 2 == 0 ? 130.0 : 60.0);
      pixels.push_back(static_cast<std::uint8_t>(shade * color));
    }
  return pixels;
}

TEST(InputSheet, KnowsAMosaicFromNoiseAndPictures) {
  const std::vector<std::uint8_t> raw = mosaic(200, 150);
  EXPECT_TRUE(looksLikeMosaic({raw.data(), 200, 150, 200}));
  Random random = randomFor("noise");
  std::vector<std::uint8_t> noise(200 * 150);
  for (std::uint8_t& pixel : noise) pixel = static_cast<std::uint8_t>(random.below(256));
  EXPECT_FALSE(looksLikeMosaic({noise.data(), 200, 150, 200}));
  EXPECT_FALSE(looksLikeMosaic({noise.data(), 2, 2, 2}));
  const GrayImage picture = readImage(exampleFolder() / "bc/image.png");
  EXPECT_FALSE(looksLikeMosaic(picture.view()));
}

TEST(InputSheet, FlagsSixteenBitsWithoutARule) {
  const TemporaryFolder folder;
  cv::Mat image(100, 100, CV_16UC1);
  for (int i = 0; i < 10000; ++i)
    image.at<std::uint16_t>(i / 100, i % 100) = static_cast<std::uint16_t>(i / 3);
  cv::imwrite((folder / "16.png").string(), image);
  EXPECT_THAT(codes(imageSheet(readImage(folder / "16.png")).flags), Contains("image_bit_depth"));
  ImageReadOptions stated;
  stated.bit_depth = 12;
  EXPECT_THAT(codes(imageSheet(readImage(folder / "16.png", stated)).flags), IsEmpty());
}

TEST(ReadImage, TakesAGivenTable) {
  const TemporaryFolder folder;
  cv::Mat image(1, 4, CV_16UC1);
  for (int i = 0; i < 4; ++i) image.at<std::uint16_t>(0, i) = static_cast<std::uint16_t>(i);
  cv::imwrite((folder / "t.png").string(), image);
  ImageReadOptions options;
  options.bit_depth = 2;
  options.table = {9, 7, 200, 3};
  const GrayImage read = readImage(folder / "t.png", options);
  EXPECT_EQ(read.pixels, options.table);
  EXPECT_EQ(read.rule, "by a given table of 4 values");
  options.table.pop_back();
  EXPECT_EQ(folder.message([&] { (void)readImage(folder / "t.png", options); }),
            "t.png: table: has 3 entries, but 2 bits need 4");
}

}  // namespace
}  // namespace boresight::test
