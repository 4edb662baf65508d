// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
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
std::unique_ptr<Problem> randomProblem(int side, MaskKind kind, int most_x, int most_y,
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

Status beginOn(WhsSearch& search, const Problem& problem) {
  return search.begin(problem.view, problem.test.image, problem.window, problem.predicted_x,
                      problem.predicted_y, problem.exclusion_px);
}

WhsPeak run(WhsSearch& search, const Problem& problem) {
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

WhsPeak reference(const Problem& problem) {
  return whsPeakReference(problem.view, problem.test.image, problem.window, problem.predicted_x,
                          problem.predicted_y, problem.exclusion_px);
}

/// The peak of a map of counts, for windows that are too large for the pixel-by-pixel reference.
WhsPeak peakOfMap(const Problem& problem) {
  const SearchWindow& window = problem.window;
  std::vector<WhsCounts> map(static_cast<std::size_t>(window.width() * window.height()));
  whsScoreMap(problem.view, problem.test.image, window, map);
  const WhsNorms norms = whsNorms(problem.view);
  struct Place {
    int x, y;
    WhsCounts counts;
    std::tuple<std::int64_t, std::int64_t, int, int> order;
  };
  std::vector<Place> places;
  for (int y = 0; y < window.height(); ++y) {
    for (int x = 0; x < window.width(); ++x) {
      const WhsCounts counts = map[static_cast<std::size_t>(y * window.width() + x)];
      const std::int64_t dx = window.x_min + x - problem.predicted_x;
      const std::int64_t dy = window.y_min + y - problem.predicted_y;
      places.push_back({x, y, counts, {-whsComparable(counts, norms), dx * dx + dy * dy, y, x}});
    }
  }
  const auto less = [](const Place& a, const Place& b) { return a.order < b.order; };
  const Place best = *std::min_element(places.begin(), places.end(), less);
  WhsPeak peak{window.x_min + best.x, window.y_min + best.y, best.counts, 0, 0, {}, false};
  const int e = problem.exclusion_px;
  std::erase_if(places, [&](const Place& place) {
    const int x = place.x / 8 * 8, y = place.y / 8 * 8;
    return x + 7 >= best.x - e && x <= best.x + e && y + 7 >= best.y - e && y <= best.y + e;
  });
  if (places.empty()) return peak;
  const Place second = *std::min_element(places.begin(), places.end(), less);
  peak.second_x = window.x_min + second.x;
  peak.second_y = window.y_min + second.y;
  peak.second_counts = second.counts;
  peak.has_second = true;
  return peak;
}

TEST(WhsSearch, EqualsTheDefinitionForRandomInput) {
  Dice dice;
  OwnedSearch owned(64, 300);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int trial = 0; trial < 600; ++trial) {
    const int side = 2 * dice.between(4, 20);
    const MaskKind kind = static_cast<MaskKind>(trial % static_cast<int>(MaskKind::kCount));
    const auto problem = randomProblem(side, kind, 60, 60, dice);
    SCOPED_TRACE(testing::Message()
                 << "trial " << trial << " side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
    ASSERT_EQ(owned.search.norms(), whsNormsReference(problem->view));
  }
}

TEST(WhsSearch, EqualsTheDefinitionForEverySide) {
  Dice dice;
  OwnedSearch owned(512, 8);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int side = 8; side <= 512; side += 2) {
    const MaskKind kind = static_cast<MaskKind>(side / 2 % static_cast<int>(MaskKind::kCount));
    const auto problem = randomProblem(side, kind, 3, 3, dice);
    SCOPED_TRACE(testing::Message() << "side " << side << " mask " << static_cast<int>(kind));
    ASSERT_EQ(run(owned.search, *problem), reference(*problem));
  }
}

TEST(WhsSearch, EqualsTheMapOfCountsForWideWindows) {
  // Several tiles of columns and bands of rows, and the last words of each in all lengths.
  Dice dice;
  OwnedSearch owned(512, 1400);
  ASSERT_EQ(owned.status, Status::kOk);
  int trial = 0;
  for (const int side : {8, 16, 32, 62, 64, 66, 128, 200, 256, 512}) {
    for (int repetition = 0; repetition < 4; ++repetition, ++trial) {
      const MaskKind kind = static_cast<MaskKind>(trial % static_cast<int>(MaskKind::kCount));
      const bool wide = repetition % 2 == 0;
      const int budget = 400000000 / (side * side + 6000);
      const int most_x = wide ? 1400 : 90;
      const auto problem =
          randomProblem(side, kind, most_x, std::clamp(budget / most_x, 3, 1400), dice);
      problem->exclusion_px = dice.below(60);
      SCOPED_TRACE(testing::Message()
                   << "side " << side << " mask " << static_cast<int>(kind) << " window "
                   << problem->window.width() << " x " << problem->window.height());
      ASSERT_EQ(run(owned.search, *problem), peakOfMap(*problem));
    }
  }
}

TEST(WhsSearch, ListsTemplatesWithMorePixelsThanFitSomeRowsAtATime) {
  Dice dice;
  OwnedSearch owned(512, 200);
  ASSERT_EQ(owned.status, Status::kOk);
  for (const MaskKind kind : {MaskKind::kFull, MaskKind::kNoise, MaskKind::kRowStripes}) {
    const int side = 512;
    const Problem problem(noise(side, side, 0.9, dice), makeMask(side, side, kind, side, dice),
                          noise(side + 130, side + 40, 0.5, dice), side);
    ASSERT_GT(whsNorms(problem.view).edges, 3 * 6144);
    ASSERT_EQ(run(owned.search, problem), peakOfMap(problem));
  }
}

TEST(WhsSearch, BreaksTiesByDistanceThenRasterOrder) {
  Dice dice;
  OwnedSearch owned(64, 300);
  ASSERT_EQ(owned.status, Status::kOk);
  for (int trial = 0; trial < 200; ++trial) {
    // Edges and test edges of small period: most scores occur many times.
    const int period_x = dice.between(1, 9), period_y = dice.between(1, 9);
    const int side = 2 * dice.between(4, 16);
    const OwnedBits cell = noise(period_x, period_y, dice.uniform(0.0, 1.0), dice);
    const auto tiled = [&](int width, int height) {
      OwnedBits bits(width, height);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (cell.image.get(x % period_x, y % period_y)) bits.image.set(x, y);
        }
      }
      return bits;
    };
    const MaskKind kind = trial % 2 == 0 ? MaskKind::kFull : MaskKind::kCircle;
    Problem problem(tiled(side, side), makeMask(side, side, kind, side, dice),
                    tiled(side + dice.below(80), side + dice.below(80)), side);
    problem.predicted_x = dice.between(0, 100);
    problem.predicted_y = dice.between(0, 100);
    problem.exclusion_px = dice.below(12);
    ASSERT_EQ(run(owned.search, problem), reference(problem)) << "trial " << trial;
  }
}

