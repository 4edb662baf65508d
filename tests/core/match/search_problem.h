// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/match/whs.h"
#include "tests/core/match/match_support.h"

namespace boresight::test {

/// The definition, pixel by pixel (Pham 2025, Eqs. 1-3): S+ = sum of M T I, S- = sum of M (1 - T)
/// (1 - I). Slow on purpose: the oracle that every faster implementation is compared with. The
/// template must lie inside both images.
inline WhsCounts whsCountsReference(const TemplateView& view, const BitImage& test_edges, int x,
                                    int y) {
  WhsCounts counts;
  const int half = view.side_px / 2;
  for (int v = -half; v < half; ++v) {
    for (int u = -half; u < half; ++u) {
      if (!view.mask->get(view.center_x + u, view.center_y + v)) continue;
      const bool edge = view.edges->get(view.center_x + u, view.center_y + v);
      const bool test = test_edges.get(x + u, y + v);
      if (edge && test) ++counts.edge_hits;
      if (!edge && !test) ++counts.empty_hits;
    }
  }
  return counts;
}

inline WhsNorms whsNormsReference(const TemplateView& view) {
  WhsNorms norms;
  const int half = view.side_px / 2;
  for (int v = -half; v < half; ++v) {
    for (int u = -half; u < half; ++u) {
      if (!view.mask->get(view.center_x + u, view.center_y + v)) continue;
      const bool edge = view.edges->get(view.center_x + u, view.center_y + v);
      ++(edge ? norms.edges : norms.empties);
    }
  }
  return norms;
}

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

inline OwnedBits makeMask(int width, int height, MaskKind kind, int side, Dice& dice) {
  if (kind == MaskKind::kNoise) return noise(width, height, 0.5, dice);
  if (kind == MaskKind::kSparseNoise) return noise(width, height, 0.03, dice);
  const int cx = dice.below(width), cy = dice.below(height);
  const int radius = 1 + dice.below(side);
  const int nx = dice.between(-5, 5), ny = dice.between(-5, 5);
  const int line = dice.between(width / 2 - side / 4, width / 2 + side / 4);
  return drawn(width, height, [&](int x, int y) {
    const int r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
    switch (kind) {
      case MaskKind::kFull:
        return true;
      case MaskKind::kHalfPlane:
        return nx * (x - cx) + ny * (y - cy) >= 0;
      case MaskKind::kCircle:
        return r2 <= radius * radius;
      case MaskKind::kRing:
        return r2 <= radius * radius && 4 * r2 > radius * radius;
      case MaskKind::kColumn:
        return x == line;
      case MaskKind::kRow:
        return y == height / 2;
      case MaskKind::kRowStripes:
        return y % 2 == 0;
      case MaskKind::kColumnStripes:
        return x % 3 != 0;
      default:
        return false;
    }
  });
}

inline OwnedBits fullMask(int side) {
  return drawn(side, side, [](int, int) { return true; });
}

struct Problem {
  OwnedBits edges, mask, test;
  TemplateView view;
  SearchWindow window;
  int predicted_x = 0, predicted_y = 0, exclusion_px = 0;

