// SPDX-License-Identifier: Apache-2.0
#include "core/search/self_slides.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace boresight {
namespace {

constexpr int kSize_px = 120;

/// A render of vertical edges in the rows 40 ... 79.
class SelfSlidesTest : public testing::Test {
 protected:
  SelfSlidesTest() : arena_(block_), directions_(kSize_px * kSize_px, DirectedEdges::kNone) {
    edges_.width = edges_.height = kSize_px;
    edges_.direction = directions_;
    render_.edges.width = render_.edges.height = kSize_px;
    slides_.create(arena_);
  }

  void addEdge(int x) {
    for (int y = 40; y < 80; ++y) {
      EdgePixel pixel;
      pixel.x = static_cast<std::int16_t>(x);
      pixel.y = static_cast<std::int16_t>(y);
      pixel.normal_x = 127;
      pixel.kind = kEdgeBorder;
      pixels_.push_back(pixel);
      directions_[static_cast<std::size_t>(y * kSize_px + x)] =
          static_cast<std::uint8_t>(edgeDirectionOf(127, 0));
    }
  }

  /// Fills the render in raster order.
  void complete() {
    std::sort(pixels_.begin(), pixels_.end(), [](const EdgePixel& a, const EdgePixel& b) {
      return a.y != b.y ? a.y < b.y : a.x < b.x;
    });
    packed_ = std::vector<PackedEdgePixel>(pixels_.begin(), pixels_.end());
    std::ranges::fill(row_begin_, 0);
    for (const EdgePixel& pixel : pixels_) {
      for (int y = pixel.y; y < kSize_px; ++y) ++row_begin_[static_cast<std::size_t>(y) + 1];
    }
    render_.pixels = packed_;
    render_.row_begin = row_begin_;
    render_.pixel_count = static_cast<std::int32_t>(pixels_.size());
  }

  std::vector<Eigen::Vector2i> slides() {
    complete();
    slides_.begin(render_, edges_);
    while (!slides_.step()) {
    }
    return {slides_.slides_px().begin(), slides_.slides_px().end()};
  }

  std::vector<std::byte> block_ = std::vector<std::byte>(1 << 20);
  Arena arena_;
  std::vector<std::uint8_t> directions_;
  std::vector<EdgePixel> pixels_;
  std::vector<PackedEdgePixel> packed_;
  std::vector<std::int32_t> row_begin_ = std::vector<std::int32_t>(kSize_px + 1);
  EdgeRender render_;
  DirectedEdges edges_;
  SelfSlides slides_;
};

TEST_F(SelfSlidesTest, EvenlySpacedEdges_AreAlikeOneSpacingOn) {
  for (const int x : {30, 45, 60, 75, 90}) addEdge(x);
  const std::vector<Eigen::Vector2i> found = slides();
  for (const int x : {-15, 15})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [x](const Eigen::Vector2i& slide) {
      return std::abs(slide.x() - x) <= 1 && std::abs(slide.y()) <= 4;
    })) << x;
}

TEST_F(SelfSlidesTest, EdgesWithoutARepeatedSpacing_HaveNoSlideAcross) {
  for (const int x : {30, 41, 63, 90}) addEdge(x);
  for (const Eigen::Vector2i& slide : slides()) EXPECT_LT(std::abs(slide.x()), 4);
}

TEST_F(SelfSlidesTest, Slides_AreApartFromNoneAndFromEachOther) {
  for (const int x : {30, 45, 60, 75, 90}) addEdge(x);
  std::vector<Eigen::Vector2i> all = slides();
  ASSERT_FALSE(all.empty());
  all.push_back(Eigen::Vector2i::Zero());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((all[i] - all[j]).squaredNorm(),
                SelfSlides::kShortest_px * SelfSlides::kShortest_px);
}

}  // namespace
}  // namespace boresight
