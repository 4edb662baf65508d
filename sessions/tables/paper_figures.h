// SPDX-License-Identifier: Apache-2.0
// Figures of Pham et al. 2025 (IEEE RA-L, DOI 10.1109/LRA.2025.3614045), Tables I to III.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace boresight::sessions {

inline constexpr const char* kPaperSource = "Pham et al., IEEE RA-L 2025, 10.1109/LRA.2025.3614045";
/// Shown wherever the success of Table I is listed with ours.
inline constexpr const char* kPaperCaution =
    "Rows marked (paper): 2000 synthetic images a station. The paper requires 0.4 mm and 0.25 deg "
    "(Sec. I), but its successful runs exceed both (Table I): compare errors, not success.";

/// Mean, standard deviation, maximum.
using PaperStatistics = std::array<double, 3>;

/// A row of Table I: synthetic images, near. Errors are all 0 where no run completed.
struct PaperErrors {
  const char* method;
  double completed_percent;
  double success_percent;
  PaperStatistics normal_mm;
  PaperStatistics lateral_mm;
  PaperStatistics rotation_mrad;
};

/// A set of Table II: real images, by kPaperMethods.
inline constexpr std::array<const char*, 6> kPaperMethods = {"orb",     "ssd",     "ncc",
                                                             "loftr-r", "loftr-s", "whs"};
struct PaperSuccess {
  const char* set;
  int runs;
  std::array<double, 6> completed_percent;
  std::array<double, 6> success_percent;
  /// Normal, lateral, rotation; of the far set alone.
  std::optional<std::array<std::array<double, 3>, 6>> within_percent = {};
};

/// A column of Table III: minutes on one core at 200 MHz, a BC and an OS case added up.
struct PaperTimes {
  const char* method;
  double initialization_min;
  double rendering_min;
  double matching_min;
  double pose_min;
  double total_min;
};

/// The rows of a station, "bc" or "os"; empty for others.
std::span<const PaperErrors> paperErrors(std::string_view station);
extern const std::span<const PaperSuccess> kPaperSuccess;
extern const std::span<const PaperTimes> kPaperTimes;

}  // namespace boresight::sessions