  Problem(OwnedBits edge_bits, OwnedBits mask_bits, OwnedBits test_bits, int side)
      : edges(std::move(edge_bits)), mask(std::move(mask_bits)), test(std::move(test_bits)) {
    const int half = side / 2;
    view = {&edges.image, &mask.image, half, half, side};
    window = {half, half, test.image.width - half, test.image.height - half};
    predicted_x = (window.x_min + window.x_max) / 2;
    predicted_y = (window.y_min + window.y_max) / 2;
  }
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  void moveTemplate(int center_x, int center_y) {
    view.center_x = center_x;
    view.center_y = center_y;
  }
};

/// Images of odd sizes, a template anywhere in the render, a window anywhere in the image (every
/// third: all of it), a predicted place that may lie outside.
inline std::unique_ptr<Problem> randomProblem(int side, MaskKind kind, int most_x, int most_y,
                                              Dice& dice) {
  const int width = side + dice.below(70), height = side + dice.below(9);
  auto problem = std::make_unique<Problem>(
      noise(width, height, dice.uniform(0.0, 0.3), dice), makeMask(width, height, kind, side, dice),
      noise(side + dice.below(most_x), side + dice.below(most_y), dice.uniform(0.0, 0.4), dice),
      side);
  const int half = side / 2;
  problem->moveTemplate(dice.between(half, width - half), dice.between(half, height - half));
  const BitImage& test = problem->test.image;
  if (dice.below(3) != 0) {
    SearchWindow& window = problem->window;
    window.x_min = dice.between(half, test.width - half);
    window.x_max = dice.between(window.x_min, test.width - half);
    window.y_min = dice.between(half, test.height - half);
    window.y_max = dice.between(window.y_min, test.height - half);
  }
  problem->predicted_x = dice.between(-10, test.width + 10);
  problem->predicted_y = dice.between(-10, test.height + 10);
  problem->exclusion_px = dice.below(20);
  return problem;
}

inline Status beginOn(WhsSearch& search, const Problem& problem) {
  return search.begin(problem.view, problem.test.image, problem.window, problem.predicted_x,
                      problem.predicted_y, problem.exclusion_px);
}

inline WhsPeak run(WhsSearch& search, const Problem& problem) {
  EXPECT_EQ(beginOn(search, problem), Status::kOk);
  int steps = 0;
  while (!search.step()) {
    if (++steps == 1000000) {
      ADD_FAILURE() << "does not end";
      break;
    }
  }
  return search.peak();
}

/// Does the 8x8 block of offsets that holds (x, y) touch the square around the best?
inline bool blockTouches(const Problem& problem, int x, int y, const WhsPeak& best) {
  const int block_x = x - (x - problem.window.x_min) % 8;
  const int block_y = y - (y - problem.window.y_min) % 8;
  return block_x <= best.x + problem.exclusion_px && block_x + 7 >= best.x - problem.exclusion_px &&
         block_y <= best.y + problem.exclusion_px && block_y + 7 >= best.y - problem.exclusion_px;
}

/// Expected result of WhsSearch, by trying every offset twice; `counts_at` gives the counts at (x,
/// y).
template <class CountsAt>
WhsPeak peakByTrying(const CountsAt& counts_at, const WhsNorms& norms, const Problem& problem) {
  const SearchWindow& window = problem.window;
  // False where `skips` leaves no offset.
  const auto largest = [&](const auto& skips, int& best_x, int& best_y, WhsCounts& best_counts) {
    std::int64_t best = -1, best_distance = 0;
    for (int y = window.y_min; y <= window.y_max; ++y) {
      for (int x = window.x_min; x <= window.x_max; ++x) {
        if (skips(x, y)) continue;
        const WhsCounts counts = counts_at(x, y);
        const std::int64_t value = whsComparable(counts, norms);
        const std::int64_t dx = x - problem.predicted_x, dy = y - problem.predicted_y;
        const std::int64_t distance = dx * dx + dy * dy;
        if (value < best || (value == best && distance >= best_distance)) continue;
        best = value;
        best_distance = distance;
        best_x = x;
        best_y = y;
        best_counts = counts;
      }
    }
    return best >= 0;
  };
  WhsPeak peak;
  largest([](int, int) { return false; }, peak.x, peak.y, peak.counts);
  peak.has_second = largest([&](int x, int y) { return blockTouches(problem, x, y, peak); },
                            peak.second_x, peak.second_y, peak.second_counts);
  return peak;
}

/// Expected result of WhsSearch, pixel by pixel.
inline WhsPeak reference(const Problem& problem) {
  return peakByTrying(
      [&](int x, int y) { return whsCountsReference(problem.view, problem.test.image, x, y); },
      whsNormsReference(problem.view), problem);
}

/// The peak of a map of counts, for windows that are too large for the pixel-by-pixel reference.
inline WhsPeak peakOfMap(const Problem& problem) {
  const SearchWindow& window = problem.window;
  std::vector<WhsCounts> map(static_cast<std::size_t>(window.width() * window.height()));
  whsScoreMap(problem.view, problem.test.image, window, map);
  return peakByTrying(
      [&](int x, int y) {
        return map[static_cast<std::size_t>((y - window.y_min) * window.width() + x -
                                            window.x_min)];
      },
      whsNorms(problem.view), problem);
}

}  // namespace boresight::test
