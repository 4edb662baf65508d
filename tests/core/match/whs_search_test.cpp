// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/match/whs.h"
#include "core/match/whs_reference.h"
#include "tests/core/match/match_support.h"

namespace boresight {
namespace {

using test::Dice;
using test::noise;
using test::OwnedBits;
using test::OwnedSearch;

enum class MaskKind {
  kFull,
  kEmpty,
  kHalfPlane,
  kCircle,
  kRing,
  kNoise,
  kSparseNoise,
  kColumn,
  kRow,
  kRowStripes,
  kColumnStripes,
  kCount
};

OwnedBits makeMask(int width, int height, MaskKind kind, int side, Dice& dice) {
  if (kind == MaskKind::kNoise) return noise(width, height, 0.5, dice);
  if (kind == MaskKind::kSparseNoise) return noise(width, height, 0.03, dice);
  OwnedBits mask(width, height);
  const int cx = dice.below(width), cy = dice.below(height);
  const int radius = 1 + dice.below(side);
  const int nx = dice.between(-5, 5), ny = dice.between(-5, 5);
  const int line = dice.between(width / 2 - side / 4, width / 2 + side / 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      bool in = false;
      switch (kind) {
        case MaskKind::kFull:
          in = true;
          break;
        case MaskKind::kHalfPlane:
          in = nx * (x - cx) + ny * (y - cy) >= 0;
          break;
        case MaskKind::kCircle:
          in = r2 <= radius * radius;
          break;
        case MaskKind::kRing:
          in = r2 <= radius * radius && 4 * r2 > radius * radius;
          break;
        case MaskKind::kColumn:
          in = x == line;
          break;
        case MaskKind::kRow:
          in = y == height / 2;
          break;
        case MaskKind::kRowStripes:
          in = y % 2 == 0;
          break;
        case MaskKind::kColumnStripes:
          in = x % 3 != 0;
          break;
        default:
          break;
      }
      if (in) mask.image.set(x, y);
    }
  }
  return mask;
}

/// A random search: images of odd sizes, a template anywhere, a window anywhere inside.
struct Problem {
  OwnedBits edges, mask, test;
  TemplateView view;
  SearchWindow window;
  int predicted_x = 0, predicted_y = 0, exclusion_px = 0;

  Problem(int side, MaskKind kind, int max_window, double edge_density, double test_density,
          Dice& dice)
      : edges(noise(side + dice.below(70), side + dice.below(9), edge_density, dice)),
        mask(makeMask(edges.image.width, edges.image.height, kind, side, dice)),
        test(noise(side + dice.below(max_window), side + dice.below(max_window), test_density,
                   dice)) {
    const int half = side / 2;
    view = {&edges.image, &mask.image, dice.between(half, edges.image.width - half),
            dice.between(half, edges.image.height - half), side};
    window.x_min = dice.between(half, test.image.width - half);
    window.x_max = dice.between(window.x_min, test.image.width - half);
    window.y_min = dice.between(half, test.image.height - half);
    window.y_max = dice.between(window.y_min, test.image.height - half);
    if (dice.below(3) == 0) {  // the whole image
      window = {half, half, test.image.width - half, test.image.height - half};
    }
    predicted_x = dice.between(-10, test.image.width + 10);
    predicted_y = dice.between(-10, test.image.height + 10);
    exclusion_px = dice.below(20);
  }
};

WhsPeak run(WhsSearch& search, const Problem& problem) {
  EXPECT_EQ(search.begin(problem.view, problem.test.image, problem.window, problem.predicted_x,
                         problem.predicted_y, problem.exclusion_px),
            Status::kOk);
  for (int steps = 0; steps < 1000000 && !search.step(); ++steps) {
  }
  return search.peak();
}

WhsPeak reference(const Problem& problem) {
  return whsPeakReference(problem.view, problem.test.image, problem.window, problem.predicted_x,
                          problem.predicted_y, problem.exclusion_px);
}

TEST(WhsSearch, EqualsTheDefinitionForRandomInput) {
  Dice dice;
  OwnedSearch owned(64, 300);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int trial = 0; trial < 600; ++trial) {
    const int side = 2 * dice.between(4, 20);
    const MaskKind kind = static_cast<MaskKind>(trial % static_cast<int>(MaskKind::kCount));
    const Problem problem(side, kind, 60, dice.uniform(0.0, 0.3), dice.uniform(0.0, 0.4), dice);
    SCOPED_TRACE(testing::Message()
                 << "trial " << trial << " side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, problem), reference(problem));
    ASSERT_EQ(owned.search.norms(), whsNormsReference(problem.view));
  }
}
}  // namespace
}  // namespace boresight
