// SPDX-License-Identifier: Apache-2.0
#include "core/accept/region_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/localizer/scene.h"

namespace boresight {
namespace {

/// Gray values of a plate and of its surroundings, each with its noise.
test::Picture paintedBy(const EdgeRender& plate, int inside, int outside, int noise) {
  Random random(4);
  test::Picture picture{plate.mask.width, plate.mask.height, {}};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const int level = plate.mask.get(x, y) ? inside : outside;
      const auto off = static_cast<int>(random.below(static_cast<std::uint32_t>(2 * noise + 1)));
      picture.gray.push_back(static_cast<std::uint8_t>(level + off - noise));
    }
  return picture;
}

/// The evidence by its definition, in the order of the formulas of RegionEvidence.
class PlainRegions {
 public:
  PlainRegions(const EdgeRender& render, int level, const ImageView& image, const BitImage* ignore)
      : image_(image), ignore_(ignore) {
    std::vector<EdgePixel> border;
    for (const EdgePixel& pixel : render.eachPixel())
      if (isBorder(pixel)) border.push_back(pixel);
    const auto [left, right] = std::ranges::minmax(border, {}, &EdgePixel::x);
    const auto [top, bottom] = std::ranges::minmax(border, {}, &EdgePixel::y);
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const EdgePixel& pixel : border) centre += Eigen::Vector2d(pixel.x, pixel.y);
    centre /= static_cast<double>(border.size());
    const double scale = 1 << level;
    const int longer = std::max(right.x - left.x, bottom.y - top.y) + 1;
    const double reach_px = scale * std::clamp(0.08 * longer, 6.0, 40.0);
    const std::size_t stride = (border.size() + 2499) / 2500;
    for (std::size_t i = 0; i < border.size(); i += stride) {
      const EdgePixel& pixel = border[i];
      const Eigen::Vector2d normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y) / 127.0;
      const Eigen::Vector2d on_line =
          Eigen::Vector2d(pixel.x, pixel.y) + 0.01 * pixel.offset * normal;
      const Eigen::Vector2d place =
          scale * (on_line + Eigen::Vector2d(0.5, 0.5)) - Eigen::Vector2d(0.5, 0.5);
      Line line;
      bool complete = true;
      for (int k = 0; k < 16 && complete; ++k)
        complete = sample(place + (k - 7.5) * reach_px / 8.0 * normal, line.bin[k]);
      // Places straight above, below, left or right belong to the sector of positive x and y.
      const double turns = std::atan2(pixel.y - centre.y() + 1e-9, pixel.x - centre.x() + 1e-9) /
                           (30.0 * kDegree_rad);
      line.sector = (static_cast<int>(std::floor(turns)) + 12) % 12;
      if (complete) lines_.push_back(line);
    }
  }

  RegionEvidence evidence() const {
    RegionEvidence evidence;
    if (lines_.size() < 20) return evidence;
    double log_odds[12][32];
    for (int i = 0; i < 12 * 32; ++i) log_odds[i / 32][i % 32] = logOdds(i / 32, i % 32);
    for (const Line& line : lines_) {
      std::array<double, 17> likelihood{};
      for (std::size_t k = 0; k < 16; ++k)
        likelihood[k + 1] = likelihood[k] + log_odds[line.sector][line.bin[k]];
      double mean = 0.0;
      for (const double value : likelihood) mean += std::exp(value - likelihood[8]) / 17.0;
      evidence.nats -= std::log(mean) / static_cast<double>(lines_.size());
      ++evidence.lines;
      if (mean < 1.0) ++evidence.separated;
    }
    evidence.nats = std::clamp(evidence.nats, -0.8, 1.2);
    return evidence;
  }

 private:
  struct Line {
    int bin[16];
    int sector;
  };
  bool sample(const Eigen::Vector2d& at, int& bin) const {
    if (at.minCoeff() < 0.0 || at.x() >= image_.width - 1 || at.y() >= image_.height - 1)
      return false;
    const int x = static_cast<int>(at.x());
    const int y = static_cast<int>(at.y());
    if (ignore_ != nullptr && ignore_->get(x, y)) return false;
    const double right = std::floor(16.0 * (at.x() - x)) / 16.0;
    const double down = std::floor(16.0 * (at.y() - y)) / 16.0;
    const double above = (1.0 - right) * image_.at(x, y) + right * image_.at(x + 1, y);
    const double below = (1.0 - right) * image_.at(x, y + 1) + right * image_.at(x + 1, y + 1);
    bin = static_cast<int>(((1.0 - down) * above + down * below) / 8.0);
    return true;
  }
  /// Of the inside at a gray value, from the lines of a sector and its neighbours; samples next to
  /// the outline belong to neither side.
  double logOdds(int sector, int bin) const {
    double share[2] = {};
    for (const int side : {0, 1}) {
      double weighted = 0.0;
      double all = 0.0;
      for (const Line& line : lines_) {
        const int apart = (line.sector - sector + 12) % 12;
        if (apart > 1 && apart < 11) continue;
        for (int k = 0; k < 7; ++k) {
          const int value = line.bin[side == 0 ? k : 15 - k];
          weighted += value == bin ? 2.0 : std::abs(value - bin) == 1 ? 1.0 : 0.0;
          all += 2.0 + (value > 0 ? 1.0 : 0.0) + (value < 31 ? 1.0 : 0.0);
        }
      }
      share[side] = (all > 0.0 ? weighted / all : 0.0) + 0.001;
    }
    const double inside = 0.02 + 0.96 * share[0] / (share[0] + share[1]);
    return std::log(inside / (1.0 - inside));
  }

  ImageView image_;
  const BitImage* ignore_;
  std::vector<Line> lines_;
};

