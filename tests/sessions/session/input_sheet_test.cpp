// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using sessions::InputSheet;
using sessions::SessionCase;
using testing::AllOf;
using testing::Contains;
using testing::IsEmpty;
using testing::Not;

SessionCase exampleOs() { return sessions::makeCase(filesOf(exampleFolder() / "os")).made; }

std::vector<std::string> codes(const std::vector<sessions::RedFlag>& flags) {
  std::vector<std::string> all;
  for (const sessions::RedFlag& flag : flags) all.push_back(flag.code);
  return all;
}

std::vector<std::string> flagsWith(const std::function<void(SessionCase&)>& change) {
  SessionCase session_case = exampleOs();
  change(session_case);
  return codes(sessions::inputSheet(*sessions::loadCase(session_case)).flags);
}

/// "" when there is none.
std::string lineOf(const InputSheet& sheet, const std::string& label) {
  for (const sessions::SheetLine& line : sheet.lines)
    if (line.label == label) return line.value;
  return "";
}

TEST(InputSheet, MeasuresTheExample) {
  const SessionCase session_case = exampleOs();
  const InputSheet sheet = sessions::inputSheet(*sessions::loadCase(session_case));
  // 4.8 % of this image is the bright background.
  EXPECT_THAT(codes(sheet.flags), testing::ElementsAre("image_saturated"));
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
  for (const sessions::SheetLine& line : sheet.lines) EXPECT_FALSE(line.value.empty());
}

TEST(InputSheet, FlagsWhatIsProbablyWrong) {
  EXPECT_THAT(flagsWith([](auto& c) { c.parts[0].source.mesh_unit = "mm"; }),
              Contains("station_small"));
  EXPECT_THAT(flagsWith([](auto& c) { c.parts[0].source.mesh_unit = "km"; }),
              Contains("mesh_scale"));
  EXPECT_THAT(flagsWith([](auto& c) { c.camera_from_station_seed.translation_m.z() *= -1; }),
              Contains("station_behind_camera"));
  EXPECT_THAT(flagsWith([](auto& c) { c.camera_from_station_seed.translation_m.x() += 5.0; }),
              Contains("station_out_of_view"));
  EXPECT_THAT(flagsWith([](auto& c) { c.camera.width += 2; }), Contains("camera_size"));
  EXPECT_THAT(flagsWith([](auto& c) { c.camera.cx += 400.0; }), Contains("camera_off_centre"));
  EXPECT_THAT(flagsWith([](auto& c) { c.camera.fy *= 1.1; }), Contains("camera_aspect"));
  EXPECT_THAT(flagsWith([](auto& c) {
                c.camera = makeCamera(CameraModel::kBrownConrady, c.camera.width, c.camera.height,
                                      c.camera.fx, {-3.0, 0.0, 0.0, 0.0});
              }),
              Contains("camera_corners"));
}

TEST(InputSheet, FlagsATruthWhoseSigmaExceedsTheRequirement) {
  const auto with_sigma = [](double sigma_m) {
    return flagsWith([sigma_m](SessionCase& session_case) {
      Matrix6d covariance = 1e-12 * Matrix6d::Identity();
      covariance.bottomRightCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
      sessions::setTruth(session_case, session_case.camera_from_station_seed, covariance);
    });
  };
  EXPECT_THAT(with_sigma(1e-5), Not(Contains("truth_uncertain")));
  EXPECT_THAT(with_sigma(5e-3), Contains("truth_uncertain"));
}

/// The example with its pixels changed, since a file with other pixels would be refused.
template <class Change>
InputSheet sheetWithPixels(Change&& change) {
  const auto loaded = sessions::loadCase(exampleOs());
  sessions::LoadedCase changed;
  changed.source = loaded->source;
  changed.scene = loaded->scene;
  changed.image = loaded->image;
  for (std::uint8_t& gray : changed.image.pixels) gray = static_cast<std::uint8_t>(change(gray));
  return sessions::inputSheet(changed);
}

TEST(InputSheet, ImageThatCannotCarryAPose_IsFlagged) {
  EXPECT_THAT(codes(sheetWithPixels([](std::uint8_t) { return 255; }).flags),
              AllOf(Contains("image_overexposed"), Contains("image_flat")));
  EXPECT_THAT(codes(sheetWithPixels([](std::uint8_t gray) { return 100 + gray / 64; }).flags),
              AllOf(Contains("image_flat"), Not(Contains("image_overexposed"))));
  const InputSheet same = sheetWithPixels([](std::uint8_t gray) { return gray; });
  EXPECT_THAT(codes(same.flags), testing::ElementsAre("image_saturated"));
  EXPECT_THAT(lineOf(same, "image at the seed"), testing::StartsWith("noise "));
}

