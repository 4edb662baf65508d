// SPDX-License-Identifier: Apache-2.0
// How well the mesh's scale and the camera's calibration are known: one image cannot tell either.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"

namespace boresight::sessions {

/// One sigma of a mesh's scale (relative) where none is stated: 0.06 mm on a part of 0.3 m, or 9 K
/// of aluminium. Good for a machined part and its drawing, not for a scan.
inline constexpr double kAssumedMeshScaleSigma = 2e-4;

/// One sigma of a camera's calibration. The values are those assumed where none is stated: what a
/// calibration from many pictures of a target reaches.
struct CalibrationSigma {
  double focal_relative = 2e-4;     ///< of fx and fy together, as a share of them
  double principal_point_px = 0.5;  ///< per axis

  bool operator==(const CalibrationSigma&) const = default;
};

inline constexpr double kMaxScaleSigma = 0.1;
inline constexpr double kMaxFocalSigma = 0.1;
inline constexpr double kMaxPrincipalPointSigma_px = 1000.0;

/// Reads a `mesh_scale_sigma`. InputError.
double readMeshScaleSigma(const JsonReader& json);

/// Reads {"focal_relative", "principal_point_px"}. InputError.
CalibrationSigma readCalibrationSigma(const JsonReader& json);
nlohmann::ordered_json toJson(const CalibrationSigma& sigma);

}  // namespace boresight::sessions
