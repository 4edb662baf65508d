// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_search.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/refine/step_edge.h"

namespace boresight::test {
namespace {

constexpr int kSide = 64;
constexpr double kMiddle = 31.5;

/// An edge through the neighbourhood of the image's middle.
StepEdge edgeAt(double angle_rad, double beyond_middle_px, double contrast) {
  StepEdge edge;
  edge.normal = {std::cos(angle_rad), std::sin(angle_rad)};
  edge.distance_px = edge.normal.dot(Eigen::Vector2d(kMiddle, kMiddle)) + beyond_middle_px;
  edge.contrast = contrast;
  return edge;
}

const Eigen::Vector2d kCentre(kMiddle, kMiddle);

/// Errors of 400 random steps, px.
std::vector<double> errorsOf(const EdgeSearch& search, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> errors_px;
  for (int i = 0; i < 400; ++i) {
    const double angle = random.uniform(0.0, 2.0 * M_PI);
    const double shift = random.uniform(-1.0, 1.0);
    const StepEdge edge = edgeAt(angle, shift, random.uniform(60.0, 200.0));
    const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
    // One after the other: the same sample whichever argument a compiler evaluates first.
    const double down = random.uniform(-1.5, 1.5);
    const double right = random.uniform(-1.5, 1.5);
    const Eigen::Vector2d predicted = kCentre + Eigen::Vector2d(right, down);
    const EdgePeak peak = search.find(picture.view(), nullptr, predicted, edge.normal, 5.0, 2.0);
    EXPECT_GT(peak.gradient, 0.0) << angle << " " << shift;
    errors_px.push_back(peak.offset_px - (edge.distance_px - edge.normal.dot(predicted)));
  }
  return errors_px;
}

double meanOf(const std::vector<double>& errors_px) {
  return std::accumulate(errors_px.begin(), errors_px.end(), 0.0) /
         static_cast<double>(errors_px.size());
}

TEST(EdgeSearch, FindsStepsToAFewHundredthsOfAPixel) {
  const std::vector<double> errors_px = errorsOf(EdgeSearch(1.0), 1);
  double squares_px2 = 0.0;
  int beyond = 0;
  for (const double error_px : errors_px) {
    // Interpolation errs most along rows and columns, where all pixels of an edge share one error.
    EXPECT_NEAR(error_px, 0.0, 0.055);
    beyond += std::abs(error_px) > 0.03 ? 1 : 0;
    squares_px2 += error_px * error_px;
  }
  EXPECT_LT(beyond, 80);
  EXPECT_LT(std::sqrt(squares_px2 / 400), 0.02);
  EXPECT_LT(std::abs(meanOf(errors_px)), 0.003);  // unbiased
}

TEST(EdgeSearch, WideSteps_FindStepsToATenthOfAPixel) {
  const std::vector<double> errors_px = errorsOf(EdgeSearch(1.0, EdgeSearch::kWideStep_px), 2);
  for (const double error_px : errors_px) EXPECT_NEAR(error_px, 0.0, 0.15);
  EXPECT_LT(std::abs(meanOf(errors_px)), 0.01);  // unbiased
}

TEST(EdgeSearch, GradientIsThatOfTheSmoothedStep) {
  for (const double sigma_px : {0.8, 1.0, 2.0, 3.0}) {
    const EdgeSearch search(sigma_px);
    for (const double angle : {0.0, 0.4, 0.7853981, 1.5707963}) {
      const StepEdge edge = edgeAt(angle, 0.1, 120.0);
      const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
      const EdgePeak peak = search.find(picture.view(), nullptr, kCentre, edge.normal, 4.0, 2.0);
      // Variance of the pixel, of the interpolation and of the three parallels across the edge.
      const double variance_px2 = sigma_px * sigma_px + 1.0 / 12.0 + 1.0 / 6.0;
      const double expected = 120.0 / std::sqrt(2.0 * M_PI * variance_px2);
      EXPECT_NEAR(peak.gradient, expected, 0.12 * expected) << sigma_px << " " << angle;
    }
  }
}

TEST(EdgeSearch, TurnedNormalTurnsTheSigns) {
  const EdgeSearch search(1.0);
  const StepEdge edge = edgeAt(0.6, 0.8, 90.0);
  const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
  const EdgePeak forward = search.find(picture.view(), nullptr, kCentre, edge.normal, 4.0, 2.0);
  const EdgePeak back = search.find(picture.view(), nullptr, kCentre, -edge.normal, 4.0, 2.0);
  EXPECT_NEAR(forward.offset_px, 0.8, 0.03);
  EXPECT_NEAR(forward.offset_px, -back.offset_px, 1e-6);
  EXPECT_NEAR(forward.gradient, -back.gradient, 1e-6);
}

TEST(EdgeSearch, ReachesTheRadiusAndNoFurther) {
  const EdgeSearch search(1.0);
  for (const double radius_px : {1.0, 2.5, 4.0, 7.0}) {
    for (const double side : {-1.0, 1.0}) {
      const StepEdge near = edgeAt(1.1, side * (radius_px - 0.3), 90.0);
      const Picture inside = drawSteps(kSide, kSide, 20.0, {near});
      const EdgePeak found =
          search.find(inside.view(), nullptr, kCentre, near.normal, radius_px, 2.0);
      EXPECT_NEAR(found.offset_px, side * (radius_px - 0.3), 0.05) << radius_px;
      EXPECT_GT(found.gradient, 0.0);
      const StepEdge far = edgeAt(1.1, side * (radius_px + 0.6), 90.0);
      const Picture outside = drawSteps(kSide, kSide, 20.0, {far});
      EXPECT_EQ(search.find(outside.view(), nullptr, kCentre, far.normal, radius_px, 2.0).gradient,
                0.0)
          << radius_px;
    }
  }
}

TEST(EdgeSearch, PrefersTheNearerOfTwoEdges) {
  const EdgeSearch search(0.8);
  // With a reach of 6 + 1 px: 60 (1 - (0.5/7)^2) = 59.7 against 90 (1 - (5/7)^2) = 44.
  const StepEdge near = edgeAt(0.3, -0.5, 60.0);
  const StepEdge far = edgeAt(0.3, 5.0, 90.0);
  const Picture weak_near = drawSteps(kSide, kSide, 20.0, {near, far});
  EXPECT_NEAR(search.find(weak_near.view(), nullptr, kCentre, near.normal, 6.0, 2.0).offset_px,
              -0.5, 0.1);
  // 20 (1 - (0.5/7)^2) = 19.9 against 90 (1 - (5/7)^2) = 44.
  const StepEdge faint = edgeAt(0.3, -0.5, 20.0);
  const Picture faint_near = drawSteps(kSide, kSide, 20.0, {faint, far});
  EXPECT_NEAR(search.find(faint_near.view(), nullptr, kCentre, near.normal, 6.0, 2.0).offset_px,
              5.0, 0.1);
  // Alone, without the strong one, the faint one is found.
  const Picture alone = drawSteps(kSide, kSide, 20.0, {faint});
  EXPECT_NEAR(search.find(alone.view(), nullptr, kCentre, near.normal, 6.0, 2.0).offset_px, -0.5,
              0.1);
}

TEST(EdgeSearch, WeakEdges_AreNotFound) {
  const EdgeSearch search(1.0);
  const StepEdge edge = edgeAt(2.0, 0.2, 50.0);
  const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
  const double gradient =
      search.find(picture.view(), nullptr, kCentre, edge.normal, 4.0, 0.0).gradient;
  ASSERT_GT(gradient, 10.0);
  const auto strengthAbove = [&](double min_gradient) {
    return search.find(picture.view(), nullptr, kCentre, -edge.normal, 4.0, min_gradient).gradient;
  };
  EXPECT_NEAR(strengthAbove(0.99 * gradient), -gradient, 1e-9);
  EXPECT_EQ(strengthAbove(1.01 * gradient), 0.0);
}

TEST(EdgeSearch, FlatAndEvenlySlopedImages_HaveNoEdge) {
  const EdgeSearch search(1.0);
  const Picture flat = flatPicture(kSide, kSide, 77);
  Picture slope = flat;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x)
      slope.gray[static_cast<std::size_t>(y * kSide + x)] = static_cast<std::uint8_t>(3 * x);
  }
  for (double angle = 0.0; angle < 6.28; angle += 0.3) {
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    EXPECT_EQ(search.find(flat.view(), nullptr, kCentre, normal, 4.0, 0.0).gradient, 0.0);
  }
  EXPECT_EQ(search.find(slope.view(), nullptr, kCentre, {1.0, 0.0}, 4.0, 0.0).gradient, 0.0);
}

