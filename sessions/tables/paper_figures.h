// SPDX-License-Identifier: Apache-2.0
// What Pham 2025 (IEEE RA-L, DOI 10.1109/LRA.2025.3614045) reports, to be shown beside our own.
#pragma once

#include <array>
#include <span>

namespace boresight::sessions {

inline constexpr const char* kPaperSource = "Pham et al., IEEE RA-L 2025, 10.1109/LRA.2025.3614045";
/// To be said wherever its success stands beside ours.
inline constexpr const char* kPaperCaution =
    "Rows marked (paper): 2000 synthetic images a station. The requirement behind its success "
    "column is not stated and is not ours: compare errors, not success.";

/// mean, standard deviation, maximum
using PaperStatistics = std::array<double, 3>;

/// Synthetic images, near. Errors are all 0 where nothing completed.
struct PaperErrors {
  const char* station;
  const char* method;
  double completed_percent;
  double success_percent;
  PaperStatistics normal_mm;
  PaperStatistics lateral_mm;
  PaperStatistics rotation_mrad;
};
std::span<const PaperErrors> paperErrors();

/// Minutes on a flight processor of 200 MHz, BC and OS added up.
struct PaperTimes {
  const char* method;
  double initialization_min;
  double rendering_min;
  double matching_min;
  double pose_min;
  double total_min;
};
std::span<const PaperTimes> paperTimes();

/// Real images.
struct PaperSuccess {
  const char* set;
  int runs;
  const char* method;
  double completed_percent;
  double success_percent;
};
std::span<const PaperSuccess> paperSuccess();

}  // namespace boresight::sessions
