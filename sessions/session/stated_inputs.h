// SPDX-License-Identifier: Apache-2.0
// Inputs that the operator states for an existing case, and the sigmas that are assumed otherwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// End effector, requirement, symmetries and frames of a case. Members without a value change
/// nothing.
struct StatedInputs {
  std::optional<Pose> camera_from_end_effector;
  std::optional<Requirement> requirement;
  std::optional<Symmetries> symmetries;  ///< empty ones: the station has none
  /// Added; replaces a transform between the same two frames.
  std::vector<FrameTransform> frames;

  bool empty() const {
    return !camera_from_end_effector && !requirement && !symmetries && frames.empty();
  }
};

/// The same session with these inputs of a case. Transforms that change the chain of CAMERA and
/// END_EFFECTOR give the end effector, unless it is stated, too. Poses that come from the frames
/// follow the new ones (withFrames). InputError as there.
Session withStated(const Session& session, const std::string& case_id, const StatedInputs& stated);

/// One sigma of each as used: from the camera's covariance, stated, or else assumed.
struct InputSigmas {
  double mesh_scale = kAssumedMeshScaleSigma;  ///< relative
  CalibrationSigma calibration;
  bool mesh_scale_stated = false;
  StatedCalibration stated;          ///< of `calibration`; also by the camera's covariance
  bool calibration_derived = false;  ///< from the camera's covariance, which is used instead

  explicit InputSigmas(const SessionCase& session_case);
};
/// "0.02 %, assumed".
std::string meshScaleText(const InputSigmas& sigmas);
/// "0.02 % and 0.5 px, assumed", "..., by the camera's covariance", "0.1 % and 0.5 px (assumed)".
std::string calibrationText(const InputSigmas& sigmas);
/// Where it comes from: "stated", "assumed", "of the camera's covariance", or by member.
std::string calibrationOrigin(const InputSigmas& sigmas);

/// The same session with these sigmas stated for this case (empty: assumed). A member that changes
/// is also written to the other cases: the mesh's to those of the same parts, the camera's to those
/// of the same camera.
Session withInputSigmas(const Session& session, const std::string& case_id,
                        const std::optional<double>& mesh_scale_sigma,
                        const std::optional<StatedCalibration>& calibration_sigma);

/// The same session with these symmetries of a case, and of the other cases of the same parts where
/// they change.
Session withSymmetries(const Session& session, const std::string& case_id,
                       const Symmetries& symmetries);

}  // namespace boresight::sessions
