// SPDX-License-Identifier: Apache-2.0
#include "core/templates/template_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "core/base/random.h"

namespace boresight {
namespace {

struct DrawnPixel {
  int x, y;
  double nx, ny;
};

/// An edge render made by hand: what the selector reads of it, nothing else.
class DrawnRender {
 public:
  DrawnRender(int width, int height) : memory_(8 << 20), arena_(memory_) {
    RenderOptions options;
    options.max_edge_pixels = 40000;
    render = createEdgeRender(width, height, options, arena_);
    render.camera.width = width;
    render.camera.height = height;
    render.camera.fx = render.camera.fy = 500.0;
    render.camera.cx = 0.5 * width;
    render.camera.cy = 0.5 * height;
    EXPECT_EQ(prepareCamera(render.camera), Status::kOk);
    render.edges.width = render.mask.width = width;
    render.edges.height = render.mask.height = height;
  }

  void set(std::vector<DrawnPixel> drawn) {
    std::sort(drawn.begin(), drawn.end(), [](const DrawnPixel& a, const DrawnPixel& b) {
      return a.y != b.y ? a.y < b.y : a.x < b.x;
    });
    render.edges.clear();
    render.pixel_count = 0;
    std::ranges::fill(render.row_begin, 0);
    for (const DrawnPixel& pixel : drawn) {
      if (render.edges.get(pixel.x, pixel.y)) continue;
      render.edges.set(pixel.x, pixel.y);
      EdgePixel edge_pixel;
      edge_pixel.x = static_cast<std::int16_t>(pixel.x);
      edge_pixel.y = static_cast<std::int16_t>(pixel.y);
      edge_pixel.depth_m = 1.0F;
      edge_pixel.normal_x = static_cast<std::int8_t>(std::lround(127.0 * pixel.nx));
      edge_pixel.normal_y = static_cast<std::int8_t>(std::lround(127.0 * pixel.ny));
      render.pixels[static_cast<std::size_t>(render.pixel_count++)] = PackedEdgePixel(edge_pixel);
      render.row_begin[static_cast<std::size_t>(pixel.y) + 1] = render.pixel_count;
    }
    for (std::size_t y = 1; y < render.row_begin.size(); ++y)
      render.row_begin[y] = std::max(render.row_begin[y], render.row_begin[y - 1]);
  }

  EdgeRender render;

 private:
  std::vector<std::byte> memory_;
  Arena arena_;
};

std::vector<DrawnPixel> squareOutline(int left, int top, int side) {
  std::vector<DrawnPixel> drawn;
  for (int i = 0; i <= side; ++i) {
    drawn.push_back({left + i, top, 0.0, -1.0});
    drawn.push_back({left + i, top + side, 0.0, 1.0});
    drawn.push_back({left, top + i, -1.0, 0.0});
    drawn.push_back({left + side, top + i, 1.0, 0.0});
  }
  return drawn;
}

class Selector {
 public:
  explicit Selector(const TemplateOptions& options, int width = 512, int height = 512)
      : memory_(16 << 20), arena_(memory_) {
    EXPECT_EQ(selector_.create(width, height, options, arena_), Status::kOk);
    set = createTemplateSet(options, arena_);
  }
  Status select(const EdgeRender& render, int side_px, const BitImage* ignore = nullptr,
                int level = 0) {
    return selector_.select(render, side_px, ignore, level, set);
  }
  TemplateSet set;

