// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/labels/image_label.h"
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
  EXPECT_EQ(lineOf(sheet, "symmetries"), "none");
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

/// Text of a flag; "" without it.
std::string textOf(const std::vector<RedFlag>& flags, const std::string& code) {
  for (const RedFlag& flag : flags)
    if (flag.code == code) return flag.text;
  return "";
}

/// A box of 40 cm that fills half of the image's width, with a share of its pixels saturated, and
/// gray levels from 100 to 100 + range.
std::vector<RedFlag> flagsOfGrays(double saturated_share, int range) {
  LoadedCase loaded;
  loaded.source = loadedOs().source;
  loaded.source.camera = makePinhole(200, 200, 200.0);
  loaded.scene = boxMesh({0.2, 0.2, 0.2});
  loaded.source.camera_from_station_seed = Pose();
  loaded.source.camera_from_station_seed.translation_m.z() = 1.0;
  loaded.image.width = loaded.image.height = 200;
  for (int i = 0; i < 200 * 200; ++i) {
    const int gray = 100 + i % (range + 1);
    loaded.image.pixels.push_back(
        static_cast<std::uint8_t>((i * 37) % 1000 < 1000.0 * saturated_share ? 255 : gray));
  }
  return inputSheet(loaded).flags;
}

TEST(InputSheet, QualityAtTheSeed_IsFlaggedWithItsFigures) {
  const auto overexposed = [](double share) {
    return textOf(flagsOfGrays(share, 60), "image_overexposed");
  };
  EXPECT_EQ(overexposed(0.70), "");
  EXPECT_THAT(overexposed(0.90),
              AllOf(HasSubstr("position of the station 90 % of the pixels are saturated: ")));
  const auto flat = [](int range) { return textOf(flagsOfGrays(0.0, range), "image_flat"); };
  EXPECT_EQ(flat(14), "");
  EXPECT_THAT(flat(6), HasSubstr("pixels span 6 gray levels: "));
}

TEST(InputSheet, SmallOrFarStation_IsFlaggedWithItsSize) {
  LoadedCase loaded;
  loaded.source = loadedOs().source;
  loaded.source.camera = makePinhole(1000, 1000, 1000.0);
  loaded.image.width = loaded.image.height = 1000;
  loaded.image.pixels.assign(1000 * 1000, 90);
  loaded.scene = boxMesh({0.1, 0.1, 0.1});  // 0.3464 m from corner to corner
  const auto small = [&loaded](double distance_m) {
    loaded.source.camera_from_station_seed = Pose();
    loaded.source.camera_from_station_seed.translation_m.z() = distance_m;
    return textOf(inputSheet(loaded).flags, "station_small");
  };
  EXPECT_EQ(small(14.4), "");
  EXPECT_THAT(small(14.5), StartsWith("the station would be only 23.9 px large"));
  loaded.source.camera_from_station_seed.translation_m.z() = 2.5;
  loaded.scene = boxMesh({0.1, 0.2, 0.15});
  const InputSheet sheet = inputSheet(loaded);
  EXPECT_EQ(lineOf(sheet, "station"),
            "200.0 x 400.0 x 300.0 mm; the view is 2500.0 mm wide at its distance");
  EXPECT_EQ(lineOf(sheet, "seed"), "2.5000 m from the camera to the station's middle");
  EXPECT_EQ(lineOf(sheet, "field of view"), "53.08 x 53.08 deg");
  EXPECT_EQ(lineOf(sheet, "gray"), "90 .. 90, 0.00 % saturated");
}

/// 1000 pixels: `high` of them in one gray level, the others in another one.
GrayImage twoGrays(std::uint8_t low, std::uint8_t high, std::size_t high_count) {
  GrayImage image;
  image.width = 50;
  image.height = 20;
  image.pixels.assign(1000, low);
  std::fill_n(image.pixels.begin(), high_count, high);
  return image;
}