TEST(EdgeSearch, IgnoredEdges_AreNotFound) {
  const EdgeSearch search(1.0);
  const StepEdge edge = edgeAt(0.0, 1.5, 90.0);  // at x = 33, y = 31 or 32
  const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
  const Eigen::Vector2d predicted(31.5, 31.2);
  Mask elsewhere(kSide, kSide);
  elsewhere.fill(0, 0, kSide, kSide);
  elsewhere.bits.reset(33, 31);
  EXPECT_GT(search.find(picture.view(), &elsewhere.bits, predicted, edge.normal, 4.0, 2.0).gradient,
            0.0);
  Mask mask(kSide, kSide);
  mask.bits.set(33, 31);
  EXPECT_EQ(search.find(picture.view(), &mask.bits, predicted, edge.normal, 4.0, 2.0).gradient,
            0.0);
}

TEST(EdgeSearch, ProfilesThatLeaveTheImage_FindNoEdge) {
  const EdgeSearch search(1.0);
  const Picture noise = noisePicture(kSide, kSide, 2);
  Random random(3);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d predicted(random.uniform(-20.0, 84.0), random.uniform(-20.0, 84.0));
    const double angle = random.uniform(0.0, 2.0 * M_PI);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const EdgePeak peak = search.find(noise.view(), nullptr, predicted, normal, 4.0, 0.0);
    // 4 px of radius, half a pixel and 3 sigma for the derivative.
    bool inside = true;
    for (const double reach : {-7.5, 7.5}) {
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d end =
            predicted + reach * normal + side * Eigen::Vector2d(-normal.y(), normal.x());
        inside = inside && end.x() >= 0.0 && end.y() >= 0.0 && end.x() < kSide - 1 &&
                 end.y() < kSide - 1;
      }
    }
    EXPECT_TRUE(inside || peak.gradient == 0.0) << predicted.transpose() << " " << angle;
    found += peak.gradient != 0.0 ? 1 : 0;
  }
  EXPECT_GT(found, 3000);
}

TEST(EdgeSearch, AnyInput_GivesAFiniteResult) {
  const Picture noise = noisePicture(kSide, kSide, 2);
  const double values[] = {0.0,
                           -1e300,
                           1e300,
                           1e9,
                           31.0,
                           std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()};
  for (const double sigma_px : {0.3, 1.0, 5.0}) {
    const EdgeSearch search(sigma_px);
    for (const double x : values) {
      for (const double y : values) {
        for (const double radius_px : {0.5, 4.0, 50.0, 200.0}) {
          const EdgePeak a = search.find(noise.view(), nullptr, {x, y}, {1.0, 0.0}, radius_px, 0.0);
          const EdgePeak b =
              search.find(noise.view(), nullptr, {31.0, 31.0}, {x, y}, radius_px, 0.0);
          EXPECT_TRUE(std::isfinite(a.offset_px) && std::isfinite(b.offset_px));
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::test
