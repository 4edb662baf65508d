// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/options.h"
#include "core/edges/edge_map.h"
#include "core/localizer/edge_search.h"
#include "core/render/edge_render.h"

namespace boresight {

struct SupportOptions {
  bool gate = true;
  double min_support = 0.32;
  double search_radius_px = 4.0;
  double near_px = 1.0;
  double min_gradient = 4.0;
  double derivative_sigma_px = 1.0;
  bool partial = false;
  double partial_visible = 0.45;
  double partial_precision = 0.7;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"support.gate", "", 0, 1,
                     "A converged pose must be supported by the image's edges."},
          self.gate);
    visit(OptionInfo{"support.min_support", "", 0.0, 1.0,
                     "Edge support that a converged pose must have."},
          self.min_support);
    visit(OptionInfo{"support.search_radius_px", "px", 1.0, 50.0,
                     "How far around a rendered edge its counterpart is looked for, in pixels of "
                     "the render."},
          self.search_radius_px);
    visit(OptionInfo{"support.near_px", "px", 0.1, 50.0,
                     "A rendered edge counts as seen when its counterpart is this near, in pixels "
                     "of the render."},
          self.near_px);
    visit(OptionInfo{"support.min_gradient", "gray/px", 0.0, 255.0,
                     "Weaker edges do not count as seen."},
          self.min_gradient);
    visit(OptionInfo{"support.derivative_sigma_px", "px", 0.3, 5.0,
                     "Scale of the derivative along the normal."},
          self.derivative_sigma_px);
    visit(OptionInfo{"support.partial", "", 0, 1,
                     "A pose with too little edge support for a part of the object being hidden is "
                     "accepted when enough of the object is visible and precisely met."},
          self.partial);
    visit(OptionInfo{"support.partial_visible", "", 0.0, 1.0,
                     "Share of the rendered edges that must lie where the object is visible."},
          self.partial_visible);
    visit(OptionInfo{"support.partial_precision", "", 0.0, 1.0,
                     "Share of the edges found about the rendered ones that must be met, beyond "
                     "chance."},
          self.partial_precision);
  }
};

/// How well a pose explains the image, not resting on any match. Two sides, kept apart:
/// *coverage*, how much of what the pose predicts is seen: rendered edge pixels where the strongest
/// derivative of the raw image along the edge's normal, within the search radius, lies near the
/// edge; *explained*, how much of what is seen on the object is predicted: test edges inside the
/// mask with a rendered edge within one pixel (the rest is texture, shadow, or somebody else's
/// edge). Both also come about by chance, the more the denser the edges: the same counts with the
/// render displaced in four directions say how much. What exceeds chance counts. A wrong pose
/// covers a part and explains little; a dark or textured object is strong in one of the two.
struct EdgeSupport {
  std::int32_t rendered =
      0;  ///< rendered edge pixels looked at (an even subset of many), not ignored
  std::int32_t covered = 0;
  std::int32_t displaced = 0;  ///< the same for the displaced render
  std::int32_t displaced_covered = 0;
  std::int32_t seen = 0;  ///< test edge pixels inside the mask, at the render's level
  std::int32_t explained = 0;
  std::int32_t displaced_explained = 0;  ///< over four displacements

  double coverage() const { return ratio(covered, rendered); }
  double chanceCoverage() const { return ratio(displaced_covered, displaced); }
  double explanation() const { return ratio(explained, seen); }
  double chanceExplanation() const { return 0.25 * ratio(displaced_explained, seen); }
  /// (2 coverage + explanation) / 3, each as its excess over chance, in [0, 1].
  double share() const {
    return (2.0 * excess(coverage(), chanceCoverage()) +
            excess(explanation(), chanceExplanation())) /
           3.0;
  }

 private:
  static double ratio(std::int32_t part, std::int32_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  }
  static double excess(double share, double chance) {
    return share > chance && chance < 1.0 ? (share - chance) / (1.0 - chance) : 0.0;
  }
};

/// Counts a rendered edge pixel as looked at and, when its counterpart is near, as covered; ignored
/// ones not at all. `direction` 0 ... 3 displaces it by one of those that tell what comes about by
/// chance, -1 leaves it in place.
void countEdge(const EdgePixel& pixel, int direction, int level, const EdgeSearch& search,
               const ImageView& image, const BitImage* ignore, const SupportOptions& options,
               std::int32_t& looked, std::int32_t& covered);

/// Where the object is visible: what an occluder, a deep shadow or saturation hides takes whole
/// regions away and leaves others as they are, whereas a wrong pose is met here and there all over.
/// The box around the rendered edges is divided into 8 x 8 cells; the object is *visible* in those
/// where the coverage of kVisibleFrom_places places or more exceeds chance by kVisibleExcess at
/// least. *Precision* is the part of the edges found within the search radius that lie near the
/// rendered ones, beyond chance: where nothing is seen nothing is missed.
struct PartialSupport {
  static constexpr std::int32_t kVisibleFrom_places = 8;
  static constexpr double kVisibleExcess = 0.35;

  std::int32_t rendered = 0;  ///< as in EdgeSupport
  std::int32_t visible = 0;   ///< of these in cells where the object is visible
  std::int32_t cells = 0;     ///< with so many places
  std::int32_t visible_cells = 0;
  std::int32_t found = 0;  ///< places with an edge within the search radius
  std::int32_t covered = 0;
  std::int32_t displaced_found = 0;  ///< the same for the displaced render
  std::int32_t displaced_covered = 0;

  double visibleShare() const;
  double precision() const;
  /// What the options ask for before a pose of little support is accepted.
  bool suffices(const SupportOptions& options) const {
    return visibleShare() >= options.partial_visible && precision() >= options.partial_precision;
  }
};

/// `image` is raw, at full resolution; `level` is the render's. `ignore` may be nullptr, `partial`
/// too.
EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore,
                               const SupportOptions& options, PartialSupport* partial = nullptr);

}  // namespace boresight
