// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_search.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/refine/step_edge.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

constexpr int kSide = 64;
const Eigen::Vector2d kCentre(31.5, 31.5);

/// An edge through the neighbourhood of the image's middle.
StepEdge edgeAt(double angle_rad, double beyond_middle_px, double contrast) {
  const Eigen::Vector2d normal(std::cos(angle_rad), std::sin(angle_rad));
  return {normal, normal.dot(kCentre) + beyond_middle_px, contrast};
}

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

TEST(EdgeSearch, BlurOfAnEdge_IsMeasured) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double blur_px = random.uniform(0.6, 3.5);
    const StepEdge edge = edgeAt(random.uniform(0.0, 2.0 * M_PI), random.uniform(-1.0, 1.0), 150.0);
    Picture picture = flatPicture(kSide, kSide, 0);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double beyond_px = edge.normal.dot(Eigen::Vector2d(x, y)) - edge.distance_px;
        const double share = 0.5 * (1.0 + std::erf(beyond_px / (std::sqrt(2.0) * blur_px)));
        picture.gray[static_cast<std::size_t>(y * kSide + x)] =
            static_cast<std::uint8_t>(std::lround(20.0 + edge.contrast * share));
      }
    const EdgePeak peak =
        EdgeSearch(1.0).find(picture.view(), nullptr, kCentre, edge.normal, 4.0, 2.0);
    EXPECT_NEAR(peak.blur_px, blur_px, 0.15 * blur_px + 0.15);
  }
}

/// Bilinear, with weights that are rounded down to 1/1024.
double grayAt(const ImageView& image, const Eigen::Vector2d& at) {
  const int x = static_cast<int>(at.x());
  const int y = static_cast<int>(at.y());
  const double right = std::floor((at.x() - x) * 1024.0) / 1024.0;
  const double down = std::floor((at.y() - y) * 1024.0) / 1024.0;
  const double top = image.at(x, y) + right * (image.at(x + 1, y) - image.at(x, y));
  const double bottom = image.at(x, y + 1) + right * (image.at(x + 1, y + 1) - image.at(x, y + 1));
  return top + down * (bottom - top);
}

/// The search by its definition.
EdgePeak plainSearch(double sigma_px, double step_px, const ImageView& image,
                     const Eigen::Vector2d& predicted, const Eigen::Vector2d& normal,
                     double radius_px, double min_gradient) {
  const Eigen::Vector2d aside(-normal.y(), normal.x());
  const auto profile = [&](int k) {
    const Eigen::Vector2d at = predicted + k * step_px * normal;
    return 0.25 * grayAt(image, at - aside) + 0.5 * grayAt(image, at) +
           0.25 * grayAt(image, at + aside);
  };
  // Derivative of a Gaussian, scaled to 1 for a ramp of 1, of three parallels that weigh 1, 2, 1.
  const auto slope = [&](int i) {
    double sum = 0.0;
    double ramp = 0.0;
    for (int k = 1; k <= static_cast<int>(3.0 * sigma_px / step_px + 0.5); ++k) {
      const double s_px = k * step_px;
      const double weight = s_px * std::exp(-0.5 * s_px * s_px / (sigma_px * sigma_px));
      sum += weight * (profile(i + k) - profile(i - k));
      ramp += 2.0 * s_px * weight;
    }
    return sum / ramp;
  };
  const int inner = static_cast<int>(radius_px / step_px) + 1;
  EdgePeak peak;
  double best = 0.0;
  for (int i = 1 - inner; i < inner; ++i) {
    const double before = std::abs(slope(i - 1));
    const double strength = std::abs(slope(i));
    const double after = std::abs(slope(i + 1));
    const double rim = static_cast<double>(i) / (inner + 1);
    const double preference = strength * (1.0 - rim * rim);
    if (strength < before || strength <= after || strength < min_gradient || preference <= best)
      continue;
    best = preference;
    const double top = 0.5 * (before - after) / (before - 2.0 * strength + after);
    peak = {(i + top) * step_px, slope(i)};
  }
  return peak;
}

TEST(EdgeSearch, NoiseInEveryDirection_GivesTheEdgeOfTheDefinition) {
  // A weight that is rounded the other way, as places are in integers, changes little.
  const Picture noise = noisePicture(kSide, kSide, 4);
  Random random(6);
  int found = 0;
  int different = 0;  // where two edges are as strong
  for (int i = 0; i < 2000; ++i) {
    const double sigma_px = random.uniform(0.5, 1.5);
    const double step_px = i % 2 == 0 ? EdgeSearch::kFineStep_px : EdgeSearch::kWideStep_px;
    const double radius_px = random.uniform(1.0, 6.0);
    const double angle = random.uniform(0.0, 2.0 * M_PI);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d predicted =
        kCentre + Eigen::Vector2d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0));
    const double min_gradient = random.uniform(0.0, 12.0);
    const EdgePeak peak =
        EdgeSearch(sigma_px, step_px)
            .find(noise.view(), nullptr, predicted, normal, radius_px, min_gradient);
    const EdgePeak plain =
        plainSearch(sigma_px, step_px, noise.view(), predicted, normal, radius_px, min_gradient);
    found += plain.gradient != 0.0 ? 1 : 0;
    if (std::abs(peak.gradient - plain.gradient) > 0.05 ||
        std::abs(peak.offset_px - plain.offset_px) > 0.02)
      ++different;
  }
  EXPECT_GT(found, 1000);
  EXPECT_LE(different, 4);
}

TEST(EdgeSearch, IgnoredEdges_AreNotFound) {
  const StepEdge edge = edgeAt(0.0, 1.5, 90.0);  // at x = 33, y = 31 or 32
  const Picture picture = drawSteps(kSide, kSide, 20.0, {edge});
  const auto gradientWith = [&](const Mask& mask) {
    return EdgeSearch(1.0)
        .find(picture.view(), &mask.bits, {31.5, 31.2}, edge.normal, 4.0, 2.0)
        .gradient;
  };
  Mask elsewhere(kSide, kSide);
  elsewhere.fill(0, 0, kSide, kSide);
  elsewhere.bits.reset(33, 31);
  EXPECT_GT(gradientWith(elsewhere), 0.0);
  Mask mask(kSide, kSide);
  mask.bits.set(33, 31);
  EXPECT_EQ(gradientWith(mask), 0.0);
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
    const Eigen::Vector2d half =
        7.5 * normal.cwiseAbs() + Eigen::Vector2d(normal.y(), normal.x()).cwiseAbs();
    const bool inside =
        (predicted - half).minCoeff() >= 0.0 && (predicted + half).maxCoeff() < kSide - 1;
    EXPECT_TRUE(inside || peak.gradient == 0.0) << predicted.transpose() << " " << angle;
    found += peak.gradient != 0.0 ? 1 : 0;
  }
  EXPECT_GT(found, 3000);
}

TEST(EdgeSearch, AnyInput_GivesAFiniteResult) {
  const Picture noise = noisePicture(kSide, kSide, 2);
  const double values[] = {0.0, -1e300, 1e300, 1e9, 31.0, kInfinity, kNan};
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
