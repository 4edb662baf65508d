// SPDX-License-Identifier: Apache-2.0
// What Pham 2025 (IEEE RA-L, DOI 10.1109/LRA.2025.3614045) reports, to be shown beside our own.
#pragma once

#include <array>

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

/// Minutes on a flight processor of 200 MHz, BC and OS added up.
struct PaperTimes {
  const char* method;
  double initialization_min;
  double rendering_min;
  double matching_min;
  double pose_min;
  double total_min;
};

/// Real images.
struct PaperSuccess {
  const char* set;
  int runs;
  const char* method;
  double completed_percent;
  double success_percent;
};

inline constexpr PaperErrors kErrors[] = {
    {"bc", "seed", 100, 0, {-0.095, 12.73, 19.92}, {16.94, 8.853, 29.99}, {48.86, 26.32, 86.92}},
    {"bc", "orb", 0, 0, {}, {}, {}},
    {"bc", "ssd", 2.1, 0.9, {8.179, 23.76, 93.76}, {21.97, 38.31, 142.2}, {193.3, 196.8, 593.4}},
    {"bc", "ncc", 94.3, 94.0, {-0.062, 1.153, 23.60}, {0.177, 1.511, 57.30}, {2.512, 15.78, 330.9}},
    {"bc",
     "loftr-r",
     100,
     98.0,
     {-0.174, 0.324, 2.009},
     {0.156, 0.153, 1.332},
     {3.936, 3.782, 37.95}},
    {"bc",
     "loftr-s",
     99.5,
     91.0,
     {-0.205, 1.421, 5.842},
     {0.318, 1.792, 74.83},
     {7.232, 12.24, 351.3}},
    {"bc", "whs", 100, 100, {0.005, 0.082, 0.446}, {0.083, 0.036, 0.232}, {1.143, 0.708, 6.477}},
    {"os", "seed", 100, 1.1, {-0.054, 7.321, 11.45}, {7.906, 4.131, 14.00}, {17.13, 9.225, 30.47}},
    {"os", "orb", 45.6, 21.1, {0.107, 2.060, 14.63}, {0.846, 0.916, 7.278}, {25.12, 25.33, 148.9}},
    {"os", "ssd", 43.6, 43.6, {0.159, 0.185, 0.865}, {0.163, 0.072, 0.494}, {2.707, 1.673, 11.52}},
    {"os", "ncc", 98.7, 98.7, {0.146, 0.150, 1.053}, {0.162, 0.064, 0.494}, {2.206, 1.367, 9.351}},
    {"os",
     "loftr-r",
     95.0,
     22.3,
     {0.059, 1.699, 7.662},
     {0.917, 0.907, 31.99},
     {27.21, 15.11, 109.3}},
    {"os",
     "loftr-s",
     51.1,
     6.6,
     {-1.103, 7.535, 54.16},
     {5.085, 11.69, 71.67},
     {31.81, 22.02, 157.4}},
    {"os", "whs", 100, 100, {0.012, 0.208, 1.213}, {0.167, 0.075, 0.590}, {2.725, 1.737, 13.20}},
};

inline constexpr PaperTimes kTimes[] = {
    {"orb", 1.13, 7.40, 0.60, 2.66, 11.79},          {"ssd", 1.11, 7.49, 3.73, 1.67, 14.00},
    {"ncc", 1.12, 7.11, 3.61, 0.38, 12.22},          {"loftr-r", 1.35, 8.08, 671.26, 0.69, 681.38},
    {"loftr-s", 1.23, 7.70, 2146.98, 4.65, 2160.56}, {"whs", 1.22, 6.91, 13.17, 0.02, 21.33},
};

inline constexpr PaperSuccess kSuccess[] = {
    {"testbed OS", 20, "orb", 0, 0},
    {"testbed OS", 20, "ssd", 100, 45},
    {"testbed OS", 20, "ncc", 100, 45},
    {"testbed OS", 20, "loftr-r", 70, 5},
    {"testbed OS", 20, "loftr-s", 10, 0},
    {"testbed OS", 20, "whs", 100, 100},
    {"testbed BC", 20, "orb", 0, 0},
    {"testbed BC", 20, "ssd", 40, 0},
    {"testbed BC", 20, "ncc", 65, 0},
    {"testbed BC", 20, "loftr-r", 100, 95},
    {"testbed BC", 20, "loftr-s", 100, 95},
    {"testbed BC", 20, "whs", 100, 100},
    {"Mars BC near 0.49 m", 3, "orb", 0, 0},
    {"Mars BC near 0.49 m", 3, "ssd", 0, 0},
    {"Mars BC near 0.49 m", 3, "ncc", 33.3, 0},
    {"Mars BC near 0.49 m", 3, "loftr-r", 100, 100},
    {"Mars BC near 0.49 m", 3, "loftr-s", 66.7, 0},
    {"Mars BC near 0.49 m", 3, "whs", 100, 100},
    {"Mars BC far 1.23 m", 3, "orb", 0, 0},
    {"Mars BC far 1.23 m", 3, "ssd", 0, 0},
    {"Mars BC far 1.23 m", 3, "ncc", 0, 0},
    {"Mars BC far 1.23 m", 3, "loftr-r", 100, 0},
    {"Mars BC far 1.23 m", 3, "loftr-s", 33.3, 0},
    {"Mars BC far 1.23 m", 3, "whs", 100, 0},
};

}  // namespace boresight::sessions
