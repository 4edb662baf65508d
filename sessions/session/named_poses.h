// SPDX-License-Identifier: Apache-2.0
// A pose of the station in the frames that files name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct NamedPose {
  FrameName frame;
  Pose reference_from_station;  ///< of that frame
  /// Left perturbation in that frame; empty: not given.
  std::optional<Matrix6d> covariance = std::nullopt;
  std::string joined_by;  ///< the transforms between the frame and the camera model
};

/// The pose in every frame that is joined to the camera, that of the seed last; empty for a case
/// without frames. `covariance`: of the pose, left perturbation in the camera frame; the
/// transforms' covariances are added to it.
std::vector<NamedPose> namedPoses(const SessionCase& session_case, const Pose& camera_from_station,
                                  const std::optional<Matrix6d>& covariance = std::nullopt);

/// By the frame's text: {"reference_from_station", "covariance", "joined_by"}.
nlohmann::ordered_json toJson(const std::vector<NamedPose>& poses);

/// "reference_from_station in SITE_FRAME (194)": title of the pose's matrix.
std::string namedPoseTitle(const NamedPose& pose);

/// Frames of camera model, seed and truth, and how these are joined; empty for a case without
/// frames.
std::vector<LabelItem> frameLines(const SessionCase& session_case);

}  // namespace boresight::sessions
