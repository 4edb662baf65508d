// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/edges/gradient.h"

namespace boresight {

/// Canny's thresholds in the units of `GradientRows::magnitude`: a pixel exceeds one when its
/// magnitude is greater.
struct CannyLimits {
  std::int32_t low = 0;   ///< a pixel above it continues an edge
  std::int32_t high = 0;  ///< a pixel above it starts an edge
};

/// From thresholds in the units of cv::Canny (L2 norm, not squared), rounded down as there.
/// Requires 0 <= low <= high.
CannyLimits cannyLimits(double low, double high);

/// Non-maximum suppression of row y of `gradient`, whose row y + 1 must be done (if there is one).
/// `candidates`: packed pixels whose magnitude exceeds the low limit and is largest across the
/// edge; `strong`: candidates above the high limit. The direction is cv::Canny's integer test
/// against tan 22.5 and 67.5 deg, and of equal neighbours the first wins, as in cv::Canny.
void suppressRow(const GradientRows& gradient, int y, int width, const CannyLimits& limits,
                 std::uint64_t* candidates, std::uint64_t* strong);

}  // namespace boresight
