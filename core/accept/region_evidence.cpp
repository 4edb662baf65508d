// SPDX-License-Identifier: Apache-2.0
#include "core/accept/region_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"

namespace boresight {
namespace {

/// Half of a line's length: this share of the outline's longer side, within limits in px of the
/// render's level and of the image.
constexpr double kReach = 0.08;
constexpr double kLeastReach = 6.0;
constexpr double kMostReach = 40.0;
constexpr int kLeastLines = 20;
/// Share of either side that no gray value excludes.
constexpr double kTrustedRegion = 0.96;
constexpr double kLeastColourShare = 0.001;
constexpr double kLeast_nats = -0.8;
constexpr double kMost_nats = 1.2;

/// Bounding box and centre of the outline's places, px of the render.
struct OutlineBox {
  Eigen::AlignedBox2i bounds;
  std::int64_t sum_x = 0, sum_y = 0;
  std::int32_t places = 0;

  void extend(const EdgePixel& pixel) {
    bounds.extend(Eigen::Vector2i(pixel.x, pixel.y));
    sum_x += pixel.x;
    sum_y += pixel.y;
    ++places;
  }
  int longerSide() const { return bounds.sizes().maxCoeff() + 1; }
};

/// Sector of a direction among twelve of 30 deg: sectors 0 to 2 have x and y positive.
int sectorOf(double x, double y) {
  constexpr double kTan30 = 0.57735026918962576;
  const double a = std::abs(x);
  const double b = std::abs(y);
  int third = 1;
  if (b < kTan30 * a) third = 0;
  if (a < kTan30 * b) third = 2;
  if (x >= 0.0) return y >= 0.0 ? third : 11 - third;
  return y >= 0.0 ? 5 - third : 6 + third;
}

/// Bilinear gray value in units of 1/256; false outside the image and at ignored pixels.
bool sampleAt(const ImageView& image, const BitImage* ignore, const Eigen::Vector2d& place_px,
              std::int32_t& gray_256) {
  if (!(place_px.x() >= 0.0 && place_px.y() >= 0.0 && place_px.x() < image.width - 1 &&
        place_px.y() < image.height - 1))
    return false;
  const int x = static_cast<int>(place_px.x());
  const int y = static_cast<int>(place_px.y());
  if (ignore != nullptr && ignore->get(x, y)) return false;
  const auto right = static_cast<std::int32_t>((place_px.x() - x) * 16.0);
  const auto down = static_cast<std::int32_t>((place_px.y() - y) * 16.0);
  const std::uint8_t* top = image.data + image.stride * y + x;
  const std::uint8_t* bottom = top + image.stride;
  gray_256 = (top[0] * (16 - right) + top[1] * right) * (16 - down) +
             (bottom[0] * (16 - right) + bottom[1] * right) * down;
  return true;
}

}  // namespace

Status RegionEvidenceMeter::create(Arena& arena) {
  lines_ = arena.allocate<Line>(kMostLines);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

RegionEvidence RegionEvidenceMeter::measure(const EdgeRender& render, int level,
                                            const ImageView& image, const BitImage* ignore) {
  RegionEvidence evidence;
  takeLines(render, level, image, ignore);
  if (count_ < kLeastLines) return evidence;
  fillHistograms();
  fillLogOdds();
  for (int i = 0; i < count_; ++i) {
    const double nats = lineNats(nth(lines_, i));
    evidence.nats += nats;
    if (nats > 0.0) ++evidence.separated;
  }
  evidence.lines = count_;
  evidence.nats = std::clamp(evidence.nats / count_, kLeast_nats, kMost_nats);
  return evidence;
}

/// Samples across the outline. Lines that leave the image or meet ignored pixels are left out.
void RegionEvidenceMeter::takeLines(const EdgeRender& render, int level, const ImageView& image,
                                    const BitImage* ignore) {
  count_ = 0;
  OutlineBox box;
  for (const EdgePixel& pixel : render.eachPixel())
    if (isBorder(pixel)) box.extend(pixel);
  if (box.places == 0) return;
  const double scale = levelScale(level);
  const double reach_px =
      std::clamp(kReach * scale * box.longerSide(), kLeastReach * scale, kMostReach * scale);
  const Eigen::Vector2d centre =
      Eigen::Vector2d(static_cast<double>(box.sum_x), static_cast<double>(box.sum_y)) / box.places;
  const std::int32_t stride = (box.places + kMostLines - 1) / kMostLines;
  std::int32_t index = 0;
  for (const EdgePixel& pixel : render.eachPixel()) {
    if (!isBorder(pixel) || index++ % stride != 0 || count_ == kMostLines) continue;
    const Eigen::Vector2d normal = pixel.normal();
    const Eigen::Vector2d place_px = atFullResolution(pixel.onLine_px(), level);
    Line& line = nth(lines_, count_);
    bool complete = true;
    for (int sample = 0; sample < kSamples && complete; ++sample) {
      const double along_px = (sample - kHalf + 0.5) * reach_px / kHalf;
      std::int32_t gray_256 = 0;
      complete = sampleAt(image, ignore, place_px + along_px * normal, gray_256);
      nth(line.bin, sample) = static_cast<std::uint8_t>(gray_256 >> 11);
    }
    if (!complete) continue;
    line.sector = static_cast<std::uint8_t>(sectorOf(pixel.x - centre.x(), pixel.y - centre.y()));
    ++count_;
  }
}

/// The two samples next to the outline belong to neither side.
void RegionEvidenceMeter::fillHistograms() {
  inside_ = {};
  outside_ = {};
  for (int i = 0; i < count_; ++i) {
    const Line& line = nth(lines_, i);
    for (int sample = 0; sample < kHalf - 1; ++sample) {
      const auto mirrored = static_cast<std::size_t>(kSamples - 1 - sample);
      ++inside_[line.sector][nth(line.bin, sample)];
      ++outside_[line.sector][line.bin[mirrored]];
    }
  }
}

/// Each sector with both neighbours, smoothed over neighbouring gray values.
void RegionEvidenceMeter::fillLogOdds() {
  const auto sumAt = [](const std::array<Histogram, kSectors>& of, int sector, int bin) {
    std::int64_t sum = 0;
    for (int turn = kSectors - 1; turn <= kSectors + 1; ++turn) {
      const Histogram& histogram = nth(of, (sector + turn) % kSectors);
      for (int next = -1; next <= 1; ++next)
        if (bin + next >= 0 && bin + next < kBins)
          sum += (next == 0 ? 2 : 1) * std::int64_t{nth(histogram, bin + next)};
    }
    return sum;
  };
  for (int sector = 0; sector < kSectors; ++sector) {
    std::array<std::int64_t, kBins> inside{};
    std::array<std::int64_t, kBins> outside{};
    std::int64_t all_inside = 0;
    std::int64_t all_outside = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      const auto at = static_cast<std::size_t>(bin);
      all_inside += inside[at] = sumAt(inside_, sector, bin);
      all_outside += outside[at] = sumAt(outside_, sector, bin);
    }
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const auto shareOf = [](std::int64_t count, std::int64_t all) {
        return (all > 0 ? static_cast<double>(count) / static_cast<double>(all) : 0.0) +
               kLeastColourShare;
      };
      const double f = shareOf(inside[bin], all_inside);
      const double g = shareOf(outside[bin], all_outside);
      const double q = 0.5 * (1.0 - kTrustedRegion) + kTrustedRegion * f / (f + g);
      nth(log_odds_, sector)[bin] = log(q / (1.0 - q));
    }
  }
}

/// Likelihood of the border at the outline over the mean of that at each place of the line.
double RegionEvidenceMeter::lineNats(const Line& line) const {
  std::array<double, kSamples + 1> likelihood{};  // log, of the border before each sample
  double sum = 0.0;
  for (std::size_t sample = 0; sample < kSamples; ++sample) {
    sum += log_odds_[line.sector][line.bin[sample]];
    likelihood[sample + 1] = sum;
  }
  const double most = *std::max_element(likelihood.begin(), likelihood.end());
  double mean = 0.0;
  for (const double of_place : likelihood) mean += exp(of_place - most);
  mean /= kSamples + 1;
  return likelihood[kHalf] - most - log(mean);
}

}  // namespace boresight