 private:
  std::vector<std::byte> memory_;
  Arena arena_;
  TemplateSelector selector_;
};

TEST(TemplateSelector, PrefersCornersToStraightEdges) {
  DrawnRender drawn(512, 512);
  drawn.set(squareOutline(100, 100, 300));
  TemplateOptions options;
  options.count = 4;
  Selector selector(options);
  EXPECT_EQ(selector.select(drawn.render, 32), Status::kTooFewTemplates);
  ASSERT_EQ(selector.set.count, 4);
  for (int i = 0; i < 4; ++i) {
    const Template& item = selector.set.templates[static_cast<std::size_t>(i)];
    const int to_corner_x = std::min(std::abs(item.center_x - 100), std::abs(item.center_x - 400));
    const int to_corner_y = std::min(std::abs(item.center_y - 100), std::abs(item.center_y - 400));
    EXPECT_LE(std::max(to_corner_x, to_corner_y), 20) << item.center_x << "," << item.center_y;
  }
}

TEST(TemplateSelector, Templates_AreCentredOnEdgePixelsInsideTheImageAndWithinTheCount) {
  DrawnRender drawn(320, 240);
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<DrawnPixel> pixels;
    for (int i = 0; i < 24000; ++i) {
      const double angle = random.uniform(0.0, 6.28);
      pixels.push_back({static_cast<int>(random.below(320)), static_cast<int>(random.below(240)),
                        std::cos(angle), std::sin(angle)});
    }
    drawn.set(pixels);
    TemplateOptions options;
    options.count = 24 + static_cast<std::int32_t>(random.below(100));
    Selector selector(options, 320, 240);
    const int side_px = 8 << random.below(4);
    ASSERT_EQ(selector.select(drawn.render, side_px), Status::kOk);
    EXPECT_LE(selector.set.count, options.count);
    EXPECT_GE(selector.set.count, options.count / 4);
    std::set<std::pair<int, int>> places;
    for (int i = 0; i < selector.set.count; ++i) {
      const Template& item = selector.set.templates[static_cast<std::size_t>(i)];
      EXPECT_TRUE(drawn.render.edges.get(item.center_x, item.center_y));
      EXPECT_GE(item.center_x, side_px / 2);
      EXPECT_GE(item.center_y, side_px / 2);
      EXPECT_LE(item.center_x + side_px / 2, 320);
      EXPECT_LE(item.center_y + side_px / 2, 240);
      EXPECT_TRUE(places.insert({item.center_x, item.center_y}).second);
      EXPECT_NEAR(item.point_in_station_m.z(), 1.0, 1e-6);
    }
  }
}

TEST(TemplateSelector, DistinctnessIsTheSmallerEigenvalueOfTheScatter) {
  // All within one block-aligned square: the table must give the plain sum.
  DrawnRender drawn(256, 256);
  std::vector<DrawnPixel> pixels;
  Random random(3);
  double xx = 0, xy = 0, yy = 0;
  for (int i = 0; i < 60; ++i) {
    const double angle = random.uniform(0.0, 1.0);
    const int nx = static_cast<int>(std::lround(127.0 * std::cos(angle)));
    const int ny = static_cast<int>(std::lround(127.0 * std::sin(angle)));
    pixels.push_back({120 + i % 8, 120 + i / 8, nx / 127.0, ny / 127.0});
    xx += nx * nx / 16129.0;
    xy += nx * ny / 16129.0;
    yy += ny * ny / 16129.0;
  }
  drawn.set(pixels);
  TemplateOptions options;
  options.count = 4;
  Selector selector(options, 256, 256);
  (void)selector.select(drawn.render, 64);  // how many cells a cluster fills does not matter here
  ASSERT_GE(selector.set.count, 1);
  const double smaller = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
  EXPECT_NEAR(selector.set.templates[0].distinctness, smaller, 1e-3);
}

TEST(TemplateSelector, RejectsTemplatesWhoseAreaIsIgnored) {
  DrawnRender drawn(512, 512);
  drawn.set(squareOutline(100, 100, 300));
  std::vector<std::byte> memory(4 << 20);
  Arena arena(memory);
  BitImage ignore = BitImage::create(arena, 1024, 1024);  // the render is at level 1
  for (int y = 0; y < 1024; ++y) {
    for (int x = 0; x < 512; ++x) ignore.set(x, y);
  }
  TemplateOptions options;
  options.count = 64;
  Selector selector(options);
  ASSERT_EQ(selector.select(drawn.render, 32, &ignore, 1), Status::kOk);
  for (int i = 0; i < selector.set.count; ++i) {
    const int ignored_columns =
        256 - (selector.set.templates[static_cast<std::size_t>(i)].center_x - 16);
    EXPECT_LE(ignored_columns, 0.3 * 32);
  }
}

/// Small corners far apart, under random ignored rectangles: a corner has a template exactly when a
/// square around one of its pixels is ignored by no more than the limit, counted pixel by pixel.
TEST(TemplateSelector, IgnoredShare_IsThatOfCountingPixels) {
  constexpr int kSide_px = 32;
  std::vector<DrawnPixel> pixels;
  for (int top = 40; top < 470; top += 64)
    for (int left = 40; left < 470; left += 64)
      for (int i = 0; i < 12; ++i) {
        pixels.push_back({left + i, top, 0.0, 1.0});
        pixels.push_back({left, top + i, 1.0, 0.0});
      }
  DrawnRender drawn(512, 512);
  drawn.set(pixels);
  Random random(7);
  int left_out = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const int level = trial % 3;
    const int scale = 1 << level;
    std::vector<std::byte> memory(4 << 20);
    Arena arena(memory);
    BitImage ignore = BitImage::create(arena, 512 * scale, 512 * scale);
    for (int i = 0; i < 60; ++i) {
      const int x0 = static_cast<int>(random.below(512));
      const int y0 = static_cast<int>(random.below(512));
      for (int y = y0 * scale; y < std::min(512, y0 + 24) * scale; ++y)
        for (int x = x0 * scale; x < std::min(512, x0 + 37) * scale; ++x) ignore.set(x, y);
    }
    const auto share = [&](int center_x, int center_y) {
      int count = 0;
      for (int y = (center_y - kSide_px / 2) * scale; y < (center_y + kSide_px / 2) * scale; ++y)
        for (int x = (center_x - kSide_px / 2) * scale; x < (center_x + kSide_px / 2) * scale; ++x)
          count += ignore.get(x, y) ? 1 : 0;
      return static_cast<double>(count) / (kSide_px * scale * kSide_px * scale);
    };
    TemplateOptions options;
    options.count = 1024;
    Selector selector(options);
    ASSERT_EQ(selector.select(drawn.render, kSide_px, &ignore, level), Status::kOk);
    std::set<std::pair<int, int>> selected;
    for (int i = 0; i < selector.set.count; ++i) {
      const Template& item = selector.set.templates[static_cast<std::size_t>(i)];
      EXPECT_LE(share(item.center_x, item.center_y), 0.3);
      selected.insert({(item.center_x - 40) / 64, (item.center_y - 40) / 64});
    }
    std::set<std::pair<int, int>> allowed;
    for (const DrawnPixel& pixel : pixels)
      if (share(pixel.x, pixel.y) <= 0.3)
        allowed.insert({(pixel.x - 40) / 64, (pixel.y - 40) / 64});
    EXPECT_EQ(selected, allowed) << "level " << level;
    left_out += 49 - static_cast<int>(allowed.size());
  }
  EXPECT_GT(left_out, 20);  // else the masks show nothing
}

