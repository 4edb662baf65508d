// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/snap_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace boresight::sessions {
namespace {

/// Bright where `inside` says so, each pixel by its covered area.
class Picture {
 public:
  explicit Picture(const std::function<double(const Eigen::Vector2d&)>& gray_at) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        double sum = 0.0;
        for (int v = 0; v < 8; ++v)
          for (int u = 0; u < 8; ++u)
            sum += gray_at({x - 0.5 + (u + 0.5) / 8.0, y - 0.5 + (v + 0.5) / 8.0}) / 64.0;
        pixels_.push_back(static_cast<std::uint8_t>(std::lround(sum)));
      }
  }
  ImageView view() const { return {pixels_.data(), kSide, kSide, kSide}; }

 private:
  static constexpr int kSide = 100;
  std::vector<std::uint8_t> pixels_;
};

TEST(ImageSnaps, ACornerComesBeforeItsNearerEdges) {
  const Eigen::Vector2d corner(50.2, 40.7);
  const Picture picture([&](const Eigen::Vector2d& p) {
    return p.x() > corner.x() && p.y() > corner.y() ? 200.0 : 50.0;
  });
  const auto snaps = imageSnaps(picture.view(), corner + Eigen::Vector2d(0.2, 2.0), 8.0, 24.0);
  ASSERT_EQ(snaps.size(), 2u);
  EXPECT_EQ(snaps[0].kind, ImageSnapKind::kCorner);
  EXPECT_EQ(snaps[1].kind, ImageSnapKind::kEdge);
  EXPECT_GT(snaps[0].distance_px, snaps[1].distance_px);
  // Far along the edge it is the edge that is meant.
  const auto along = imageSnaps(picture.view(), corner + Eigen::Vector2d(0.2, 6.5), 8.0, 24.0);
  ASSERT_FALSE(along.empty());
  EXPECT_EQ(along[0].kind, ImageSnapKind::kEdge);
}

TEST(ImageSnaps, TheCentreOfAScrewComesBeforeTheCornersOfItsSlot) {
  const Eigen::Vector2d centre(50.3, 49.6);
  const Picture picture([&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d off = p - centre;
    if (off.norm() > 14.0) return 40.0;
    return std::abs(off.x()) < 5.0 && std::abs(off.y()) < 1.5 ? 130.0 : 200.0;
  });
  const auto snaps = imageSnaps(picture.view(), centre + Eigen::Vector2d(3.0, 1.0), 8.0, 24.0);
  ASSERT_FALSE(snaps.empty());
  EXPECT_EQ(snaps[0].kind, ImageSnapKind::kEllipse);
  EXPECT_LT((snaps[0].pixel - centre).norm(), 0.2);
}

TEST(ImageSnaps, ASpeckInTheShadowDoesNotCompeteWithTheEdgeOfTheShadow) {
  const Picture picture([&](const Eigen::Vector2d& p) {
    if (p.x() > 50.0) return 220.0;
    return std::abs(p.x() - 47.0) < 1.5 && std::abs(p.y() - 50.0) < 1.5 ? 60.0 : 20.0;
  });
  const auto snaps = imageSnaps(picture.view(), {49.0, 50.0}, 8.0, 24.0);
  ASSERT_FALSE(snaps.empty());
  EXPECT_EQ(snaps[0].kind, ImageSnapKind::kEdge);
  EXPECT_NEAR(snaps[0].pixel.x(), 50.0, 0.2);
}

TEST(LikeliestFirst, AVertexComesBeforeTheEdgeThatEndsInIt) {
  MeshSnap vertex, edge, circle;
  vertex.kind = MeshSnapKind::kVertex;
  vertex.distance_px = 3.0;
  edge.kind = MeshSnapKind::kEdge;
  edge.distance_px = 0.5;
  circle.kind = MeshSnapKind::kCircle;
  circle.distance_px = 7.0;
  const auto snaps = likeliestFirst({edge, circle, vertex}, 8.0);
  ASSERT_EQ(snaps.size(), 3u);
  EXPECT_EQ(snaps[0].kind, MeshSnapKind::kVertex);
  EXPECT_EQ(snaps[1].kind, MeshSnapKind::kEdge);
  EXPECT_EQ(snaps[2].kind, MeshSnapKind::kCircle);
}

}  // namespace
}  // namespace boresight::sessions
