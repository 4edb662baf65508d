// SPDX-License-Identifier: Apache-2.0
// A pose of the station in the frames that files gave by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/io/camera_file.h"
#include "sessions/io/frame_transform.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct NamedPose {
  std::string of;  ///< "camera_model", or "station": the frame that the seed was given in
  FrameName frame;
  Pose reference_from_station;  ///< of that frame
  std::string joined_by;        ///< of "station": what joined it to the camera model's frame
};

/// The pose in the camera model's frame and, where a transform joined another one to it, in that of
/// the seed; nothing for a camera without a named reference.
std::vector<NamedPose> namedPoses(const std::optional<CameraReference>& camera_reference,
                                  const std::optional<StationFrame>& station_frame,
                                  const Pose& camera_from_station);

/// {"camera_model": {"frame", "reference_from_station"}, "station": {..., "joined_by"}}.
nlohmann::ordered_json toJson(const std::vector<NamedPose>& poses);

/// "reference_from_station in SITE_FRAME (194)": what heads the pose's matrix.
std::string namedPoseTitle(const NamedPose& pose);

/// In which frames the camera model and the seed were given, and what joined the two; nothing for a
/// camera without a reference frame.
std::vector<LabelItem> frameLines(const SessionCase& session_case);

}  // namespace boresight::sessions