TEST(WhsSearch, FindsTheNearestOffsetWhereNothingDistinguishes) {
  Dice dice;
  OwnedSearch owned(32, 300);
  Problem problem(noise(32, 32, 0.1, dice), makeMask(32, 32, MaskKind::kFull, 32, dice),
                  OwnedBits(200, 180), 32);
  problem.predicted_x = 77;
  problem.predicted_y = 101;
  problem.exclusion_px = 8;
  const WhsPeak peak = run(owned.search, problem);
  EXPECT_EQ(peak.x, 77);
  EXPECT_EQ(peak.y, 101);
  EXPECT_EQ(peak, reference(problem));
}

TEST(WhsSearch, HasNoSecondWhenTheExclusionCoversTheWindow) {
  Dice dice;
  OwnedSearch owned(32, 300);
  Problem problem(noise(32, 32, 0.1, dice), makeMask(32, 32, MaskKind::kFull, 32, dice),
                  noise(90, 95, 0.1, dice), 32);
  problem.exclusion_px = 100;
  EXPECT_FALSE(run(owned.search, problem).has_second);
  EXPECT_EQ(owned.search.peak(), reference(problem));
  problem.exclusion_px = std::numeric_limits<int>::max();
  EXPECT_FALSE(run(owned.search, problem).has_second);
  problem.exclusion_px = 20;
  const WhsPeak peak = run(owned.search, problem);
  EXPECT_TRUE(peak.has_second);
  EXPECT_EQ(peak, reference(problem));
}

