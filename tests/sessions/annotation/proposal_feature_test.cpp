// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/proposal_feature.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace boresight::sessions {
namespace {

constexpr int kSide = 100;

/// A picture of what is bright.
std::vector<std::uint8_t> picture(const std::function<bool(int, int)>& bright) {
  std::vector<std::uint8_t> pixels(kSide * kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      pixels[static_cast<std::size_t>(y * kSide + x)] = bright(x, y) ? 200 : 40;
  return pixels;
}

std::optional<Eigen::Vector2d> featureIn(const std::vector<std::uint8_t>& pixels,
                                         const Eigen::Vector2d& predicted, double sigma_px) {
  Proposal proposal;
  proposal.pixel = predicted;
  proposal.sigma_px = sigma_px;
  return featureOf(proposal, {pixels.data(), kSide, kSide, kSide});
}

TEST(ProposalFeature, IsTheCornerNearThePrediction) {
  const auto pixels = picture([](int x, int y) { return x >= 50 && y >= 40; });
  const Eigen::Vector2d corner(49.5, 39.5);
  const auto found = featureIn(pixels, {51.0, 41.0}, 1.0);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - corner).norm(), 0.3);
  EXPECT_FALSE(featureIn(pixels, {70.0, 70.0}, 1.0)) << "too far from any corner";
  EXPECT_FALSE(featureIn(pixels, {60.0, 50.0}, 100.0)) << "the search has an end";
}

TEST(ProposalFeature, NothingButACornerOrAnEllipseIsAMeasurement) {
  const auto flat = picture([](int, int) { return true; });
  EXPECT_FALSE(featureIn(flat, {50.0, 50.0}, 2.0));
  const auto edge = picture([](int x, int) { return x >= 50; });
  EXPECT_FALSE(featureIn(edge, {50.0, 50.0}, 2.0)) << "along an edge it may be anywhere";
  const auto disc =
      picture([](int x, int y) { return (x - 50) * (x - 50) + (y - 48) * (y - 48) < 64; });
  const auto centre = featureIn(disc, {51.0, 47.5}, 1.5);
  ASSERT_TRUE(centre);
  EXPECT_LT((*centre - Eigen::Vector2d(50.0, 48.0)).norm(), 0.3);
}

}  // namespace
}  // namespace boresight::sessions
