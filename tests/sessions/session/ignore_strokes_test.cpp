// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/ignore_strokes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sessions/session/random_session.h"

namespace boresight::test {
namespace {

using sessions::MaskStroke;
using sessions::StrokeKind;

/// The definition, pixel by pixel: brush by the distance to the nearest point of the line, polygon
/// by the winding of the angle under which it is seen.
bool covers(const MaskStroke& stroke, const Eigen::Vector2d& pixel, int gray) {
  const auto& points = stroke.points;
  if (stroke.kind == StrokeKind::kSaturation) return gray >= stroke.level;
  if (stroke.kind == StrokeKind::kBrush) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d a = points[i > 0 ? i - 1 : 0];
      for (int step = 0; step <= 4000; ++step)
        if ((a + step / 4000.0 * (points[i] - a) - pixel).norm() <= stroke.radius_px) return true;
    }
    return false;
  }
  int crossings = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d a = points[i] - pixel;
    const Eigen::Vector2d b = points[(i + 1) % points.size()] - pixel;
    const bool above_a = a.y() > 0.0, above_b = b.y() > 0.0;
    if (above_a != above_b && (a.x() * b.y() - b.x() * a.y() > 0.0) == above_b) ++crossings;
  }
  return crossings % 2 == 1;
}

TEST(IgnoreStrokes, CoverWhatTheyAreDefinedToCover) {
  Random random = randomFor("IgnoreStrokes");
  constexpr int kWidth = 70, kHeight = 20;
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random.below(256));
  const ImageView image{pixels.data(), kWidth, kHeight, kWidth};
  for (int round = 0; round < 12; ++round) {
    MaskStroke stroke;
    stroke.kind = static_cast<StrokeKind>(round % 3);
    stroke.radius_px = random.uniform(0.5, 6.0);
    stroke.level = static_cast<int>(random.below(256));
    for (int i = 0; i < 4; ++i)
      stroke.points.emplace_back(random.uniform(-20.0, 90.0), random.uniform(-20.0, 40.0));
    sessions::IgnoreMask mask = sessions::emptyMask(kWidth, kHeight);
    applyStrokes({stroke}, image, mask);
    std::int64_t count = 0, different = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool wanted = covers(stroke, {x, y}, image.at(x, y));
        different += mask.view().get(x, y) != wanted ? 1 : 0;
        count += mask.view().get(x, y) ? 1 : 0;
      }
    // The oracle walks the brush in steps: only a pixel just at the rim may differ.
    EXPECT_LE(different, stroke.kind == StrokeKind::kBrush ? 1 : 0) << round;
    EXPECT_EQ(count, mask.ignored_count);
    MaskStroke eraser = stroke;
    eraser.erase = true;
    applyStrokes({eraser}, image, mask);
    EXPECT_EQ(mask.ignored_count, 0);
  }
}

TEST(IgnoreStrokes, AreAppliedInTheirOrder) {
  const std::vector<std::uint8_t> pixels(100, 255);
  const ImageView image{pixels.data(), 10, 10, 10};
  MaskStroke all, dot;
  all.kind = StrokeKind::kSaturation;
  dot.erase = true;
  dot.radius_px = 0.0;
  dot.points = {{3.0, 4.0}};
  sessions::IgnoreMask mask = sessions::emptyMask(10, 10);
  applyStrokes({all, dot}, image, mask);
  EXPECT_EQ(mask.ignored_count, 99);
  EXPECT_FALSE(mask.view().get(3, 4));
  applyStrokes({all}, image, mask);
  EXPECT_EQ(mask.ignored_count, 100);
}

}  // namespace
}  // namespace boresight::test