TEST(WhsSearch, FindsADisplacedCopy) {
  Dice dice;
  OwnedSearch owned(64, 300);
  Problem problem(noise(300, 280, 0.06, dice), makeMask(300, 280, MaskKind::kFull, 64, dice),
                  OwnedBits(300, 280), 64);
  for (int y = 0; y < 280 - 7; ++y) {
    for (int x = 11; x < 300; ++x) {
      if (problem.edges.image.get(x, y)) problem.test.image.set(x - 11, y + 7);
    }
  }
  problem.moveTemplate(150, 140);
  const WhsPeak peak = run(owned.search, problem);
  EXPECT_EQ(peak.x, 150 - 11);
  EXPECT_EQ(peak.y, 140 + 7);
  EXPECT_DOUBLE_EQ(whsScore(peak.counts, owned.search.norms()), 2.0);
}

TEST(WhsSearch, FindsACopyInTheLastColumnsOfEveryWidth) {
  // Where a word, a register or a tile ends, counters must not lose pixels.
  Dice dice;
  OwnedSearch owned(16, 1400);
  constexpr int kSide = 16;
  const auto search = [&](int offsets, int from_last) {
    Problem problem(noise(kSide, kSide, 0.2, dice),
                    makeMask(kSide, kSide, MaskKind::kFull, kSide, dice),
                    OwnedBits(offsets + kSide - 1, kSide + 2), kSide);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        if (problem.edges.image.get(x, y)) {
          problem.test.image.set(offsets - 1 - from_last + x, y + 1);
        }
      }
    }
    const WhsPeak peak = run(owned.search, problem);
    EXPECT_EQ(peak.x, problem.window.x_max - from_last) << offsets << " offsets";
    EXPECT_EQ(peak.y, problem.window.y_min + 1);
    EXPECT_EQ(peak.counts.edge_hits, owned.search.norms().edges);
  };
  for (int offsets = 8; offsets < 1400; offsets += offsets < 280 || offsets > 620 ? 1 : 13) {
    search(offsets, dice.below(8));
  }
}

TEST(WhsSearch, CountsMasksThatHideAndBareTheWholeImageByTurns) {
  // Rows of mask on rows of test edges: from one offset to the next all or nothing is covered.
  for (const int side : {64, 254, 258, 300, 512}) {
    Dice dice;
    OwnedSearch owned(512, 100);
    OwnedBits test(side + 70, side + 9);
    for (int y = 0; y < test.image.height; y += 2) {
      for (int x = 0; x < test.image.width; ++x) test.image.set(x, y);
    }
    Problem problem(noise(side, side, 0.02, dice),
                    makeMask(side, side, MaskKind::kRowStripes, side, dice), std::move(test), side);
    problem.exclusion_px = 1;
    for (const int row : {2, 3}) {  // bare and hidden offsets score the same: the nearest is best
      problem.predicted_y = problem.window.y_min + row;
      ASSERT_EQ(run(owned.search, problem), peakOfMap(problem)) << "side " << side;
    }
  }
}

