// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/image_snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::randomFor;

using Gray = std::function<double(const Eigen::Vector2d&)>;

/// A square picture of these grays, each pixel their mean over `samples` x `samples` places.
class Picture {
 public:
  explicit Picture(const Gray& gray_at, int side = 100, int samples = 8) : side_(side) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        double sum = 0.0;
        for (int v = 0; v < samples; ++v)
          for (int u = 0; u < samples; ++u)
            sum += gray_at({x - 0.5 + (u + 0.5) / samples, y - 0.5 + (v + 0.5) / samples});
        grays_.push_back(sum / (samples * samples));
      }
    for (const double gray : grays_) pixels_.push_back(static_cast<std::uint8_t>(gray + 0.5));
  }

  /// As a sensor sees it: blurred by the optics (two boxes of a pixel), with noise.
  Picture sensed(double noise, Random& random) && {
    pixels_.clear();
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) {
        double sum = noise * random.normal();
        for (int v = -1; v <= 1; ++v)
          for (int u = -1; u <= 1; ++u)
            sum += (2 - std::abs(u)) * (2 - std::abs(v)) / 16.0 * grayAt(x + u, y + v);
        pixels_.push_back(static_cast<std::uint8_t>(std::clamp(sum, 0.0, 255.0) + 0.5));
      }
    return std::move(*this);
  }

  ImageView view() const { return {pixels_.data(), side_, side_, side_}; }

 private:
  double grayAt(int x, int y) const {
    return grays_[static_cast<std::size_t>(std::clamp(y, 0, side_ - 1) * side_ +
                                           std::clamp(x, 0, side_ - 1))];
  }

  int side_;
  std::vector<double> grays_;
  std::vector<std::uint8_t> pixels_;
};

/// What a sensor sees of a scene that is bright where `inside` says so.
Picture sensedScene(int side, const std::function<bool(const Eigen::Vector2d&)>& inside,
                    double noise, Random& random) {
  return Picture([&](const Eigen::Vector2d& p) { return inside(p) ? 180.0 : 60.0; }, side, 16)
      .sensed(noise, random);
}

TEST(SnapToEdge, FindsAStraightEdgeToATwentiethOfAPixel) {
  Random random = randomFor("SnapToEdge");
  double worst_px = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const double angle = random.uniform(-kPi, kPi);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d through = Eigen::Vector2d(30, 30) + 2.0 * Eigen::Vector2d::Random();
    const Picture scene = sensedScene(
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
    const Picture scene = sensedScene(
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
    const Picture scene = sensedScene(
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
    const Picture scene = sensedScene(
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
  const Picture flat = sensedScene(
      61, [](const Eigen::Vector2d&) { return false; }, 1.0, random);
  const Picture edge = sensedScene(
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

template <class Snap>
auto kindsOf(const std::vector<Snap>& snaps) {
  std::vector<decltype(Snap::kind)> kinds;
  for (const Snap& snap : snaps) kinds.push_back(snap.kind);
  return kinds;
}

TEST(ImageSnaps, ACornerComesBeforeItsNearerEdges) {
  const Eigen::Vector2d corner(50.2, 40.7);
  const Picture picture([&](const Eigen::Vector2d& p) {
    return p.x() > corner.x() && p.y() > corner.y() ? 200.0 : 50.0;
  });
  const auto snaps = imageSnaps(picture.view(), corner + Eigen::Vector2d(0.2, 2.0), 8.0, 24.0);
  ASSERT_THAT(kindsOf(snaps), ElementsAre(ImageSnapKind::kCorner, ImageSnapKind::kEdge));
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
  const auto snap = [](MeshSnapKind kind, double distance_px) {
    MeshSnap mesh_snap;
    mesh_snap.kind = kind;
    mesh_snap.distance_px = distance_px;
    return mesh_snap;
  };
  const std::vector<MeshSnap> snaps = {snap(MeshSnapKind::kEdge, 0.5),
                                       snap(MeshSnapKind::kCircle, 7.0),
                                       snap(MeshSnapKind::kVertex, 3.0)};
  EXPECT_THAT(kindsOf(likeliestFirst(snaps, 8.0)),
              ElementsAre(MeshSnapKind::kVertex, MeshSnapKind::kEdge, MeshSnapKind::kCircle));
}

}  // namespace
}  // namespace boresight::sessions
