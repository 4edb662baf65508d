// SPDX-License-Identifier: Apache-2.0
#include "core/accept/region_evidence.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/localizer/scene.h"

namespace boresight {
namespace {

/// A plate in front of the camera, and images that are painted by its mask.
class RegionEvidenceTest : public testing::Test {
 protected:
  RegionEvidenceTest() : block_(1 << 18) {
    Arena arena(block_);
    EXPECT_EQ(meter_.create(arena), Status::kOk);
    solid_.addBox(0.0, 0.0, 0.06, 0.04, 0.3, -0.005, 0.005, 0.5);
    pose_ = test::truthPose();
    pose_.rotation = Eigen::Quaterniond::Identity();
  }
  /// Gray values of the plate at the pose and of its surroundings, each with its noise.
  void paint(int inside, int outside, int noise) {
    const test::Rendering render = test::renderEdges(solid_, camera_, pose_);
    Random random(4);
    gray_.resize(static_cast<std::size_t>(camera_.width * camera_.height));
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x) {
        const int level = render.edges.mask.get(x, y) ? inside : outside;
        gray_[static_cast<std::size_t>(y * camera_.width + x)] = static_cast<std::uint8_t>(
            level + static_cast<int>(random.below(static_cast<std::uint32_t>(2 * noise + 1))) -
            noise);
      }
  }
  RegionEvidence measure(double shift_m, const BitImage* ignore = nullptr) {
    Pose moved = pose_;
    moved.translation_m.x() += shift_m;
    const test::Rendering render = test::renderEdges(solid_, camera_, moved);
    return meter_.measure(render.edges, 0,
                          {gray_.data(), camera_.width, camera_.height, camera_.width}, ignore);
  }

  std::vector<std::byte> block_;
  RegionEvidenceMeter meter_;
  test::Solid solid_;
  Camera camera_ = test::pinholeCamera();
  Pose pose_;
  std::vector<std::uint8_t> gray_;
};

TEST_F(RegionEvidenceTest, SidesThatDiffer_SupportTheOutline) {
  paint(170, 60, 20);
  const RegionEvidence right = measure(0.0);
  EXPECT_GT(right.lines, 200);
  EXPECT_GT(right.nats, 1.0);
  EXPECT_GT(right.separatedShare(), 0.95);
  const RegionEvidence wrong = measure(0.012);
  EXPECT_LT(wrong.nats, 0.6 * right.nats);
}

/// Texture on both sides, as dense as the other, tells nothing.
TEST_F(RegionEvidenceTest, SidesThatAreAlike_GiveNoEvidence) {
  paint(128, 128, 60);
  EXPECT_NEAR(measure(0.0).nats, 0.0, 0.1);
}

TEST_F(RegionEvidenceTest, InvertedContrast_IsTheSameEvidence) {
  paint(170, 60, 0);
  const double bright = measure(0.0).nats;
  paint(60, 170, 0);
  EXPECT_NEAR(measure(0.0).nats, bright, 0.05);
}

TEST_F(RegionEvidenceTest, IgnoredPixels_AreLeftOut) {
  paint(170, 60, 20);
  test::Mask mask(camera_.width, camera_.height);
  mask.fill(0, 0, camera_.width / 2, camera_.height);
  const RegionEvidence half = measure(0.0, &mask.bits);
  const std::int32_t all = measure(0.0).lines;
  EXPECT_NEAR(half.lines, 0.5 * all, 0.15 * all);
  mask.fill(0, 0, camera_.width, camera_.height);
  EXPECT_EQ(measure(0.0, &mask.bits).lines, 0);
  EXPECT_EQ(measure(0.0, &mask.bits).nats, 0.0);
}

}  // namespace
}  // namespace boresight
