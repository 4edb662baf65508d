// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/match/whs.h"

namespace boresight {

/// The definition, pixel by pixel (Pham 2025, Eqs. 1-3): S+ = sum of M T I, S- = sum of M (1 - T)
/// (1 - I). Slow on purpose: the oracle that every faster implementation is compared with. The
/// template must lie inside both images.
WhsCounts whsCountsReference(const TemplateView& view, const BitImage& test_edges, int x, int y);
WhsNorms whsNormsReference(const TemplateView& view);

/// What WhsSearch must find, by trying every offset twice.
WhsPeak whsPeakReference(const TemplateView& view, const BitImage& test_edges,
                         const SearchWindow& window, int predicted_x, int predicted_y,
                         int exclusion_px);

}  // namespace boresight