/// A plate, one so small and one so large that the length of the lines is limited; masks that leave
/// all lines, half of them, and about the least number.
TEST(RegionEvidence, PlatesAndMasks_MatchTheDefinition) {
  std::vector<std::byte> block(1 << 18);
  Arena arena(block);
  RegionEvidenceMeter meter;
  ASSERT_EQ(meter.create(arena), Status::kOk);
  const Camera camera = test::pinholeCamera();
  const Pose pose{Eigen::Quaterniond::Identity(), test::truthPose().translation_m};
  Pose moved = pose;
  moved.translation_m.x() += 0.002;
  for (const Eigen::Vector2d& half_m : {Eigen::Vector2d(0.06, 0.04), {0.012, 0.008}, {0.4, 0.05}})
    for (const int level : {0, 1}) {
      test::Solid solid;
      solid.addBox(0.0, 0.0, half_m.x(), half_m.y(), 0.02, -0.005, 0.005, 0.5);
      const test::Picture picture = paintedBy(test::renderEdges(solid, camera, pose).edges,
                                              level == 0 ? 200 : 140, level == 0 ? 50 : 110, 50);
      const test::Rendering render = test::renderEdges(solid, cameraAtLevel(camera, level), moved);
      const int left = std::max(0, static_cast<int>(260.0 - 2000.0 * half_m.x()));
      for (const int end : {512, 256, left + 13, left + 12, left + 11, left + 10, left + 9}) {
        test::Mask mask(camera.width, camera.height);
        mask.fill(end, 0, 512, 512);
        const BitImage* const ignore = end == 512 ? nullptr : &mask.bits;
        const RegionEvidence plain =
            PlainRegions(render.edges, level, picture.view(), ignore).evidence();
        const RegionEvidence measured = meter.measure(render.edges, level, picture.view(), ignore);
        EXPECT_EQ(measured.lines, plain.lines) << half_m.x() << ' ' << level << ' ' << end;
        EXPECT_EQ(measured.separated, plain.separated);
        EXPECT_DOUBLE_EQ(measured.separatedShare() * plain.lines, plain.separated);
        EXPECT_NEAR(measured.nats, plain.nats, 1e-9);
      }
    }
}

}  // namespace
}  // namespace boresight
