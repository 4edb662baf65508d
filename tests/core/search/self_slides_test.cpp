// SPDX-License-Identifier: Apache-2.0
#include "core/search/self_slides.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace boresight {
namespace {

constexpr int kSize_px = 120;

/// Slides of a render of vertical edges in the rows 40 ... 79.
std::vector<Eigen::Vector2i> slidesOf(const std::vector<int>& edges_x) {
  std::vector<std::uint8_t> directions(kSize_px * kSize_px, DirectedEdges::kNone);
  std::vector<PackedEdgePixel> pixels;
  std::vector<std::int32_t> row_begin = {0};
  for (int y = 0; y < kSize_px; ++y) {
    for (const int x : edges_x) {
      if (y < 40 || y >= 80) continue;
      EdgePixel pixel;
      pixel.x = static_cast<std::int16_t>(x);
      pixel.y = static_cast<std::int16_t>(y);
      pixel.normal_x = 127;
      pixel.kind = kEdgeBorder;
      pixels.emplace_back(pixel);
      directions[static_cast<std::size_t>(y * kSize_px + x)] =
          static_cast<std::uint8_t>(edgeDirectionOf(127, 0));
    }
    row_begin.push_back(static_cast<std::int32_t>(pixels.size()));
  }
  EdgeRender render;
  render.edges.width = render.edges.height = kSize_px;
  render.pixels = pixels;
  render.row_begin = row_begin;
  render.pixel_count = static_cast<std::int32_t>(pixels.size());
  const DirectedEdges edges{directions, kSize_px, kSize_px};
  std::vector<std::byte> block(1 << 20);
  Arena arena(block);
  SelfSlides slides;
  slides.create(arena);
  slides.begin(render, edges);
  while (!slides.step()) {
  }
  return {slides.slides_px().begin(), slides.slides_px().end()};
}

TEST(SelfSlides, EvenlySpacedEdges_AreAlikeOneSpacingOnInSlidesThatAreApart) {
  std::vector<Eigen::Vector2i> found = slidesOf({30, 45, 60, 75, 90});
  for (const int x : {-15, 15})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [x](const Eigen::Vector2i& slide) {
      return std::abs(slide.x() - x) <= 1 && std::abs(slide.y()) <= 4;
    })) << x;
  found.push_back(Eigen::Vector2i::Zero());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((found[i] - found[j]).squaredNorm(),
                SelfSlides::kShortest_px * SelfSlides::kShortest_px);
}

TEST(SelfSlides, EdgesWithoutARepeatedSpacing_HaveNoSlideAcross) {
  for (const Eigen::Vector2i& slide : slidesOf({30, 41, 63, 90})) EXPECT_LT(std::abs(slide.x()), 4);
}

}  // namespace
}  // namespace boresight
