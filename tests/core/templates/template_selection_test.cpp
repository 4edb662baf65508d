// SPDX-License-Identifier: Apache-2.0
#include "core/templates/template_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

struct DrawnPixel {
  int x, y;
  double nx, ny;
};

/// A depth that tells pixels apart.
float depthAt(int x, int y) { return 0.5F + 0.001F * static_cast<float>((7 * x + 3 * y) % 100); }

/// An edge render made by hand: what the selector reads of it, nothing else.
class DrawnRender {
 public:
  DrawnRender(int width, int height) : memory_(8 << 20), arena_(memory_) {
    RenderOptions options;
    options.max_edge_pixels = 40000;
    render = createEdgeRender(width, height, options, arena_);
    render.camera = test::makePinhole(width, height, 500.0);
    render.camera_from_station.translation_m = {0.1, -0.2, 0.3};
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
      edge_pixel.depth_m = depthAt(pixel.x, pixel.y);
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
  std::span<const Template> chosen() const {
    return set.templates.first(static_cast<std::size_t>(set.count));
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
  for (const Template& item : selector.chosen()) {
    const int to_corner_x = std::min(std::abs(item.center_x - 100), std::abs(item.center_x - 400));
    const int to_corner_y = std::min(std::abs(item.center_y - 100), std::abs(item.center_y - 400));
    EXPECT_LE(std::max(to_corner_x, to_corner_y), 20) << item.center_x << "," << item.center_y;
  }
  drawn.set({});
  EXPECT_EQ(selector.select(drawn.render, 64), Status::kTooFewTemplates);
  EXPECT_EQ(selector.set.count, 0) << "without edges";
}

/// The selection by its definition, pixel by pixel: no sums, no bisection.
class PlainSelection {
 public:
  PlainSelection(const EdgeRender& render, int side_px, const BitImage* ignore, int level)
      : render_(render), side_px_(side_px) {
    for (const EdgePixel& pixel : render.eachPixel()) all_.push_back(pixel);
    for (const EdgePixel& pixel : all_) {
      if (!inside(pixel)) continue;
      inside_.push_back({pixel, ignoredShare(pixel, ignore, level) <= 0.3, distinctness(pixel)});
    }
  }

  /// Number of cells with a pixel whose square lies in the image.
  int occupied(int cell_px) const {
    std::set<Cell> cells;
    for (const Candidate& candidate : inside_) cells.insert(cellOf(candidate.pixel, cell_px));
    return static_cast<int>(cells.size());
  }

  /// x, y and distinctness of the chosen pixels, row by row of cells.
  std::vector<std::tuple<int, int, float>> chosen(int cell_px) const {
    std::map<Cell, const Candidate*> best;
    for (const Candidate& candidate : inside_) {
      if (!candidate.allowed || candidate.distinctness < 0.0F) continue;
      const Candidate*& kept = best[cellOf(candidate.pixel, cell_px)];
      if (kept == nullptr || candidate.distinctness > kept->distinctness) kept = &candidate;
    }
    std::vector<std::tuple<int, int, float>> list;
    for (const auto& [cell, kept] : best)
      list.emplace_back(kept->pixel.x, kept->pixel.y, kept->distinctness);
    return list;
  }

 private:
  struct Candidate {
    EdgePixel pixel;
    bool allowed;
    float distinctness;
  };
  using Cell = std::pair<int, int>;  ///< row, column
  static Cell cellOf(const EdgePixel& pixel, int cell_px) {
    return {pixel.y / cell_px, pixel.x / cell_px};
  }
  bool inside(const EdgePixel& pixel) const {
    const int half = side_px_ / 2;
    return std::min(pixel.x, pixel.y) >= half && pixel.x <= render_.edges.width - half &&
           pixel.y <= render_.edges.height - half;
  }
  double ignoredShare(const EdgePixel& pixel, const BitImage* ignore, int level) const {
    if (ignore == nullptr) return 0.0;
    const int scale = 1 << level;
    int count = 0;
    for (int y = (pixel.y - side_px_ / 2) * scale; y < (pixel.y + side_px_ / 2) * scale; ++y)
      for (int x = (pixel.x - side_px_ / 2) * scale; x < (pixel.x + side_px_ / 2) * scale; ++x)
        count += x < ignore->width && y < ignore->height && ignore->get(x, y) ? 1 : 0;
    return static_cast<double>(count) / (side_px_ * scale * side_px_ * scale);
  }
  /// Of the edge pixels in the blocks around the pixel's own; -1 for fewer than 12.
  float distinctness(const EdgePixel& at) const {
    const int longest = std::max(render_.edges.width, render_.edges.height);
    const int block = std::max({4, side_px_ / 8, (longest + 255) / 256});
    const int reach = std::clamp(side_px_ / block / 2, 1, 4);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    int count = 0;
    for (const EdgePixel& pixel : all_) {
      if (std::abs(pixel.x / block - at.x / block) > reach ||
          std::abs(pixel.y / block - at.y / block) > reach)
        continue;
      xx += pixel.normal_x * pixel.normal_x;
      xy += pixel.normal_x * pixel.normal_y;
      yy += pixel.normal_y * pixel.normal_y;
      ++count;
    }
    if (count < 12) return -1.0F;
    const double half = 0.5 * (xx - yy);
    const double smaller = 0.5 * (xx + yy) - std::sqrt(half * half + xy * xy);
    return static_cast<float>(std::max(0.0, smaller / (127.0 * 127.0)));
  }

  const EdgeRender& render_;
  int side_px_;
  std::vector<EdgePixel> all_;
  std::vector<Candidate> inside_;
};

/// Pixels with random normals, scattered and in lumps.
std::vector<DrawnPixel> randomPixels(int width, int height, Random& random) {
  std::vector<DrawnPixel> pixels;
  for (int lump = 0; lump < 60; ++lump) {
    const int extent = 1 + static_cast<int>(random.below(24));
    const int left = static_cast<int>(random.below(static_cast<std::uint32_t>(width - extent)));
    const int top = static_cast<int>(random.below(static_cast<std::uint32_t>(height - extent)));
    const double spread = random.uniform(0.0, 3.0);
    for (int i = 0; i < 30; ++i) {
      const double angle = random.uniform(0.0, spread);
      const auto below = [&] {
        return static_cast<int>(random.below(static_cast<std::uint32_t>(extent)));
      };
      pixels.push_back({left + below(), top + below(), std::cos(angle), std::sin(angle)});
    }
  }
  return pixels;
}

void ignoreRectangles(BitImage& ignore, Random& random) {
  for (int i = 0; i < 40; ++i) {
    const auto x0 = static_cast<int>(random.below(static_cast<std::uint32_t>(ignore.width)));
    const auto y0 = static_cast<int>(random.below(static_cast<std::uint32_t>(ignore.height)));
    for (int y = y0; y < std::min(ignore.height, y0 + ignore.height / 12); ++y)
      for (int x = x0; x < std::min(ignore.width, x0 + ignore.width / 10); ++x) ignore.set(x, y);
  }
}

/// Whether the templates are those of `plain` for a cell size that is small enough, while the next
/// smaller one is not.
bool isSelectionOf(const PlainSelection& plain, const Selector& selector, int most, int longest) {
  std::vector<std::tuple<int, int, float>> selected;
  for (const Template& item : selector.chosen())
    selected.emplace_back(item.center_x, item.center_y, item.distinctness);
  const int least = std::max(2, (longest + 255) / 256);
  for (int cell_px = least; cell_px <= longest; ++cell_px)
    if (plain.occupied(cell_px) <= most &&
        (cell_px == least || plain.occupied(cell_px - 1) > most) &&
        selected == plain.chosen(cell_px))
      return true;
  return false;
}

TEST(TemplateSelector, RandomRenders_SelectionIsThatOfThePlainDefinition) {
  Random random(7);
  int selected = 0;
  int few = 0;
  for (int trial = 0; trial < 48; ++trial) {
    const int width = std::array{200, 320, 640, 1200}[static_cast<std::size_t>(trial % 4)];
    const int height = width * 3 / 4;
    DrawnRender drawn(width, height);
    drawn.set(randomPixels(width, height, random));
    const int level = static_cast<int>(random.below(3));
    std::vector<std::byte> memory(4 << 20);
    Arena arena(memory);
    BitImage ignore = BitImage::create(arena, width << level, (height << level) - 5);
    ignoreRectangles(ignore, random);
    const BitImage* const mask = trial % 3 == 0 ? nullptr : &ignore;
    TemplateOptions options;
    options.count = 4 + static_cast<std::int32_t>(random.below(trial % 2 == 0 ? 12 : 400));
    Selector selector(options, width, height);
    const int side_px = 8 << random.below(4);
    const Status status = selector.select(drawn.render, side_px, mask, level);
    EXPECT_EQ(status, selector.set.count < 6 ? Status::kTooFewTemplates : Status::kOk);
    EXPECT_EQ(selector.set.side_px, side_px);
    EXPECT_TRUE(isSelectionOf(PlainSelection(drawn.render, side_px, mask, level), selector,
                              options.count, width))
        << "trial " << trial << ", side " << side_px << " px";
    for (const Template& item : selector.chosen()) {
      EXPECT_EQ(item.depth_m, depthAt(item.center_x, item.center_y));
      const Eigen::Vector3d ray((item.center_x - 0.5 * (width - 1)) / 500.0,
                                (item.center_y - 0.5 * (height - 1)) / 500.0, 1.0);
      const Eigen::Vector3d point_m = item.depth_m * ray - Eigen::Vector3d(0.1, -0.2, 0.3);
      EXPECT_LT((item.point_in_station_m - point_m).norm(), 1e-9);
    }
    selected += selector.set.count;
    few += status == Status::kTooFewTemplates ? 1 : 0;
  }
  EXPECT_GT(selected, 500);
  EXPECT_GT(few, 0);
}

TEST(TemplateSelector, InvalidOptionsAndTooLittleMemory_AreRefused) {
  std::vector<std::byte> memory(4 << 20);
  Arena arena(memory);
  TemplateSelector selector;
  TemplateOptions options;
  options.count = 3;
  EXPECT_EQ(selector.create(512, 512, options, arena), Status::kInvalidOption);
  Arena small(std::span<std::byte>(memory).first(1000));
  EXPECT_EQ(selector.create(512, 512, TemplateOptions(), small), Status::kArenaTooSmall);
}

TEST(TemplateSide, IsThePowerOfTwoNearestToTheProjectedFeature) {
  Camera camera;
  camera.width = camera.height = 2048;
  camera.fx = camera.fy = 3000.0;
  TemplateOptions options;
  options.size_factor = 1.0;
  double factor = 1.0;
  const auto side = [&](double feature_m, double depth_m = 0.3) {
    return templateSide(options, feature_m, depth_m, camera, factor);
  };
  EXPECT_EQ(side(0.0128), 128);
  EXPECT_EQ(side(0.0128 * 1.40), 128);
  EXPECT_EQ(side(0.0128 * 1.43), 256);
  EXPECT_EQ(side(0.0001), TemplateSelector::kMinSide_px);
  EXPECT_EQ(side(1.0), TemplateSelector::kMaxSide_px);
  EXPECT_EQ(side(0.0128, 0.0), TemplateSelector::kMaxSide_px);
  options.size_factor = 2.0;
  EXPECT_EQ(side(0.0064), 128);
  // The focal length is the mean of both, whatever the sign of the second.
  camera.fx = 5000.0;
  camera.fy = -1000.0;
  EXPECT_EQ(side(0.0064), 128);
  // At most a quarter of the image's smaller side.
  for (const auto& [height, largest] : {std::pair{256, 64}, {255, 32}, {40, 8}}) {
    camera.height = height;
    EXPECT_EQ(side(1.0), largest) << height;
  }
  // A further attempt is not held by the least side but by the largest one.
  camera.width = camera.height = 512;
  camera.fx = camera.fy = 750.0;
  options = TemplateOptions();
  factor = 0.5;
  EXPECT_EQ(side(0.0001), 32);
  factor = 2.0;
  EXPECT_EQ(side(0.0001), 128);
  EXPECT_EQ(side(1.0), 128) << "a quarter of the image";
  camera.height = 500;
  EXPECT_EQ(side(1.0), 64);
}

}  // namespace
}  // namespace boresight
