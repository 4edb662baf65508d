// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/render/edge_pixel.h"

namespace boresight {

/// Evidence of the gray values on both sides of an outline: whether they differ, and whether they
/// change at the outline rather than some pixels next to it. It does not use edges and is therefore
/// independent of the contour evidence.
struct RegionEvidence {
  /// Mean over the lines across the outline, nats: log-likelihood of the border at the outline
  /// minus that of a border anywhere on the line; in [-0.8, 1.2].
  double nats = 0.0;
  std::int32_t lines = 0;      ///< lines across the outline that were measured
  std::int32_t separated = 0;  ///< of these, lines on which the outline is the likelier border

  /// Share of the lines on which the outline is the likelier border; 0 without lines.
  double separatedShare() const {
    return lines > 0 ? static_cast<double>(separated) / static_cast<double>(lines) : 0.0;
  }
};

/// Measures RegionEvidence from gray values inside and outside an outline by sectors, as in
/// region-based tracking (Stoiber et al. 2022, SRT3D).
class RegionEvidenceMeter {
 public:
  static constexpr int kMostLines = 2500;  ///< across the outline

  /// Takes the memory from `arena`. kArenaTooSmall.
  Status create(Arena& arena);
  /// Measures a render of level `level`; `image` is raw, at full resolution. `ignore` may be
  /// nullptr. No evidence (0) with fewer than 20 lines inside the image.
  RegionEvidence measure(const EdgeRender& render, int level, const ImageView& image,
                         const BitImage* ignore);

 private:
  static constexpr int kHalf = 8;  ///< samples of a line to either side of the outline
  static constexpr int kSamples = 2 * kHalf;
  static constexpr int kBins = 32;  ///< of gray values
  static constexpr int kSectors = 12;
  using Histogram = std::array<std::uint16_t, kBins>;
  /// Gray values across the outline, from the inside outwards.
  struct Line {
    std::array<std::uint8_t, kSamples> bin{};
    std::uint8_t sector = 0;
  };

  void takeLines(const EdgeRender& render, int level, const ImageView& image,
                 const BitImage* ignore);
  void fillHistograms();
  void fillLogOdds();
  double lineNats(const Line& line) const;

  std::span<Line> lines_;
  int count_ = 0;
  std::array<Histogram, kSectors> inside_{}, outside_{};
  /// log(q / (1 - q)) by sector and gray value, q the probability of the inside.
  std::array<std::array<double, kBins>, kSectors> log_odds_{};
};

}  // namespace boresight
