// SPDX-License-Identifier: Apache-2.0
#include "core/match/template_warp.h"

#include <cmath>
#include <complex>
#include <memory>

#include <gtest/gtest.h>

#include "core/match/warped_search.h"
#include "tests/core/match/match_support.h"

namespace boresight::test {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// A warper with memory of its own.
struct OwnedWarp {
  explicit OwnedWarp(int max_side_px) : memory(std::make_unique<std::byte[]>(1 << 20)) {
    Arena arena({memory.get(), 1 << 20});
    warped.create(max_side_px, arena);
    EXPECT_FALSE(arena.exhausted());
  }
  std::unique_ptr<std::byte[]> memory;
  WarpedTemplate warped;
};

/// Lines through an image, one pixel wide, all of them in the mask.
struct Drawing {
  Drawing(int width, int height, Dice& dice) : edges(width, height), mask(width, height) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) mask.image.set(x, y);
    for (int line = 0; line < 7; ++line) {
      const std::complex<double> at(dice.uniform(0.2, 0.8) * width,
                                    dice.uniform(0.2, 0.8) * height);
      const std::complex<double> along = std::polar(1.0, dice.uniform(0.0, 3.14));
      for (double s = -0.2 * width; s < 0.2 * width; s += 0.5) {
        const auto point = at + s * along;
        const int x = static_cast<int>(std::lround(point.real()));
        const int y = static_cast<int>(std::lround(point.imag()));
        if (edges.image.contains(x, y)) edges.image.set(x, y);
      }
    }
  }
  TemplateView view(int x, int y, int side_px) const {
    return {&edges.image, &mask.image, x, y, side_px};
  }
  OwnedBits edges, mask;
};

bool hasEdgeNear(const BitImage& image, std::complex<double> point, double distance_px) {
  const int reach = static_cast<int>(std::ceil(distance_px)) + 1;
  const int x0 = static_cast<int>(std::lround(point.real()));
  const int y0 = static_cast<int>(std::lround(point.imag()));
  for (int y = y0 - reach; y <= y0 + reach; ++y) {
    for (int x = x0 - reach; x <= x0 + reach; ++x) {
      if (!image.contains(x, y) || !image.get(x, y)) continue;
      if (std::abs(std::complex<double>(x, y) - point) <= distance_px) return true;
    }
  }
  return false;
}

TEST(TemplateWarp, IdentityLeavesEveryBit) {
  Dice dice;
  const Drawing drawn(90, 80, dice);
  OwnedWarp owner(32);
  const TemplateView view = drawn.view(41, 37, 32);
  const TemplateView warped = owner.warped.warp(view, {});
  for (int v = 0; v < 32; ++v) {
    for (int u = 0; u < 32; ++u) {
      EXPECT_EQ(warped.edges->get(u, v), view.edges->get(25 + u, 21 + v)) << u << "," << v;
      EXPECT_TRUE(warped.mask->get(u, v));
    }
  }
}

/// Where an edge pixel goes by complex multiplication, and back.
TEST(TemplateWarp, TurnsAndScalesEdgesAboutTheCentre) {
  Dice dice;
  constexpr double kHalfDiagonal = 0.7072;
  for (int round = 0; round < 30; ++round) {
    const Drawing drawn(200, 200, dice);
    OwnedWarp owner(64);
    const TemplateView view = drawn.view(dice.between(90, 110), dice.between(90, 110), 64);
    const TemplateWarp warp{dice.uniform(-0.6, 0.6), dice.uniform(0.8, 1.25)};
    const TemplateView warped = owner.warped.warp(view, warp);
    const std::complex<double> turn = std::polar(warp.scale, warp.roll_rad);
    const std::complex<double> centre(view.center_x, view.center_y), middle(32.0, 32.0);
    int seen = 0;
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        if (!warped.edges->get(u, v)) continue;
        ++seen;
        const auto from = centre + (std::complex<double>(u, v) - middle) / turn;
        EXPECT_TRUE(hasEdgeNear(*view.edges, from, kHalfDiagonal)) << u << "," << v;
      }
    }
    EXPECT_GT(seen, 30);
    for (int y = view.center_y - 15; y <= view.center_y + 15; ++y) {
      for (int x = view.center_x - 15; x <= view.center_x + 15; ++x) {
        if (!view.edges->get(x, y)) continue;
        const auto to = middle + (std::complex<double>(x, y) - centre) * turn;
        EXPECT_TRUE(hasEdgeNear(*warped.edges, to, kHalfDiagonal * (1.0 + warp.scale)));
      }
    }
  }
}

