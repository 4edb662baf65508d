// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

enum class Equalization : std::int32_t { kOff = 0, kHistogram = 1, kClahe = 2 };
inline constexpr const char* kEqualizationNames[] = {"off", "histogram", "clahe"};

enum class CannyThresholds : std::int32_t { kAbsolute = 0, kQuantile = 1 };
inline constexpr const char* kCannyThresholdsNames[] = {"absolute", "quantile"};

/// Options of the edge detection in the test image (Pham 2025, Sec. III-B, states no parameters;
/// Canny 1986).
struct EdgeOptions {
  Equalization equalization = Equalization::kHistogram;
  double gaussian_sigma_px = 1.5;
  CannyThresholds thresholds = CannyThresholds::kQuantile;
  double low_threshold = 50.0;  ///< gradient magnitude as cv::Canny counts it (kAbsolute)
  double high_threshold = 150.0;
  double high_quantile = 0.9;  ///< high = this quantile of the magnitudes of unignored pixels

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"edges.equalization", "", 0, 2,
                     "Histogram equalization before edge detection.", kEqualizationNames},
          self.equalization);
    visit(OptionInfo{"edges.gaussian_sigma_px", "px", 0.0, 8.0,
                     "Smoothing before Canny; 0 switches it off."},
          self.gaussian_sigma_px);
    visit(OptionInfo{"edges.thresholds", "", 0, 1,
                     "Canny thresholds as given, or from the image's gradients.",
                     kCannyThresholdsNames},
          self.thresholds);
    visit(OptionInfo{"edges.low_threshold", "", 0.0, 100000.0,
                     "Lower Canny threshold when absolute."},
          self.low_threshold);
    visit(OptionInfo{"edges.high_threshold", "", 0.0, 100000.0,
                     "Upper Canny threshold when absolute."},
          self.high_threshold);
    visit(OptionInfo{"edges.high_quantile", "", 0.5, 0.9999,
                     "Share of pixels whose gradient lies below the upper threshold."},
          self.high_quantile);
  }
};

}  // namespace boresight