TEST(InputSheet, TellsTheInsideOfASurface) {
  const sessions::SceneMesh scene = ExampleCase("os").scene;
  // A cube of two triangles a side, from -1 to 1.
  sessions::SceneMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices_in_station_m.emplace_back(i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f,
                                            i & 4 ? 1.f : -1.f);
  for (const auto& quad :
       {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
        std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    cube.faces.push_back({{quad[0], quad[1], quad[2]}});
    cube.faces.push_back({{quad[0], quad[2], quad[3]}});
  }
  cube.part_of_face.assign(cube.faces.size(), 0);
  cube.parts.resize(1);
  Random random = randomFor("cube");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = randomVector(random, 2.0);
    EXPECT_EQ(sessions::isInside(cube.view(), point), point.cwiseAbs().maxCoeff() < 1.0);
  }
  EXPECT_FALSE(sessions::isInside(scene.view(), {0.0, 0.0, 10.0}));
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
  EXPECT_TRUE(sessions::looksLikeMosaic({raw.data(), 200, 150, 200}));
  Random random = randomFor("noise");
  std::vector<std::uint8_t> noise(200 * 150);
  for (std::uint8_t& pixel : noise) pixel = static_cast<std::uint8_t>(random.below(256));
  EXPECT_FALSE(sessions::looksLikeMosaic({noise.data(), 200, 150, 200}));
  EXPECT_FALSE(sessions::looksLikeMosaic({noise.data(), 2, 2, 2}));
  for (const char* station : {"bc", "os"})
    EXPECT_FALSE(sessions::looksLikeMosaic(ExampleCase(station).image.view())) << station;
}

TEST(InputSheet, SaysHowWellMeshAndCameraAreKnownAndWhetherThatIsAssumed) {
  SessionCase session_case = exampleOs();
  const auto sheet = [&session_case] {
    return sessions::inputSheet(*sessions::loadCase(session_case));
  };
  EXPECT_EQ(lineOf(sheet(), "scale, one sigma"), "0.02 %, assumed");
  EXPECT_THAT(lineOf(sheet(), "calibration, one sigma"),
              testing::StartsWith("0.02 % and 0.25 px, assumed"));
  session_case.mesh_scale_sigma = 0.001;
  EXPECT_EQ(lineOf(sheet(), "scale, one sigma"), "0.1 %");
}

TEST(InputSheet, FlagsSixteenBitsWithoutARule) {
  const TemporaryFolder folder;
  cv::Mat image(100, 100, CV_16UC1);
  for (int i = 0; i < 10000; ++i)
    image.at<std::uint16_t>(i / 100, i % 100) = static_cast<std::uint16_t>(i / 3);
  cv::imwrite((folder / "16.png").string(), image);
  EXPECT_THAT(codes(sessions::imageSheet(sessions::readImage(folder / "16.png")).flags),
              Contains("image_bit_depth"));
  sessions::ImageReadOptions stated;
  stated.bit_depth = 12;
  EXPECT_THAT(codes(sessions::imageSheet(sessions::readImage(folder / "16.png", stated)).flags),
              IsEmpty());
}

TEST(ReadImage, TakesAGivenTable) {
  const TemporaryFolder folder;
  cv::Mat image(1, 4, CV_16UC1);
  for (int i = 0; i < 4; ++i) image.at<std::uint16_t>(0, i) = static_cast<std::uint16_t>(i);
  cv::imwrite((folder / "t.png").string(), image);
  sessions::ImageReadOptions options;
  options.bit_depth = 2;
  options.table = {9, 7, 200, 3};
  const sessions::GrayImage read = sessions::readImage(folder / "t.png", options);
  EXPECT_EQ(read.pixels, options.table);
  EXPECT_EQ(read.rule, "by a given table of 4 values");
  options.table.pop_back();
  EXPECT_EQ(folder.message([&] { (void)sessions::readImage(folder / "t.png", options); }),
            "t.png: table: has 3 entries, but 2 bits need 4");
}

}  // namespace
}  // namespace boresight::test