TEST(ImageSheetTest, Grays_AreMeasuredAndFlaggedBeyondTheirLimits) {
  const ImageSheet sheet = imageSheet(twoGrays(10, 255, 20));
  EXPECT_EQ(sheet.lowest_gray, 10);
  EXPECT_EQ(sheet.highest_gray, 255);
  EXPECT_DOUBLE_EQ(sheet.saturated_share, 0.02);
  EXPECT_THAT(codes(sheet.flags), IsEmpty()) << "two percent";
  const ImageSheet saturated = imageSheet(twoGrays(10, 255, 21));
  EXPECT_THAT(codes(saturated.flags), ElementsAre("image_saturated"));
  EXPECT_THAT(saturated.flags[0].text, StartsWith("2.1 % of the image is saturated"));
  EXPECT_THAT(codes(imageSheet(twoGrays(10, 254, 500)).flags), IsEmpty());
  EXPECT_THAT(codes(imageSheet(twoGrays(10, 74, 500)).flags), IsEmpty());
  EXPECT_THAT(codes(imageSheet(twoGrays(10, 73, 500)).flags), ElementsAre("image_few_grays"));
}

TEST(ImageSheetTest, BitDepth_IsAskedForWhereNothingStatesIt) {
  GrayImage image = twoGrays(10, 200, 500);
  EXPECT_THAT(codes(imageSheet(image).flags), IsEmpty());
  image.sample_bits = 16;
  EXPECT_THAT(codes(imageSheet(image).flags), ElementsAre("image_bit_depth"));
  image.bit_depth_stated = true;
  EXPECT_THAT(codes(imageSheet(image).flags), IsEmpty());
  image.bit_depth_stated = false;
  image.bit_depth_of_label = true;
  EXPECT_THAT(codes(imageSheet(image).flags), IsEmpty());
  image.notes = {"one", "two"};
  EXPECT_THAT(imageSheet(image).flags,
              ElementsAre(RedFlag{"image_note", "one"}, RedFlag{"image_note", "two"}));
}

/// Stripes of one pixel alternate along one direction alone.
TEST(InputSheet, StripesAreNoMosaic) {
  std::vector<std::uint8_t> rows;
  std::vector<std::uint8_t> columns;
  std::vector<std::uint8_t> board;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      rows.push_back(y % 2 == 0 ? 200 : 50);
      columns.push_back(x % 2 == 0 ? 200 : 50);
      board.push_back((x + y) % 2 == 0 ? 200 : 50);
    }
  EXPECT_FALSE(looksLikeMosaic({rows.data(), 40, 40, 40}));
  EXPECT_FALSE(looksLikeMosaic({columns.data(), 40, 40, 40}));
  EXPECT_TRUE(looksLikeMosaic({board.data(), 40, 40, 40}));
  EXPECT_TRUE(looksLikeMosaic({board.data(), 3, 3, 40}));
  const std::vector<std::uint8_t> flat(1600, 90);
  EXPECT_FALSE(looksLikeMosaic({flat.data(), 40, 40, 40}));
}

/// A pinhole's field of view is known in closed form.
TEST(CameraSheetTest, FieldOfView_IsThatOfThePinhole) {
  Camera camera = makePinhole(800, 600, 1000.0);
  camera.fy = 1015.0;
  camera.cx = 350.0;
  const CameraSheet sheet = cameraSheet(camera);
  const auto angle_deg = [](double before_px, double after_px, double focal_px) {
    return (std::atan(before_px / focal_px) + std::atan(after_px / focal_px)) / kDegree_rad;
  };
  EXPECT_NEAR(sheet.field_of_view_x_deg, angle_deg(350.0, 449.0, 1000.0), 1e-9);
  EXPECT_NEAR(sheet.field_of_view_y_deg, angle_deg(299.5, 299.5, 1015.0), 1e-9);
  EXPECT_THAT(codes(sheet.flags), IsEmpty());
  ASSERT_EQ(sheet.lines.size(), 2u);
  EXPECT_THAT(sheet.lines[0], HasSubstr("800 x 600 px, fx 1000.000, fy 1015.000, cx 350.000, cy "
                                        "299.500"));
  EXPECT_THAT(sheet.lines[1],
              AllOf(StartsWith("field of view 43.47 x 32.88 deg"), HasSubstr("diagonal 5"),
                    testing::EndsWith("; 1 px is 1.000 mm at 1 m")));
}

TEST(CameraSheetTest, Camera_IsFlaggedBeyondItsLimits) {
  const Camera good = makePinhole(1001, 501, 1000.0);
  const auto flags = [&good](const std::function<void(Camera&)>& edit) {
    Camera camera = good;
    edit(camera);
    return codes(cameraSheet(camera).flags);
  };
  const auto off_centre = ElementsAre("camera_off_centre");
  const auto aspect = ElementsAre("camera_aspect");
  for (const double side : {-1.0, 1.0}) {
    EXPECT_THAT(flags([side](Camera& camera) { camera.cx += side * 100.0; }), IsEmpty());
    EXPECT_THAT(flags([side](Camera& camera) { camera.cx += side * 101.0; }), off_centre);
    EXPECT_THAT(flags([side](Camera& camera) { camera.cy += side * 50.0; }), IsEmpty());
    EXPECT_THAT(flags([side](Camera& camera) { camera.cy += side * 51.0; }), off_centre);
  }
  EXPECT_THAT(flags([](Camera& camera) { camera.fy = 981.0; }), IsEmpty());
  EXPECT_THAT(flags([](Camera& camera) { camera.fy = 979.0; }), aspect);
  EXPECT_THAT(flags([](Camera& camera) { camera.fy = 1019.0; }), IsEmpty());
  EXPECT_THAT(flags([](Camera& camera) { camera.fy = 1021.0; }), aspect);
  // 2 atan(500 / 233) is 130 degrees.
  EXPECT_THAT(flags([](Camera& camera) { camera.fx = camera.fy = 235.0; }), IsEmpty());
  EXPECT_THAT(flags([](Camera& camera) { camera.fx = camera.fy = 231.0; }),
              ElementsAre("camera_wide"));
  EXPECT_THAT(codes(cameraSheet(makeCamera(CameraModel::kKannalaBrandt, 1001, 501, 350.0)).flags),
              Not(Contains("camera_wide")))
      << "a fisheye may be wide";
}

TEST(InputSheet, CameraInsideTheStation_IsFlagged) {
  LoadedCase loaded;
  loaded.source = loadedOs().source;
  loaded.image = loadedOs().image;
  loaded.scene = boxMesh({1.0, 1.0, 1.0});
  const auto flags = [&loaded](double z_m) {
    loaded.source.camera_from_station_seed = Pose();
    loaded.source.camera_from_station_seed.translation_m.z() = z_m;
    return codes(inputSheet(loaded).flags);
  };
  EXPECT_THAT(flags(0.5), Contains("camera_in_station"));
  EXPECT_THAT(flags(3.0), Not(Contains("camera_in_station")));
}

TEST(InputSheet, PartThatIsNotMatched_HasNoInside) {
  SceneMesh cube = boxMesh({1.0, 1.0, 1.0});
  EXPECT_TRUE(isInside(cube.view(), {0.1, 0.2, 0.3}));
  cube.parts[0].match = false;
  EXPECT_FALSE(isInside(cube.view(), {0.1, 0.2, 0.3}));
}

/// Lines of the example with what the file, the case and the camera say.
TEST(InputSheet, Lines_DescribeEachInput) {
  const SessionCase& item = loadedOs().source;
  const InputSheet sheet = inputSheet(loadedOs());
  const std::string size =
      std::to_string(item.camera.width) + " x " + std::to_string(item.camera.height) + " px";
  EXPECT_THAT(lineOf(sheet, "image"),
              AllOf(StartsWith("PNG, " + size + ", "), HasSubstr(" channels, 8 bit; ")));
  EXPECT_THAT(lineOf(sheet, "camera"), testing::EndsWith(", " + size));
  EXPECT_THAT(lineOf(sheet, "gray"),
              testing::MatchesRegex("[0-9]+ \\.\\. 255, 4\\.[0-9]+ % saturated"));
  EXPECT_THAT(lineOf(sheet, "mesh"),
              AllOf(StartsWith("model.ply, PLY in m, "), testing::EndsWith(" mm across")));
  EXPECT_THAT(lineOf(sheet, "truth"), StartsWith("given, truth.json"));
  EXPECT_EQ(lineOf(sheet, "ignored"), "");
  const BoundingBox bounds = matchedBounds(loadedOs().scene.view());
  EXPECT_NEAR(std::stod(lineOf(sheet, "station")), 1e3 * (bounds.maximum_m - bounds.minimum_m).x(),
              0.051);
  LoadedCase without_seed;
  without_seed.source = item;
  without_seed.source.has_seed = false;
  without_seed.scene = loadedOs().scene;
  without_seed.image = loadedOs().image;
  const InputSheet unseeded = inputSheet(without_seed);
  EXPECT_EQ(lineOf(unseeded, "seed"), "none");
  EXPECT_THAT(lineOf(unseeded, "station"), Not(HasSubstr("the view is")));
  EXPECT_THAT(codes(unseeded.flags), ElementsAre("image_saturated"));
}

/// Of an ignored quarter of the image, and a truth that is another file's.
TEST(InputSheet, IgnoredPixelsAndPart_HaveTheirLines) {
  SessionCase item = loadedOs().source;
  const double side = item.camera.width;
  MaskStroke quarter;
  quarter.kind = StrokeKind::kPolygon;
  quarter.points = {{-1.0, -1.0},
                    {0.5 * side - 0.5, -1.0},
                    {0.5 * side - 0.5, 0.5 * side - 0.5},
                    {-1.0, 0.5 * side - 0.5}};
  item.ignore_strokes = {quarter};
  const InputSheet sheet = inputSheet(*reloadCase(loadedOs(), item));
  EXPECT_EQ(lineOf(sheet, "ignored"), std::to_string(item.camera.width * item.camera.width / 4) +
                                          " px, 25.00 % of the image");
  EXPECT_NE(lineOf(sheet, "part"), "");
  const BoundingBox bounds = matchedBounds(loadedOs().scene.view());
  EXPECT_NEAR(std::stod(lineOf(sheet, "seed")),
              (item.camera_from_station_seed * bounds.centre()).norm(), 0.5001e-4);
  EXPECT_NEAR(std::stod(lineOf(sheet, "mesh").substr(lineOf(sheet, "mesh").find("in m, ") + 6)),
              1e3 * loadedOs().scene.infos[0].diagonal_m(), 0.051);
}

TEST(InputSheet, LabelLines_SayWhatTheLabelStates) {
  ImageLabel label;
  label.format = "PDS3";
  label.identifiers = {{"PRODUCT_ID", "A"}};
  label.camera_remark = "no camera model";
  const auto value = [&label](const char* name) {
    InputSheet sheet;
    sheet.lines = labelLines(label);
    return lineOf(sheet, name);
  };
  EXPECT_EQ(value("label"), "PDS3");
  EXPECT_EQ(value("PRODUCT_ID"), "A");
  EXPECT_EQ(value("label's camera"), "no camera model");
  EXPECT_EQ(value("sub-frame"), "not stated");
  EXPECT_EQ(value("bit depth"), "");
  label.bit_depth = 12;
  EXPECT_EQ(value("bit depth"), "12 bits by the label");
  LabelSubframe& part = label.subframe.emplace();
  part.first_sample = 16;
  part.first_line = 32;
  part.samples_per_pixel = part.lines_per_pixel = 1.0;
  EXPECT_EQ(value("sub-frame"),
            "begins at sample 16, line 32 of the detector (from 0), not down-sampled");
  part.lines_per_pixel = 2.0;
  EXPECT_THAT(value("sub-frame"), testing::EndsWith("each pixel is 1.00 x 2.00 of the detector's"));
  part.samples_per_pixel = 2.0;
  part.lines_per_pixel = 1.0;
  EXPECT_THAT(value("sub-frame"), testing::EndsWith("each pixel is 2.00 x 1.00 of the detector's"));
}

}  // namespace
}  // namespace boresight::test
