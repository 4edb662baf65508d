// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/image_snap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::randomFor;

/// What a sensor sees of a scene that is bright where `inside` says so: areas by 16 x 16 samples
/// a pixel, blurred by the optics (two boxes of a pixel), with noise.
class Scene {
 public:
  Scene(int size, const std::function<bool(const Eigen::Vector2d&)>& inside, double noise,
        Random& random)
      : size_(size) {
    std::vector<double> area(static_cast<std::size_t>(size * size));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) area[index(x, y)] = coverage(x, y, inside);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        double sum = 0.0;
        for (int v = -1; v <= 1; ++v)
          for (int u = -1; u <= 1; ++u)
            sum += (2 - std::abs(u)) * (2 - std::abs(v)) *
                   area[index(std::clamp(x + u, 0, size - 1), std::clamp(y + v, 0, size - 1))];
        const double value = 60.0 + 120.0 * sum / 16.0 + noise * random.normal();
        pixels_.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5));
      }
    }
  }

  ImageView view() const { return {pixels_.data(), size_, size_, size_}; }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size_ + x); }

  static double coverage(int x, int y, const std::function<bool(const Eigen::Vector2d&)>& inside) {
    int count = 0;
    for (int v = 0; v < 16; ++v)
      for (int u = 0; u < 16; ++u)
        count += inside({x - 0.5 + (u + 0.5) / 16.0, y - 0.5 + (v + 0.5) / 16.0}) ? 1 : 0;
    return count / 256.0;
  }

  int size_;
  std::vector<std::uint8_t> pixels_;
};

TEST(SnapToEdge, FindsAStraightEdgeToATwentiethOfAPixel) {
  Random random = randomFor("SnapToEdge");
  double worst_px = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const double angle = random.uniform(-kPi, kPi);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d through = Eigen::Vector2d(30, 30) + 2.0 * Eigen::Vector2d::Random();
    const Scene scene(
        61, [&](const Eigen::Vector2d& p) { return (p - through).dot(normal) > 0.0; }, 0.5, random);
    const Eigen::Vector2d near = through + random.uniform(-4.0, 4.0) * normal;
    const auto snap = snapToEdge(scene.view(), near, 6.0);
    ASSERT_TRUE(snap) << trial;
    worst_px = std::max(worst_px, std::abs((snap->pixel - through).dot(normal)));
    EXPECT_GT(snap->normal.dot(normal), 0.98);
    // The nearest place of the edge, not one along it.
    EXPECT_LT((snap->pixel - near).norm(), 4.7);
  }
  EXPECT_LT(worst_px, 0.08);
}

TEST(SnapToCorner, FindsARightAngle) {
  Random random = randomFor("SnapToCorner");
  for (int trial = 0; trial < 40; ++trial) {
    const double angle = random.uniform(-kPi, kPi);
    const Eigen::Vector2d a(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d b(-a.y(), a.x());
    const Eigen::Vector2d corner(30.0 + random.uniform(-1, 1), 30.0 + random.uniform(-1, 1));
    const Scene scene(
        61,
        [&](const Eigen::Vector2d& p) {
          return (p - corner).dot(a) > 0.0 && (p - corner).dot(b) > 0.0;
        },
        0.5, random);
    const Eigen::Vector2d near =
        corner + Eigen::Vector2d(random.uniform(-3, 3), random.uniform(-3, 3));
    const auto snap = snapToCorner(scene.view(), near, 6.0);
    ASSERT_TRUE(snap) << trial;
    // Blur rounds a corner: it seems to lie a little inside.
    EXPECT_LT((*snap - corner).norm(), 0.35) << trial;
  }
}

/// The rim of a hole bends, but has no corner; noise is no corner either.
TEST(SnapToCorner, ARimIsNone) {
  Random random = randomFor("SnapToCorner.Rim");
  int found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double radius = random.uniform(8.0, 16.0);
    const Scene scene(
        61, [&](const Eigen::Vector2d& p) { return (p - Eigen::Vector2d(30, 30)).norm() < radius; },
        2.0, random);
    const double angle = random.uniform(-kPi, kPi);
    const Eigen::Vector2d near =
        Eigen::Vector2d(30, 30) + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (snapToCorner(scene.view(), near, 5.0)) ++found;
  }
  EXPECT_LE(found, 3);
}

TEST(SnapToEllipse, FindsTheCentreToATenthOfAPixel) {
  Random random = randomFor("SnapToEllipse");
  for (int trial = 0; trial < 40; ++trial) {
    const double angle = random.uniform(-kPi, kPi);
    const Eigen::Vector2d half(random.uniform(8.0, 16.0), random.uniform(6.0, 8.0));
    const Eigen::Vector2d centre(40.0 + random.uniform(-1, 1), 40.0 + random.uniform(-1, 1));
    const bool bright = trial % 2 == 0;
    const Scene scene(
        81,
        [&](const Eigen::Vector2d& p) {
          const Eigen::Vector2d q = p - centre;
          const Eigen::Vector2d in_axes(std::cos(angle) * q.x() + std::sin(angle) * q.y(),
                                        -std::sin(angle) * q.x() + std::cos(angle) * q.y());
          return (in_axes.cwiseQuotient(half).squaredNorm() < 1.0) == bright;
        },
        1.0, random);
    const Eigen::Vector2d near =
        centre + Eigen::Vector2d(random.uniform(-2, 2), random.uniform(-2, 2));
    const auto snap = snapToEllipse(scene.view(), near, 30.0);
    ASSERT_TRUE(snap) << trial;
    EXPECT_LT((snap->centre - centre).norm(), 0.1) << trial;
    // Blur draws a narrow bend inwards.
    EXPECT_NEAR(snap->half_axes_px.x(), half.x(), 0.5);
    EXPECT_NEAR(snap->half_axes_px.y(), half.y(), 0.3);
    EXPECT_GT(snap->support, 0.9);
    if (half.x() > 1.3 * half.y()) {
      EXPECT_LT(std::abs(std::sin(snap->angle_rad - angle)), 0.05);
    }
  }
}

TEST(Snapping, FindsNothingWhereNothingIs) {
  Random random = randomFor("Snapping.Nothing");
  const Scene flat(
      61, [](const Eigen::Vector2d&) { return false; }, 1.0, random);
  const Scene edge(
      61, [](const Eigen::Vector2d& p) { return p.x() > 30.2; }, 0.0, random);
  for (const Eigen::Vector2d& near :
       {Eigen::Vector2d(30, 30), Eigen::Vector2d(0, 0), Eigen::Vector2d(60, 59.6)}) {
    EXPECT_FALSE(snapToEdge(flat.view(), near, 8.0));
    EXPECT_FALSE(snapToCorner(flat.view(), near, 8.0));
    EXPECT_FALSE(snapToEllipse(flat.view(), near, 20.0));
  }
  EXPECT_FALSE(snapToCorner(edge.view(), {30, 30}, 8.0));
  EXPECT_FALSE(snapToEllipse(edge.view(), {33, 30}, 20.0));
  EXPECT_FALSE(snapToEdge(edge.view(), {10, 30}, 8.0));
  EXPECT_FALSE(snapToEdge(edge.view(), {-500, 3000}, 8.0));
}

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
