// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/accept/support_options.h"
#include "core/base/image.h"
#include "core/edges/edge_map.h"
#include "core/refine/edge_search.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Search radius around a rendered edge, in pixels of the render: wide enough to include edges that
/// are near by chance.
inline constexpr double kSupportRadius_px = 4.0;
/// A rendered edge counts as seen when its counterpart is within this distance, in pixels of the
/// render: the error at a correct pose.
inline constexpr double kSupportNear_px = 1.0;
inline constexpr double kSupportMinGradient = 4.0;         ///< gray/px; weaker ones are noise
inline constexpr double kSupportDerivativeSigma_px = 1.0;  ///< the blur of a sharp image

/// part / whole; 0 when the whole is 0.
inline double shareOf(std::int32_t part, std::int32_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}
/// Excess of a share over chance, in [0, 1].
inline double aboveChance(double share, double chance) {
  return share > chance && chance < 1.0 ? (share - chance) / (1.0 - chance) : 0.0;
}

/// How well a pose explains the image, independent of any match. *Coverage* is the share of
/// rendered edge pixels seen: the strongest derivative of the raw image along the normal, within
/// the search radius, lies near the edge. *Explained* is the share of test edges inside the mask
/// with a rendered edge within one pixel; the rest is texture, shadow, or edges of other objects.
/// Both also occur by chance, more often with denser edges; the same counts with the render
/// displaced in four directions measure chance. Only the excess over chance counts. A wrong pose
/// has some coverage but explains little; a dark or textured object has one of the two high.
struct EdgeSupport {
  std::int32_t rendered = 0;   ///< rendered edge pixels tested (evenly sampled), not ignored
  std::int32_t covered = 0;    ///< of those, seen in the image
  std::int32_t displaced = 0;  ///< the same for the displaced render
  std::int32_t displaced_covered = 0;  ///< of those, seen in the image
  std::int32_t seen = 0;               ///< test edge pixels inside the mask, at the render's level
  std::int32_t explained = 0;          ///< of those, predicted by the render
  std::int32_t displaced_explained = 0;  ///< over four displacements

  /// Share of the rendered edges that is seen.
  double coverage() const { return shareOf(covered, rendered); }
  /// The same by chance.
  double chanceCoverage() const { return shareOf(displaced_covered, displaced); }
  /// Share of the edges seen on the object that is predicted.
  double explanation() const { return shareOf(explained, seen); }
  /// The same by chance.
  double chanceExplanation() const { return 0.25 * shareOf(displaced_explained, seen); }
  /// (2 coverage + explanation) / 3, each as its excess over chance, in [0, 1].
  double share() const {
    return (2.0 * aboveChance(coverage(), chanceCoverage()) +
            aboveChance(explanation(), chanceExplanation())) /
           3.0;
  }
};

/// Whether the image supports a pose; always true when the options require no support.
inline bool isSupported(const EdgeSupport& support, const SupportOptions& options) {
  return !options.gate || support.share() >= options.min_support;
}

/// The same for a pose found by a search.
inline bool isProbable(double probability, const SupportOptions& options) {
  return !options.gate || probability >= options.min_probability;
}

/// Counts a rendered edge pixel as tested and, when its counterpart is near, as covered; skips
/// ignored pixels. `direction` 0 ... 3 displaces it by one of the displacements that measure
/// chance, -1 leaves it in place.
void countEdge(const EdgePixel& pixel, int direction, int level, const EdgeSearch& search,
               const ImageView& image, const BitImage* ignore, std::int32_t& looked,
               std::int32_t& covered);

/// `image` is raw, at full resolution; `level` is the render's. `ignore` may be nullptr.
EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore);

}  // namespace boresight
