// SPDX-License-Identifier: Apache-2.0
#include "core/render/edge_pixel.h"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

void expectSame(const EdgePixel& a, const EdgePixel& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(EdgePixel)), 0);
}

EdgePixel randomPixel(Random& random) {
  const auto below = [&](std::uint32_t bound) {
    return static_cast<std::int32_t>(random.below(bound));
  };
  EdgePixel pixel;
  pixel.x = static_cast<std::int16_t>(below(32767));
  pixel.y = static_cast<std::int16_t>(below(32767));
  pixel.depth_m = static_cast<float>(random.uniform(0.01, 100.0));
  pixel.face = below(static_cast<std::uint32_t>(PackedEdgePixel::kMostFaces));
  pixel.normal_x = static_cast<std::int8_t>(below(255) - 127);
  pixel.normal_y = static_cast<std::int8_t>(below(255) - 127);
  pixel.offset = static_cast<std::int8_t>(below(255) - 127);
  pixel.kind = static_cast<std::uint8_t>(below(8));
  return pixel;
}

TEST(PackedEdgePixel, KeepsEverythingButTheRow) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    EdgePixel pixel = randomPixel(random);
    if (i == 0) pixel.face = static_cast<std::int32_t>(PackedEdgePixel::kMostFaces) - 1;
    const PackedEdgePixel packed(pixel);
    expectSame(packed.unpacked(pixel.y), pixel);
    EXPECT_EQ(packed.x(), pixel.x);
  }
}

TEST(EdgePixelRange, VisitsPixelsWithTheirRows) {
  Random random(4);
  constexpr int kHeight = 40;
  for (int i = 0; i < 200; ++i) {
    std::vector<EdgePixel> pixels;
    std::vector<std::int32_t> row_begin(1, 0);
    for (int y = 0; y < kHeight; ++y) {
      const std::uint32_t of_row = random.below(2) == 0 ? 0 : random.below(5);
      for (std::uint32_t k = 0; k < of_row; ++k) {
        pixels.push_back(randomPixel(random));
        pixels.back().y = static_cast<std::int16_t>(y);
      }
      row_begin.push_back(static_cast<std::int32_t>(pixels.size()));
    }
    row_begin.resize(kHeight + 30, -1);  // of a higher image
    std::vector<PackedEdgePixel> packed(pixels.begin(), pixels.end());
    EdgeRender render;
    render.edges.height = kHeight;
    render.pixels = packed;
    render.row_begin = row_begin;
    render.pixel_count = static_cast<std::int32_t>(pixels.size());
    for (std::size_t at = 0; at < pixels.size(); ++at)
      expectSame(render.pixel(static_cast<std::int32_t>(at)), pixels[at]);
    for (const std::int32_t stride : {1, 2, 7}) {
      std::size_t at = 0;
      for (const EdgePixel& pixel : render.eachPixel(stride)) {
        ASSERT_LT(at, pixels.size());
        expectSame(pixel, pixels[at]);
        at += static_cast<std::size_t>(stride);
      }
      EXPECT_GE(at, pixels.size());
    }
  }
}

}  // namespace
}  // namespace boresight::testing