TEST(TemplateWarp, WhatComesFromOutsideTheRenderIsNotInTheMask) {
  Dice dice;
  const Drawing drawn(64, 64, dice);
  OwnedWarp owner(64);
  const TemplateView warped = owner.warped.warp(drawn.view(32, 32, 64), {45.0 * kDegree, 1.0});
  EXPECT_FALSE(warped.mask->get(1, 1));
  EXPECT_TRUE(warped.mask->get(32, 1));
  const TemplateView smaller = owner.warped.warp(drawn.view(32, 32, 64), {0.0, 0.5});
  EXPECT_FALSE(smaller.mask->get(14, 32));
  EXPECT_TRUE(smaller.mask->get(18, 32));
  EXPECT_FALSE(smaller.edges->get(1, 1)) << "bits of the warp before are gone";
}

TEST(TemplateWarp, GridServesEveryTurnAndDepthThatTheUncertaintyAllows) {
  Dice dice;
  for (int round = 0; round < 2000; ++round) {
    WarpOptions options;
    options.tolerance_px = dice.uniform(0.5, 6.0);
    options.max_per_template = 99999;
    SeedUncertainty uncertainty;
    for (int i = 0; i < 3; ++i) {
      uncertainty.rotation_rad[i] = dice.uniform(0.0, 0.5);
      uncertainty.translation_m[i] = dice.uniform(0.0, 0.05);
    }
    uncertainty.pivot_in_camera_m = {dice.uniform(-0.1, 0.1), dice.uniform(-0.1, 0.1), 0.5};
    const Eigen::Vector3d point_m(dice.uniform(-0.2, 0.2), dice.uniform(-0.2, 0.2),
                                  dice.uniform(0.4, 0.8));
    const int side_px = 16 << dice.below(4);
    const WarpGrid grid = warpGrid(options, uncertainty, point_m, side_px);
    EXPECT_EQ(grid.rolls % 2, 1);
    EXPECT_EQ(grid.scales % 2, 1);
    EXPECT_EQ(grid.at(0), TemplateWarp());
    const double roll_rad = dice.uniform(-1.0, 1.0) * uncertainty.rotation_rad.z();
    const Eigen::Vector3d arm_m = point_m - uncertainty.pivot_in_camera_m;
    const double depth_offset_m =
        dice.uniform(-1.0, 1.0) * uncertainty.translation_m.z() +
        dice.uniform(-1.0, 1.0) * uncertainty.rotation_rad.x() * arm_m.y() -
        dice.uniform(-1.0, 1.0) * uncertainty.rotation_rad.y() * arm_m.x();
    const double scale = 1.0 + depth_offset_m / point_m.z();
    double roll_px = 1e9, scale_px = 1e9;
    for (std::int32_t i = 0; i < grid.count(); ++i) {
      const TemplateWarp warp = grid.at(i);
      roll_px = std::min(roll_px, 0.5 * side_px * std::abs(warp.roll_rad - roll_rad));
      scale_px = std::min(scale_px, 0.5 * side_px * std::abs(warp.scale - scale));
    }
    EXPECT_LE(roll_px, options.tolerance_px + 1e-9);
    if (std::abs(scale - 1.0) < 0.5) {
      EXPECT_LE(scale_px, options.tolerance_px + 1e-9);
    }
    // Two fewer would not do.
    if (grid.rolls > 1) {
      EXPECT_LT((grid.rolls - 2) * options.tolerance_px,
                0.5 * side_px * uncertainty.rotation_rad.z());
    }
  }
}

TEST(TemplateWarp, GridHoldsNoMoreThanAllowed) {
  Dice dice;
  for (int round = 0; round < 500; ++round) {
    WarpOptions options;
    options.tolerance_px = 0.25;
    options.max_per_template = dice.between(1, 80);
    SeedUncertainty uncertainty;
    uncertainty.rotation_rad.setConstant(dice.uniform(0.0, 3.5));
    uncertainty.translation_m.setConstant(dice.uniform(0.0, 1.0));
    const WarpGrid grid = warpGrid(options, uncertainty, {0.1, 0.0, 0.5}, 128);
    EXPECT_LE(grid.count(), options.max_per_template);
    for (std::int32_t i = -1; i <= grid.count(); ++i) EXPECT_GT(grid.at(i).scale, 0.4);
  }
}

