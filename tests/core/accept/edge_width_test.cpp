// SPDX-License-Identifier: Apache-2.0
#include "core/accept/edge_width.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// Gray values from `low` to `low + height` over `width_px` about the middle, across a normal.
Picture rampPicture(const Eigen::Vector2d& normal, double width_px, double low, double height) {
  Picture picture = flatPicture(121, 121, 0);
  for (int y = 0; y < 121; ++y)
    for (int x = 0; x < 121; ++x) {
      const double along = normal.dot(Eigen::Vector2d(x - 60, y - 60)) / width_px + 0.5;
      picture.gray[static_cast<std::size_t>(y * 121 + x)] =
          static_cast<std::uint8_t>(std::lround(low + height * std::clamp(along, 0.0, 1.0)));
    }
  return picture;
}

EdgeWidth widthAt(const Picture& picture, const Eigen::Vector2d& place_px,
                  const Eigen::Vector2d& normal, const BitImage* ignore = nullptr) {
  EdgeWidthMeter meter(picture.view(), ignore);
  meter.add(place_px, normal);
  return meter.width();
}

TEST(EdgeWidth, Ramps_HaveTheirWidthInTheirDirection) {
  for (std::size_t direction = 0; direction < 8; ++direction)
    for (const double width_px : {4.0, 8.0, 12.5, 20.0, 40.0})
      for (const double sign : {1.0, -1.0}) {
        const double angle = static_cast<double>(direction) * kPi / 8.0;
        const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
        const Picture picture = rampPicture(sign * normal, width_px, 20.0, 200.0);
        const EdgeWidth width =
            widthAt(picture, Eigen::Vector2d(60.0, 60.0) + 2.0 * normal, normal);
        for (std::size_t d = 0; d < 8; ++d) EXPECT_EQ(width.places[d], d == direction ? 1 : 0);
        // Rounded to gray values; at most the last of 128 bins of a quarter pixel.
        EXPECT_NEAR(width.width_px[direction], std::min(31.875, width_px), 0.125 + 0.08 * width_px)
            << direction;
      }
}

TEST(EdgeWidth, Profile_CountsInsideTheImageWhereNothingIsIgnored) {
  const Eigen::Vector2d x_axis(1.0, 0.0);
  const Eigen::Vector2d y_axis(0.0, 1.0);
  const auto counts = [](const Picture& picture, double x, double y, const Eigen::Vector2d& normal,
                         const BitImage* ignore = nullptr) {
    return widthAt(picture, {x, y}, normal, ignore).places[normal.x() == 0.0 ? 4 : 0];
  };
  Picture steps = flatPicture(121, 121, 0);  // an edge every 8 px along x and y
  for (std::size_t i = 0; i < steps.gray.size(); ++i)
    steps.gray[i] = static_cast<std::uint8_t>(60 * ((i % 121 / 8) % 2) + 60 * ((i / 121 / 8) % 2));
  for (const auto& [at, counted] : {std::pair{23.9, 0}, {24.0, 1}, {95.9, 1}, {96.0, 0}}) {
    EXPECT_EQ(counts(steps, at, 60.0, x_axis), counted) << at;
    EXPECT_EQ(counts(steps, 60.0, at, y_axis), counted) << at;
  }
  for (const auto& [x, counted] : {std::pair{35, 1}, {36, 0}, {60, 0}, {84, 0}, {85, 1}}) {
    Mask mask(121, 121);
    mask.fill(x, 50, x + 1, 51);
    EXPECT_EQ(counts(steps, 60.0, 50.0, x_axis, &mask.bits), counted) << x;
  }
  // A ramp of at least 20 gray values, whose steepest slope is within 4 px.
  EXPECT_EQ(counts(rampPicture(x_axis, 10.0, 50.0, 20.0), 60.0, 60.0, x_axis), 1);
  EXPECT_EQ(counts(rampPicture(x_axis, 10.0, 50.0, 19.0), 60.0, 60.0, x_axis), 0);
  for (const auto& [x, counted] : {std::pair{54.0, 0}, {55.0, 1}, {65.0, 1}, {66.0, 0}})
    EXPECT_EQ(counts(rampPicture(x_axis, 0.5, 50.0, 90.0), x, 60.0, x_axis), counted) << x;
}

TEST(EdgeWidth, Median_IsThatOfThePlacesOfADirection) {
  // Ramps of 4, 8 and 16 px, one below the other.
  Picture picture = flatPicture(121, 121, 0);
  for (int y = 0; y < 121; ++y)
    for (int x = 0; x < 121; ++x)
      picture.gray[static_cast<std::size_t>(y * 121 + x)] =
          static_cast<std::uint8_t>(std::clamp(80 + (x - 60) * 160 / (4 << (y / 41)), 0, 160));
  EdgeWidthMeter meter(picture.view(), nullptr);
  const Eigen::Vector2d normal(1.0, 0.0);
  EXPECT_EQ(meter.width().widestDirection(), -1);
  const auto medianWith = [&](double y) {
    meter.add({60.0, y}, normal);
    return meter.width().width_px[0];
  };
  EXPECT_EQ(medianWith(100.0), 16.125);
  EXPECT_EQ(medianWith(20.0), 4.125) << "the lower one of two";
  EXPECT_EQ(medianWith(60.0), 8.125);
  EXPECT_EQ(meter.width().places[0], 3);
}

TEST(EdgeWidth, WidestDirection_HasThirtyPlaces) {
  EdgeWidth width;
  width.width_px = {3.0, 9.0, 5.0, 5.0, 20.0, 1.0, 2.0, 4.0};
  width.places = {40, 29, 30, 31, 29, 50, 50, 0};
  EXPECT_EQ(width.widestDirection(), 2);
  EXPECT_EQ(width.widest_px(), 5.0);
  EXPECT_TRUE(width.isSharp());
  width.places[4] = 30;
  EXPECT_FALSE(width.isSharp());
  width.width_px[0] = 30.0;
  EXPECT_EQ(width.widestDirection(), 0);
  EXPECT_EQ(EdgeWidth().widest_px(), 0.0);
}

/// At either level the median of the widths that the meter finds at the places of the render.
TEST(EdgeWidth, Render_IsMeasuredAtItsEdgePixels) {
  const Case scene = stationCase(1);
  for (const int level : {0, 1}) {
    const Rendering rendering =
        renderEdges(scene.solid, cameraAtLevel(scene.camera, level), scene.truth);
    EdgeWidthMeter meter(scene.picture->view(), nullptr);
    const int stride = (rendering.edges.pixel_count + 3999) / 4000;
    ASSERT_EQ(stride, level == 0 ? 2 : 1);
    for (int i = 0; i < rendering.edges.pixel_count; i += stride) {
      const EdgePixel pixel = rendering.edges.pixel(i);
      const Eigen::Vector2d normal(pixel.normal_x / 127.0, pixel.normal_y / 127.0);
      const Eigen::Vector2d place =
          Eigen::Vector2d(pixel.x, pixel.y) + 0.01 * pixel.offset * normal;
      const double scale = 1 << level;
      meter.add(scale * place + Eigen::Vector2d::Constant(0.5 * (scale - 1.0)), normal);
    }
    const EdgeWidth expected = meter.width();
    const EdgeWidth width =
        measureEdgeWidth(rendering.edges, level, scene.picture->view(), nullptr);
    EXPECT_EQ(width.width_px, expected.width_px);
    EXPECT_EQ(width.places, expected.places);
    EXPECT_LT(width.widest_px(), 4.0);
    EXPECT_GE(width.widestDirection(), 0);
  }
}

}  // namespace
}  // namespace boresight::test