TEST(TemplateSelector, TooFewTemplates_AreReported) {
  DrawnRender drawn(512, 512);
  drawn.set({});
  Selector selector(TemplateOptions{});
  EXPECT_EQ(selector.select(drawn.render, 64), Status::kTooFewTemplates);
  EXPECT_EQ(selector.set.count, 0);
}

TEST(TemplateSide, IsThePowerOfTwoNearestToTheProjectedFeature) {
  Camera camera;
  camera.width = camera.height = 2048;
  camera.fx = camera.fy = 3000.0;
  TemplateOptions options;
  options.size_factor = 1.0;
  EXPECT_EQ(templateSide(options, 0.0128, 0.3, camera), 128);
  EXPECT_EQ(templateSide(options, 0.0128 * 1.40, 0.3, camera), 128);
  EXPECT_EQ(templateSide(options, 0.0128 * 1.43, 0.3, camera), 256);
  EXPECT_EQ(templateSide(options, 0.0001, 0.3, camera), TemplateSelector::kMinSide_px);
  EXPECT_EQ(templateSide(options, 1.0, 0.3, camera), TemplateSelector::kMaxSide_px);
  camera.width = camera.height = 256;
  EXPECT_LE(templateSide(options, 1.0, 0.3, camera), 64);
}

}  // namespace
}  // namespace boresight
