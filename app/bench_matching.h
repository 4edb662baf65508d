// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/kernels.h"

namespace boresight::app {

/// One template searched in one window, by WHS and by OpenCV's normalized cross-correlation.
struct MatchingFigure {
  int side_px = 0;
  int window_px = 0;  ///< offsets along each axis
  /// By set of kernels; 0 where this machine does not have it.
  std::array<double, kKernelSets> whs_ms{};
  double ncc_ms = 0.0;
};

/// Templates of 32 to 256 px in windows of 64 to 600 px of a drawn scene (lines and circles, seen
/// displaced and with gaps among clutter); the best time of `repetitions` each, on one thread.
/// `quick` takes the smallest window only.
std::vector<MatchingFigure> measureMatching(int repetitions, bool quick);

/// Geometric mean of NCC's time over WHS's with these kernels, which the machine must have.
double meanRatio(const std::vector<MatchingFigure>& figures, Kernels kernels);

}  // namespace boresight::app