TEST(WhsSearch, TakesBoundedStepsWhichOtherSearchesMayInterrupt) {
  Dice dice;
  OwnedSearch first(256, 700), second(256, 700);
  std::vector<std::unique_ptr<Problem>> problems;
  for (int k = 0; k < 2; ++k) {
    problems.push_back(std::make_unique<Problem>(
        noise(256, 256, 0.03, dice), makeMask(256, 256, MaskKind::kCircle, 256, dice),
        noise(900 - 31 * k, 800 + 17 * k, 0.06, dice), 256));
  }
  const WhsPeak first_whole = run(first.search, *problems[0]);
  const WhsPeak second_whole = run(second.search, *problems[1]);
  ASSERT_EQ(beginOn(first.search, *problems[0]), Status::kOk);
  ASSERT_EQ(beginOn(second.search, *problems[1]), Status::kOk);
  int steps = 0;
  for (bool first_done = false, second_done = false; !first_done || !second_done; ++steps) {
    if (!first_done) first_done = first.search.step();
    if (!second_done) second_done = second.search.step();
  }
  EXPECT_GT(steps, 4);
  EXPECT_EQ(first.search.peak(), first_whole);
  EXPECT_EQ(second.search.peak(), second_whole);
}

TEST(WhsSearch, MayBeginAgainBeforeItIsDone) {
  Dice dice;
  OwnedSearch owned(256, 700);
  Problem large(noise(256, 256, 0.03, dice), makeMask(256, 256, MaskKind::kRing, 256, dice),
                noise(900, 800, 0.06, dice), 256);
  ASSERT_EQ(beginOn(owned.search, large), Status::kOk);
  ASSERT_FALSE(owned.search.step());
  const auto problem = randomProblem(20, MaskKind::kFull, 60, 60, dice);
  EXPECT_EQ(run(owned.search, *problem), reference(*problem));
}

TEST(WhsSearch, RefusesWhatItCannotSearch) {
  Dice dice;
  OwnedSearch owned(64, 100);
  Problem problem(noise(128, 128, 0.1, dice), makeMask(128, 128, MaskKind::kFull, 64, dice),
                  noise(300, 300, 0.1, dice), 64);
  problem.moveTemplate(64, 64);
  problem.window = {100, 100, 150, 150};
  EXPECT_EQ(beginOn(owned.search, problem), Status::kOk);
  const auto statusWith = [&](auto change) {
    const TemplateView view = problem.view;
    const SearchWindow window = problem.window;
    const int exclusion_px = problem.exclusion_px;
    change();
    const Status status = beginOn(owned.search, problem);
    EXPECT_TRUE(owned.search.step() || status == Status::kOk);
    problem.view = view;
    problem.window = window;
    problem.exclusion_px = exclusion_px;
    return status;
  };
  EXPECT_EQ(statusWith([&] { problem.view.edges = nullptr; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.mask = nullptr; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.side_px = 63; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.side_px = 0; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.side_px = 514; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.center_x = 31; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.view.center_y = 97; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.window = SearchWindow{}; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.window.x_min = 31; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.window.y_max = 269; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.exclusion_px = -1; }), Status::kInvalidOption);
  EXPECT_EQ(statusWith([&] { problem.window.x_max = 200; }), Status::kCapacityExceeded);
  EXPECT_EQ(statusWith([&] { problem.window.y_max = 200; }), Status::kCapacityExceeded);
  EXPECT_EQ(statusWith([&] { problem.view.side_px = 66; }), Status::kCapacityExceeded);
  EXPECT_EQ(statusWith([] {}), Status::kOk);
  WhsSearch fresh;
  EXPECT_TRUE(fresh.step());
}

TEST(WhsSearch, NeedsLittleMemoryAndSaysWhenItHasLess) {
  Arena count;
  WhsSearch search;
  ASSERT_EQ(search.create(512, 1400, count), Status::kOk);
  EXPECT_LT(count.highWater(), 400000u);
  std::vector<std::byte> memory(count.highWater() - 1);
  Arena arena{memory};
  EXPECT_EQ(search.create(512, 1400, arena), Status::kArenaTooSmall);
  Arena other;
  EXPECT_EQ(search.create(514, 1400, other), Status::kInvalidOption);
  EXPECT_EQ(search.create(0, 1400, other), Status::kInvalidOption);
  EXPECT_EQ(search.create(512, 0, other), Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight
