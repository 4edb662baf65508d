// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight::sessions {

inline constexpr const char* kEqualizedHelp = "Equalizes the histograms of image and render first.";

/// Sum of squared differences of intensities (OpenCV TM_SQDIFF).
struct SsdOptions {
  bool masked = true;
  bool equalized = true;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"ssd.masked", "", 0, 1,
                     "Compares only pixels of the rendered object, not of the background."},
          self.masked);
    visit(OptionInfo{"ssd.equalized", "", 0, 1, kEqualizedHelp}, self.equalized);
  }
};

enum class NccKind : std::int32_t { kCcorr = 0, kCcoeff = 1 };
inline constexpr const char* kNccKindNames[] = {"ccorr_normed", "ccoeff_normed"};

/// Normalized cross correlation of intensities (OpenCV TM_CCORR_NORMED, TM_CCOEFF_NORMED).
struct NccOptions {
  NccKind kind = NccKind::kCcoeff;
  bool masked = false;
  bool equalized = false;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"ncc.kind", "", 0, 1, "ccoeff_normed subtracts the means before correlating.",
                     kNccKindNames},
          self.kind);
    visit(OptionInfo{"ncc.masked", "", 0, 1,
                     "Correlates only pixels of the rendered object, not of the background."},
          self.masked);
    visit(OptionInfo{"ncc.equalized", "", 0, 1, kEqualizedHelp}, self.equalized);
  }
};

/// Oriented FAST and rotated BRIEF (OpenCV ORB) on image and render.
struct OrbOptions {
  std::int32_t features = 400;
  std::int32_t image_features = 4000;
  std::int32_t levels = 8;
  std::int32_t fast_threshold = 10;
  double ratio = 1.0;
  bool equalized = true;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"orb.features", "", 10, 1024, "Largest number of features of the render."},
          self.features);
    visit(OptionInfo{"orb.image_features", "", 10, 100000,
                     "Largest number of features of the image in all search windows."},
          self.image_features);
    visit(OptionInfo{"orb.levels", "", 1, 16, "Levels of ORB's own pyramid."}, self.levels);
    visit(OptionInfo{"orb.fast_threshold", "", 1, 255,
                     "Least contrast of a corner, gray values. OpenCV's default is 20."},
          self.fast_threshold);
    visit(OptionInfo{"orb.ratio", "", 0.1, 1.0,
                     "The best distance must be below this share of the second best; 1: no limit."},
          self.ratio);
    visit(OptionInfo{"orb.equalized", "", 0, 1, kEqualizedHelp}, self.equalized);
  }
};

/// Options of an external matcher process.
struct ExternalOptions {
  std::int32_t matches = 400;
  double start_timeout_s = 60.0;
  double timeout_s = 120.0;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"external.matches", "", 4, 1024, "Largest number of matches of an iteration."},
          self.matches);
    visit(OptionInfo{"external.start_timeout_s", "s", 0.1, 3600.0,
                     "The matcher must greet within this time."},
          self.start_timeout_s);
    visit(OptionInfo{"external.timeout_s", "s", 0.1, 3600.0,
                     "The matcher must answer within this time for each pair of images."},
          self.timeout_s);
  }
};

/// Parameters of the methods other than WHS; those of the loop are LocalizerOptions.
struct MethodOptions {
  SsdOptions ssd;
  NccOptions ncc;
  OrbOptions orb;
  ExternalOptions external;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    SsdOptions::visitFields(self.ssd, visit);
    NccOptions::visitFields(self.ncc, visit);
    OrbOptions::visitFields(self.orb, visit);
    ExternalOptions::visitFields(self.external, visit);
  }
};

/// The methods as published (Pham 2025, Sec. V-A), for profile `paper`: ORB with up to 400 features
/// and 8 levels, otherwise OpenCV's defaults; whole templates, unchanged gray values.
inline MethodOptions publishedMethods() {
  MethodOptions options;
  options.ssd = {.masked = false, .equalized = false};
  options.ncc = {.kind = NccKind::kCcoeff, .masked = false, .equalized = false};
  options.orb = {.features = 400,
                 .image_features = 400,
                 .levels = 8,
                 .fast_threshold = 20,
                 .ratio = 1.0,
                 .equalized = false};
  return options;
}

}  // namespace boresight::sessions
