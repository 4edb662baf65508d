// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/accept/support_options.h"
#include "core/base/image.h"
#include "core/edges/edge_map.h"
#include "core/refine/edge_search.h"
#include "core/render/edge_render.h"

namespace boresight {

/// How far around a rendered edge its counterpart is searched, in pixels of the render: wide enough
/// that what is near by chance shows, too.
inline constexpr double kSupportRadius_px = 4.0;
/// A rendered edge counts as seen when its counterpart is this near, in pixels of the render: the
/// error that a right pose leaves.
inline constexpr double kSupportNear_px = 1.0;
inline constexpr double kSupportMinGradient = 4.0;         ///< gray/px; weaker ones are noise
inline constexpr double kSupportDerivativeSigma_px = 1.0;  ///< the blur of a sharp image

/// A share of something, 0 of nothing.
inline double shareOf(std::int32_t part, std::int32_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}
/// What exceeds chance, in [0, 1].
inline double aboveChance(double share, double chance) {
  return share > chance && chance < 1.0 ? (share - chance) / (1.0 - chance) : 0.0;
}

/// How well a pose explains the image, not resting on any match. Two sides, kept apart:
/// *coverage*, how much of what the pose predicts is seen: rendered edge pixels where the strongest
/// derivative of the raw image along the edge's normal, within the search radius, lies near the
/// edge; *explained*, how much of what is seen on the object is predicted: test edges inside the
/// mask with a rendered edge within one pixel (the rest is texture, shadow, or edges of
/// other objects). Both also come about by chance, the more the denser the edges: the same counts
/// with the render displaced in four directions say how much. What exceeds chance counts. A wrong
/// pose covers a part and explains little; a dark or textured object is strong in one of the two.
struct EdgeSupport {
  std::int32_t rendered =
      0;  ///< rendered edge pixels looked at (an even subset of many), not ignored
  std::int32_t covered = 0;            ///< of those, seen in the image
  std::int32_t displaced = 0;          ///< the same for the displaced render
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

/// Whether the image supports a pose; always when the options ask for no support.
inline bool isSupported(const EdgeSupport& support, const SupportOptions& options) {
  return !options.gate || support.share() >= options.min_support;
}

/// The same of a pose that a search has found.
inline bool isProbable(double probability, const SupportOptions& options) {
  return !options.gate || probability >= options.min_probability;
}

/// Counts a rendered edge pixel as looked at and, when its counterpart is near, as covered; ignored
/// ones not at all. `direction` 0 ... 3 displaces it by one of those that tell what comes about by
/// chance, -1 leaves it in place.
void countEdge(const EdgePixel& pixel, int direction, int level, const EdgeSearch& search,
               const ImageView& image, const BitImage* ignore, std::int32_t& looked,
               std::int32_t& covered);

/// `image` is raw, at full resolution; `level` is the render's. `ignore` may be nullptr.
EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore);

}  // namespace boresight
