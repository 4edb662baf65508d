// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/accept/support_options.h"

namespace boresight {

/// A share of something, 0 of nothing.
inline double shareOf(std::int32_t part, std::int32_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}
/// What exceeds chance, in [0, 1].
inline double beyondChance(double share, double chance) {
  return share > chance && chance < 1.0 ? (share - chance) / (1.0 - chance) : 0.0;
}

/// Where the object is visible: what an occluder, a deep shadow or saturation hides takes whole
/// regions away and leaves others as they are, whereas a wrong pose is met here and there all over.
/// The box around the rendered edges is divided into 8 x 8 cells; the object is *visible* in those
/// where the coverage of kVisibleFrom_places places or more exceeds chance by kVisibleExcess at
/// least. *Precision* is the part of the edges found within the search radius that lie near the
/// rendered ones, beyond chance: where nothing is seen nothing is missed.
struct PartialSupport {
  static constexpr std::int32_t kVisibleFrom_places = 8;  ///< a cell with fewer says nothing
  /// Excess of coverage over chance from which a cell counts as visible.
  static constexpr double kVisibleExcess = 0.35;

  std::int32_t rendered = 0;           ///< as in EdgeSupport
  std::int32_t visible = 0;            ///< of these in cells where the object is visible
  std::int32_t cells = 0;              ///< with so many places
  std::int32_t visible_cells = 0;      ///< cells in which the object is visible
  std::int32_t found = 0;              ///< places with an edge within the search radius
  std::int32_t covered = 0;            ///< of those, near the rendered edge
  std::int32_t displaced_found = 0;    ///< the same for the displaced render
  std::int32_t displaced_covered = 0;  ///< the same for the displaced render

  /// Share of the rendered edges that lies in visible cells.
  double visibleShare() const { return shareOf(visible, rendered); }
  /// Share of the edges there that is met, beyond chance.
  double precision() const {
    return beyondChance(shareOf(covered, found), shareOf(displaced_covered, displaced_found));
  }
  /// What the options ask for before a pose of little support is accepted.
  bool suffices(const SupportOptions& options) const {
    return visibleShare() >= options.partial_visible && precision() >= options.partial_precision;
  }
};

}  // namespace boresight
