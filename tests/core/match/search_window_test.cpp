// SPDX-License-Identifier: Apache-2.0
#include "core/match/search_window.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "tests/core/match/match_support.h"
#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

Camera pinhole() { return makePinhole(2048, 2048, 3100.0); }

Camera prepared(Camera camera) {
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera brownConrady(std::initializer_list<double> distortion = {-0.25, 0.12, 0.0008, -0.0006,
                                                                -0.03}) {
  Camera camera = makeCamera(CameraModel::kBrownConrady, 2048, 2048, 1500.0, distortion);
  camera.fy = 1480.0;
  return prepared(camera);
}

/// Sees a disc in the middle of its image only: beyond it the distortion folds back.
Camera narrowField() {
  return prepared(makeCamera(CameraModel::kBrownConrady, 2048, 2048, 700.0, {-0.3}));
}

Camera rational() { return brownConrady({6.1, 3.2, 0.0003, 0.0002, 0.15, 6.4, 4.6, 0.7}); }

Camera fisheye() {
  return prepared(
      makeCamera(CameraModel::kKannalaBrandt, 2048, 2048, 700.0, {-0.02, 0.006, -0.003, 0.0004}));
}

/// Image axes 10 deg from square, y up the image.
Camera skewCahvor() {
  Camera camera = pinhole();
  camera.model = CameraModel::kCahvor;
  camera.fx = 1500.0;
  camera.fy = -1480.0;
  camera.cahv.skew_px = 260.0;
  camera.cahv.optical_axis = Eigen::Vector3d(0.02, -0.01, 1.0).normalized();
  camera.cahv.radial = {0.001, -0.12, 0.03};
  return prepared(camera);
}

/// The entrance pupil moves by 4 mm over the image, at a third of a metre.
Camera hazardCahvore() {
  Camera camera = pinhole();
  camera.model = CameraModel::kCahvore;
  camera.fx = camera.fy = 900.0;
  camera.cahv.optical_axis = Eigen::Vector3d(-0.002, 0.001, 1.0).normalized();
  camera.cahv.radial = {0.000002, 0.0075, -0.0056};
  camera.cahv.entrance_m = {0.026, 0.0004, -0.0045};
  camera.cahv.linearity = 0.37;
  return prepared(camera);
}

SeedUncertainty uncertaintyOf(double translation_m, const Eigen::Vector3d& rotation_deg,
                              const Eigen::Vector3d& pivot_in_camera_m) {
  SeedUncertainty uncertainty;
  uncertainty.translation_m.setConstant(translation_m);
  uncertainty.rotation_rad = rotation_deg * kDegree_rad;
  uncertainty.pivot_in_camera_m = pivot_in_camera_m;
  return uncertainty;
}

/// Anywhere in +-half, half of the time at one of its ends.
double inBox(double half, Dice& dice) {
  const int kind = dice.below(4);
  if (kind == 0) return half;
  if (kind == 1) return -half;
  return dice.uniform(-half, half);
}

Eigen::Vector3d displaced(const Eigen::Vector3d& point, const SeedUncertainty& uncertainty,
                          Dice& dice) {
  Eigen::Vector3d r, t;
  for (int i = 0; i < 3; ++i) {
    r[i] = inBox(uncertainty.rotation_rad[i], dice);
    t[i] = inBox(uncertainty.translation_m[i], dice);
  }
  const Eigen::Vector3d& c = uncertainty.pivot_in_camera_m;
  return rotationExp(r) * (point - c) + c + t;
}

struct Tally {
  long inside_image = 0, outside_window = 0;
  double ratio_sum = 0.0;
  int ratios = 0;
};

/// Projects `samples` displaced points; counts those that the window misses although their
/// template lies inside the image, and compares areas where the window is not clipped.
void sample(const Camera& camera, const Eigen::Vector3d& point, const SeedUncertainty& uncertainty,
            int samples, Dice& dice, Tally& tally) {
  constexpr int kSide = 8, kHalf = kSide / 2;
  const SearchWindow window = searchWindow(camera, point, uncertainty, kSide);
  Eigen::AlignedBox2d places;
  const Eigen::AlignedBox2d within_window(Eigen::Vector2d(window.x_min, window.y_min),
                                          Eigen::Vector2d(window.x_max, window.y_max));
  const Eigen::AlignedBox2d within_image(
      Eigen::Vector2d::Constant(kHalf),
      Eigen::Vector2d(camera.width - kHalf, camera.height - kHalf));
  for (int k = 0; k < samples; ++k) {
    Eigen::Vector2d pixel;
    if (!project(camera, displaced(point, uncertainty, dice), pixel)) continue;
    places.extend(pixel);
    if (!within_image.contains(pixel)) continue;
    ++tally.inside_image;
    tally.outside_window += within_window.contains(pixel) ? 0 : 1;
  }
  const bool clipped = window.x_min <= kHalf || window.y_min <= kHalf ||
                       window.x_max >= camera.width - kHalf ||
                       window.y_max >= camera.height - kHalf;
  if (clipped || window.empty()) return;
  const double area = static_cast<double>(window.width()) * window.height();
  const Eigen::Vector2d least = places.max().array().ceil() - places.min().array().floor() + 1.0;
  tally.ratio_sum += area / least.prod();
  ++tally.ratios;
}

/// A point that the camera sees, 0.3 ... 0.6 m away.
Eigen::Vector3d visiblePoint(const Camera& camera, double margin_px, Dice& dice) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const Eigen::Vector2d pixel(dice.uniform(margin_px, camera.width - 1 - margin_px),
                                dice.uniform(margin_px, camera.height - 1 - margin_px));
    Ray ray;
    if (unprojectRay(camera, pixel, ray) && ray.direction.head<2>().norm() < 1.5) {
      return ray.at(dice.uniform(0.3, 0.6));
    }
  }
  ADD_FAILURE() << "the camera sees nothing";
  return {0.0, 0.0, 0.5};
}

