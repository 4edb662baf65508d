// SPDX-License-Identifier: Apache-2.0
#include "core/accept/edge_width.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// The mean over `width` pixels along x, or over a square of that side.
Picture blurred(const Picture& picture, int width, bool square) {
  Picture result = picture;
  const int rows = square ? width : 1;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      int sum = 0;
      for (int v = 0; v < rows; ++v)
        for (int u = 0; u < width; ++u)
          sum += picture.view().at(std::clamp(x + u - width / 2, 0, picture.width - 1),
                                   std::clamp(y + v - rows / 2, 0, picture.height - 1));
      result.gray[static_cast<std::size_t>(y * picture.width + x)] =
          static_cast<std::uint8_t>(sum / (width * rows));
    }
  return result;
}

EdgeWidth widthOf(const Case& scene, const Picture& picture, const BitImage* ignore = nullptr) {
  const Rendering rendering = renderEdges(scene.solid, scene.camera, scene.truth);
  return measureEdgeWidth(rendering.edges, 0, picture.view(), ignore);
}

TEST(EdgeWidth, SharpPicture_HasNarrowEdgesInEveryDirection) {
  const Case scene = stationCase(1);
  const EdgeWidth width = widthOf(scene, *scene.picture);
  ASSERT_GE(width.widestDirection(), 0);
  EXPECT_LT(width.widest_px(), 4.0);
  EXPECT_TRUE(width.isSharp());
}

TEST(EdgeWidth, Defocus_WidensEdgesInEveryDirection) {
  const Case scene = stationCase(1);
  const EdgeWidth width = widthOf(scene, blurred(*scene.picture, 9, true));
  for (std::size_t i = 0; i < width.width_px.size(); ++i)
    EXPECT_TRUE(width.places[i] < 30 || width.width_px[i] > 5.0) << i << " " << width.width_px[i];
  EXPECT_LT(width.widest_px(), 16.0);
}

TEST(EdgeWidth, Motion_WidensTheEdgesAcrossItAlone) {
  const Case scene = stationCase(1);
  const EdgeWidth width = widthOf(scene, blurred(*scene.picture, 14, false));
  EXPECT_GT(width.widest_px(), EdgeWidth::kWidest_px);
  EXPECT_FALSE(width.isSharp());
  const int widest = width.widestDirection();
  EXPECT_TRUE(widest == 7 || widest == 0 || widest == 1) << "normals along x";
  EXPECT_TRUE(width.places[4] < 30 || width.width_px[4] < 4.0) << width.width_px[4];
}

TEST(EdgeWidth, TooFewEdges_AreNotBlurred) {
  const Case scene = stationCase(1);
  const Picture flat = flatPicture(512, 512, 90);
  EXPECT_EQ(widthOf(scene, flat).widest_px(), 0.0);
  Mask mask(512, 512);
  mask.fill(0, 0, 512, 512);
  const EdgeWidth ignored = widthOf(scene, blurred(*scene.picture, 14, false), &mask.bits);
  EXPECT_EQ(ignored.widestDirection(), -1);
  EXPECT_TRUE(ignored.isSharp());
}

}  // namespace
}  // namespace boresight::test
