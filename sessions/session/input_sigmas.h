// SPDX-License-Identifier: Apache-2.0
// Uncertainty of a case's mesh scale and calibration.
#pragma once

#include <optional>
#include <string>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// One sigma of each as used: from the camera's covariance, stated, or else assumed.
struct InputSigmas {
  double mesh_scale = kAssumedMeshScaleSigma;  ///< relative
  CalibrationSigma calibration;
  bool mesh_scale_stated = false;
  bool calibration_stated = false;   ///< also by the camera's covariance
  bool calibration_derived = false;  ///< from the camera's covariance, which is used instead

  explicit InputSigmas(const SessionCase& session_case);
};
/// "0.02 %, assumed".
std::string meshScaleText(const InputSigmas& sigmas);
/// "0.02 % and 0.5 px, assumed", "..., by the camera's covariance".
std::string calibrationText(const InputSigmas& sigmas);

/// The same session with these sigmas stated (empty: assumed): the mesh's for all cases of the same
/// parts as this case, the camera's for all cases of the same camera.
Session withInputSigmas(const Session& session, const std::string& case_id,
                        const std::optional<double>& mesh_scale_sigma,
                        const std::optional<CalibrationSigma>& calibration_sigma);

}  // namespace boresight::sessions