struct OwnedSearch {
  explicit OwnedSearch(bool warps) : memory(std::make_unique<std::byte[]>(4 << 20)) {
    Arena arena({memory.get(), 4 << 20});
    EXPECT_EQ(search.create(64, 400, warps, Kernels::kPortable, arena), Status::kOk);
  }
  void run(const SearchTask& task) {
    ASSERT_EQ(search.begin(task), Status::kOk);
    while (!search.step()) {
    }
  }
  std::unique_ptr<std::byte[]> memory;
  WarpedSearch search;
};

TEST(WarpedSearch, WithOneWarpIsThePlainSearch) {
  Dice dice;
  for (int round = 0; round < 10; ++round) {
    const Drawing drawn(128, 128, dice);
    OwnedBits seen = noise(160, 160, 0.1, dice);
    const SearchTask task{drawn.view(64, 64, 64), &seen.image, {40, 40, 120, 110}, {}, 6, true};
    OwnedSearch warped(false);
    warped.run(task);
    std::vector<std::byte> memory(4 << 20);
    Arena arena(memory);
    WhsSearch plain;
    ASSERT_EQ(plain.create(64, 400, Kernels::kPortable, arena), Status::kOk);
    ASSERT_EQ(plain.begin(task.view, seen.image, task.window, 64, 64, 6), Status::kOk);
    while (!plain.step()) {
    }
    double x = 0.0, y = 0.0;
    subpixelPeak(task.view, seen.image, plain.peak(), x, y);
    EXPECT_EQ(warped.search.peak(), plain.peak());
    EXPECT_EQ(warped.search.norms(), plain.norms());
    EXPECT_EQ(warped.search.x(), x);
    EXPECT_EQ(warped.search.y(), y);
    EXPECT_EQ(warped.search.warp(), TemplateWarp());
  }
}

/// What the camera sees is the drawing turned and scaled: the place and the warp come out.
TEST(WarpedSearch, FindsWhatIsTurnedAndScaled) {
  Dice dice;
  int plain_better = 0;
  for (int round = 0; round < 12; ++round) {
    const Drawing drawn(200, 200, dice);
    const double roll_rad = (round % 2 == 0 ? 1.0 : -1.0) * dice.uniform(10.0, 18.0) * kDegree;
    const double scale = dice.uniform(0.9, 1.1);
    const std::complex<double> turn = std::polar(scale, roll_rad);
    const int found_x = dice.between(90, 130), found_y = dice.between(90, 130);
    OwnedBits seen(220, 220);
    for (int y = 0; y < 220; ++y) {
      for (int x = 0; x < 220; ++x) {
        const auto from = std::complex<double>(100.0, 100.0) +
                          std::complex<double>(x - found_x, y - found_y) / turn;
        const int u = static_cast<int>(std::lround(from.real()));
        const int v = static_cast<int>(std::lround(from.imag()));
        if (drawn.edges.image.contains(u, v) && drawn.edges.image.get(u, v)) seen.image.set(x, y);
      }
    }
    SearchTask task{drawn.view(100, 100, 64), &seen.image, {70, 70, 150, 150}, {}, 6, true};
    OwnedSearch plain(false), warped(true);
    plain.run(task);
    task.warps.rolls = 9;
    task.warps.scales = 3;
    task.warps.roll_step_rad = 5.0 * kDegree;
    task.warps.scale_step = 0.1;
    warped.run(task);
    EXPECT_NEAR(warped.search.x(), found_x, 1.5);
    EXPECT_NEAR(warped.search.y(), found_y, 1.5);
    EXPECT_NEAR(warped.search.warp().roll_rad, roll_rad, 3.0 * kDegree);
    EXPECT_NEAR(warped.search.warp().scale, scale, 0.08);
    const double of_plain = whsScore(plain.search.peak().counts, plain.search.norms());
    const double of_warped = whsScore(warped.search.peak().counts, warped.search.norms());
    plain_better += of_plain >= of_warped ? 1 : 0;
  }
  EXPECT_EQ(plain_better, 0);
}

}  // namespace
}  // namespace boresight::test