struct Setting {
  std::string name;
  Camera camera;
  Eigen::Vector3d rotation_deg;
  double translation_m;
  double margin_px;
  double largest_mean_ratio;
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

class SearchWindowOf : public testing::TestWithParam<Setting> {};

std::vector<Setting> settings() {
  const Eigen::Vector3d usual(5.0, 5.0, 5.0), tube(5.5, 5.5, 40.0), wide(20.0, 15.0, 25.0);
  const Eigen::Vector3d small(1.25, 1.25, 1.25);
  return {{"pinhole", pinhole(), usual, 0.03, 600.0, 1.05},
          {"brownConrady", brownConrady(), usual, 0.03, 100.0, 1.15},
          {"rational", rational(), usual, 0.03, 100.0, 1.15},
          {"fisheye", fisheye(), usual, 0.03, 300.0, 1.25},
          {"pinholeSmall", pinhole(), small, 0.0075, 200.0, 1.05},
          {"pinholeTube", pinhole(), tube, 0.02, 600.0, 1.15},
          {"brownConradyTube", brownConrady(), tube, 0.02, 300.0, 1.2},
          {"fisheyeWide", fisheye(), wide, 0.03, 500.0, 1.4},
          {"narrowField", narrowField(), usual, 0.03, 5.0, 1.25},
          {"skewCahvor", skewCahvor(), usual, 0.03, 100.0, 1.3},
          {"hazardCahvore", hazardCahvore(), usual, 0.03, 300.0, 1.3},
          {"hazardCahvoreSmall", hazardCahvore(), small, 0.0075, 100.0, 1.5}};
}

TEST_P(SearchWindowOf, ContainsEveryPlaceAndLittleMore) {
  const Setting& setting = GetParam();
  Dice dice;
  Tally tally;
  constexpr int kPoints = 100, kSamples = 1000;
  for (int k = 0; k < kPoints; ++k) {
    // Half of the points anywhere in the image, so that windows are clipped; pivots at the camera
    // and at the station.
    const double margin_px = k % 2 == 0 ? setting.margin_px : 5.0;
    const Eigen::Vector3d point = visiblePoint(setting.camera, margin_px, dice);
    const Eigen::Vector3d pivot =
        k % 4 < 2 ? Eigen::Vector3d(0.0, 0.0, 0.0)
                  : Eigen::Vector3d(dice.uniform(-0.05, 0.05), dice.uniform(-0.05, 0.05), 0.45);
    const SeedUncertainty uncertainty =
        uncertaintyOf(setting.translation_m, setting.rotation_deg, pivot);
    sample(setting.camera, point, uncertainty, kSamples, dice, tally);
  }
  EXPECT_EQ(tally.outside_window, 0);
  EXPECT_GT(tally.inside_image, kPoints * kSamples / 3);
  ASSERT_GT(tally.ratios, 10);
  const double mean_ratio = tally.ratio_sum / tally.ratios;
  EXPECT_LT(mean_ratio, setting.largest_mean_ratio);
  EXPECT_GE(mean_ratio, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Cameras, SearchWindowOf, testing::ValuesIn(settings()),
                         [](const auto& instance) { return instance.param.name; });

TEST(SearchWindow, WithoutUncertaintyIsThePixelsAroundTheProjection) {
  const SeedUncertainty none = uncertaintyOf(0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (const Camera& camera : {pinhole(), brownConrady(), fisheye()}) {
    const Eigen::Vector3d point(0.03, -0.05, 0.5);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, point, pixel));
    const SearchWindow window = searchWindow(camera, point, none, 64);
    EXPECT_EQ(window.x_min, std::floor(pixel.x()));
    EXPECT_EQ(window.x_max, std::floor(pixel.x()) + 1);
    EXPECT_EQ(window.y_min, std::floor(pixel.y()));
    EXPECT_EQ(window.y_max, std::floor(pixel.y()) + 1);
  }
}

TEST(SearchWindow, TranslationOfAPinholeIsExact) {
  const Camera camera = pinhole();
  SeedUncertainty uncertainty = uncertaintyOf(0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  uncertainty.translation_m = {0.01, 0.02, 0.03};
  const Eigen::Vector3d point(0.05, -0.04, 0.5);
  const SearchWindow window = searchWindow(camera, point, uncertainty, 64);
  EXPECT_EQ(window.x_max, std::floor(3100.0 * 0.06 / 0.47 + 1023.5) + 1);
  EXPECT_EQ(window.x_min, std::floor(3100.0 * 0.04 / 0.53 + 1023.5));
  EXPECT_EQ(window.y_min, std::floor(3100.0 * -0.06 / 0.47 + 1023.5));
  EXPECT_EQ(window.y_max, std::floor(3100.0 * -0.02 / 0.53 + 1023.5) + 1);
}

TEST(SearchWindow, KeepsTheTemplateInsideTheImage) {
  const Camera camera = pinhole();
  const SeedUncertainty uncertainty = uncertaintyOf(0.03, {5.0, 5.0, 5.0}, {0.0, 0.0, 0.0});
  const SearchWindow window = searchWindow(camera, {0.16, 0.16, 0.5}, uncertainty, 128);
  EXPECT_EQ(window.x_max, 2048 - 64);
  EXPECT_EQ(window.y_max, 2048 - 64);
  EXPECT_FALSE(window.empty());
  const SearchWindow corner = searchWindow(camera, {-0.16, -0.16, 0.5}, uncertainty, 128);
  EXPECT_EQ(corner.x_min, 64);
  EXPECT_EQ(corner.y_min, 64);
  EXPECT_TRUE(searchWindow(camera, {1.0, 0.0, 0.5}, uncertainty, 128).empty());
  EXPECT_TRUE(searchWindow(camera, {0.0, 0.0, 0.5}, uncertainty, 4096).empty());
  const SearchWindow whole = searchWindow(camera, {0.0, 0.0, 0.5}, uncertainty, 2048);
  EXPECT_EQ(whole.x_min, 1024);
  EXPECT_EQ(whole.x_max, 1024);
}

TEST(SearchWindow, IsEmptyWhenThePointMayComeToLieBehindTheCamera) {
  const Camera camera = pinhole();
  const SeedUncertainty uncertainty = uncertaintyOf(0.03, {5.0, 5.0, 5.0}, {0.0, 0.0, 0.0});
  EXPECT_TRUE(searchWindow(camera, {0.0, 0.0, 0.02}, uncertainty, 16).empty());
  EXPECT_TRUE(searchWindow(camera, {0.0, 0.0, -0.5}, uncertainty, 16).empty());
  EXPECT_FALSE(searchWindow(camera, {0.0, 0.0, 0.05}, uncertainty, 16).empty());
  Dice dice;
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d near(dice.uniform(-0.03, 0.03), dice.uniform(-0.03, 0.03),
                               dice.uniform(0.0, 0.03));
    EXPECT_TRUE(searchWindow(camera, near, uncertainty, 16).empty());
    EXPECT_TRUE(searchWindow(fisheye(), near, uncertainty, 16).empty());
  }
  const SeedUncertainty any = uncertaintyOf(0.03, {180.0, 180.0, 180.0}, {0.0, 0.0, 0.0});
  EXPECT_TRUE(searchWindow(camera, {0.0, 0.0, 0.5}, any, 16).empty());
}

TEST(SearchWindow, HoldsAnyRotationAboutAPivotInFront) {
  // A point that may turn anywhere about a pivot half a metre away stays in front.
  const Camera camera = pinhole();
  const Eigen::Vector3d pivot(0.0, 0.0, 0.5), point(0.03, 0.0, 0.5);
  const SeedUncertainty uncertainty = uncertaintyOf(0.0, {180.0, 180.0, 180.0}, pivot);
  const SearchWindow window = searchWindow(camera, point, uncertainty, 16);
  Dice dice;
  Tally tally;
  sample(camera, point, uncertainty, 20000, dice, tally);
  EXPECT_EQ(tally.outside_window, 0);
  EXPECT_EQ(tally.inside_image, 20000);
  EXPECT_LT(window.width(), 2 * 300);
}

TEST(SearchWindow, HoldsARotationAboutOneAxisWhereAnotherWouldDoNothing) {
  // Turning a point of the optical axis about that axis moves nothing, but widens the box.
  Camera camera = pinhole();
  camera.width = camera.height = 8192;
  camera.fx = camera.fy = 20000.0;
  camera.cx = camera.cy = 4095.5;
  const SeedUncertainty uncertainty = uncertaintyOf(0.0, {0.0, 5.0, 40.0}, {0.0, 0.0, 0.0});
  const SearchWindow window = searchWindow(camera, {0.0, 0.0, 0.5}, uncertainty, 16);
  const double reach_px = camera.fx * tan(5.0 * kDegree_rad);
  EXPECT_GE(window.x_max, camera.cx + reach_px);
  EXPECT_LE(window.x_min, camera.cx - reach_px);
}

TEST(SearchWindow, IsEmptyForNonsense) {
  const SeedUncertainty usual = uncertaintyOf(0.03, {5.0, 5.0, 5.0}, {0.0, 0.0, 0.0});
  const Eigen::Vector3d point(0.0, 0.0, 0.5);
  const auto isEmpty = [](const Eigen::Vector3d& at, const SeedUncertainty& uncertainty, int side) {
    return searchWindow(brownConrady(), at, uncertainty, side).empty();
  };
  ASSERT_FALSE(isEmpty(point, usual, 16));
  EXPECT_TRUE(isEmpty({kNan, 0.0, 0.5}, usual, 16));
  EXPECT_TRUE(isEmpty({0.0, 0.0, kInfinity}, usual, 16));
  EXPECT_TRUE(isEmpty(point, usual, 0));
  EXPECT_TRUE(isEmpty(point, usual, -16));
  for (const double bad : {kNan, kInfinity, -0.01}) {
    SeedUncertainty translation = usual, rotation = usual;
    translation.translation_m.y() = bad;
    rotation.rotation_rad.z() = bad;
    EXPECT_TRUE(isEmpty(point, translation, 16));
    EXPECT_TRUE(isEmpty(point, rotation, 16));
  }
  EXPECT_TRUE(isEmpty(point, uncertaintyOf(0.03, {5.0, 5.0, 5.0}, {kNan, 0.0, 0.0}), 16));
}

}  // namespace
}  // namespace boresight::test
