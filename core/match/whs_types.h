// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace boresight {

/// S+ and S- of Pham 2025, Eqs. 1-6: template edge pixels that meet a test edge, and masked-in
/// template non-edge pixels that meet none.
struct WhsCounts {
  std::int32_t edge_hits = 0;                         ///< S+
  std::int32_t empty_hits = 0;                        ///< S-
  bool operator==(const WhsCounts&) const = default;  ///< the same counts
};

/// c+ and c-: masked-in edge and non-edge pixels of a template.
struct WhsNorms {
  std::int32_t edges = 0;    ///< c+
  std::int32_t empties = 0;  ///< c-
  bool operator==(const WhsNorms&) const = default;
};

/// The integer in which offsets are compared: S+ * max(c-, 1) + S- * max(c+, 1).
inline std::int64_t whsComparable(const WhsCounts& counts, const WhsNorms& norms) {
  const std::int64_t c_plus = norms.edges > 1 ? norms.edges : 1;
  const std::int64_t c_minus = norms.empties > 1 ? norms.empties : 1;
  return counts.edge_hits * c_minus + counts.empty_hits * c_plus;
}

/// A square of the render, side `side_px` (even), centred at (center_x, center_y): it spans
/// center - side/2 ... center + side/2 - 1 and lies wholly inside the render. Bits are not copied.
struct TemplateView {
  const BitImage* edges = nullptr;  ///< of the whole render
  const BitImage* mask = nullptr;   ///< of the whole render
  int center_x = 0;                 ///< px
  int center_y = 0;                 ///< px
  int side_px = 0;                  ///< even
};

/// Result of searching a window.
struct WhsPeak {
  int x = 0, y = 0;                ///< best place of the template's centre, px
  WhsCounts counts;                ///< at the best place
  int second_x = 0, second_y = 0;  ///< best place outside the exclusion square around the best
  WhsCounts second_counts;         ///< at the second place
  bool has_second = false;         ///< whether there is a second place
  bool operator==(const WhsPeak&) const = default;
};

}  // namespace boresight
