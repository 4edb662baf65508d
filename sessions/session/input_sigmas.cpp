// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sigmas.h"

#include <algorithm>
#include <cstdio>

namespace boresight::sessions {
namespace {

/// "0.02": at most three significant digits.
std::string shortNumber(double value) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Where none is stated: the principal point to half a pixel of 2048, or as much of other images.
CalibrationSigma assumedCalibration(const Camera& camera) {
  CalibrationSigma sigma;
  sigma.principal_point_px *= std::max(camera.width, camera.height) / 2048.0;
  return sigma;
}

const char* sourceText(bool stated) { return stated ? "" : ", assumed"; }

CalibrationSigma calibrationOf(const SessionCase& one) {
  if (one.camera_covariance) return calibrationSigmaOf(one.camera, *one.camera_covariance);
  return one.calibration_sigma.value_or(assumedCalibration(one.camera));
}

}  // namespace

InputSigmas::InputSigmas(const SessionCase& one)
    : mesh_scale(one.mesh_scale_sigma.value_or(kAssumedMeshScaleSigma)),
      calibration(calibrationOf(one)),
      mesh_scale_stated(one.mesh_scale_sigma.has_value()),
      calibration_stated(one.calibration_sigma || one.camera_covariance),
      calibration_derived(one.camera_covariance.has_value()) {}

std::string meshScaleText(const InputSigmas& sigmas) {
  return shortNumber(100.0 * sigmas.mesh_scale) + " %" + sourceText(sigmas.mesh_scale_stated);
}

std::string calibrationText(const InputSigmas& sigmas) {
  return shortNumber(100.0 * sigmas.calibration.focal_relative) + " % and " +
         shortNumber(sigmas.calibration.principal_point_px) + " px" +
         (sigmas.calibration_derived ? ", by the camera's covariance"
                                     : sourceText(sigmas.calibration_stated));
}

Session withInputSigmas(const Session& session, const std::string& case_id,
                        const std::optional<double>& mesh_scale_sigma,
                        const std::optional<CalibrationSigma>& calibration_sigma) {
  const SessionCase* chosen = session.findCase(case_id);
  if (chosen == nullptr) return session;
  Session next = session;
  for (const auto& session_case : session.cases) {
    SessionCase changed = *session_case;
    if (sameMeshes(*session_case, *chosen)) changed.mesh_scale_sigma = mesh_scale_sigma;
    if (session_case->camera == chosen->camera) changed.calibration_sigma = calibration_sigma;
    if (!(changed == *session_case)) next = withCase(next, std::move(changed));
  }
  return next;
}

}  // namespace boresight::sessions
