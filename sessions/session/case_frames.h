// SPDX-License-Identifier: Apache-2.0
// Transforms between the frames of a case, and the values of the case that come from them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sessions/io/cameras/pose_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The seed that the chain between CAMERA and STATION is, three sigma of it the uncertainty. Empty
/// when the frames do not join these.
std::optional<PoseFile> seedOfFrames(const FrameTree& frames);

/// Adds the frames of the image's label that no transform joins yet. InputError.
void addLabelFrames(const std::filesystem::path& image,
                    const std::optional<CameraReference>& reference,
                    std::vector<FrameTransform>& transforms);

/// Takes from the frames and the camera's reference of `changed` what `former` has from its own: a
/// seed or truth that was given in a named frame keeps its pose in that frame; a seed that is the
/// chain between CAMERA and STATION, and the end effector, are read from the chain again. Values
/// that were stated apart from the frames stay. InputError when the frame of a seed or truth is no
/// longer joined to the camera.
void followFrames(const SessionCase& former, SessionCase& changed);

/// The session with `changed` for its case of that id after followFrames(). Poses between the case
/// and other cameras of its rig that come from frames are taken from them again; poses that were
/// stated apart stay, as does the identity of a camera that did not move. InputError as there, when
/// the frames no longer state such a pose, and when there is no such case.
Session withChangedFrames(const Session& session, SessionCase changed);

/// The session withChangedFrames(): these transforms of a case. InputError as there, and for a
/// loop.
Session withFrames(const Session& session, const std::string& case_id,
                   std::vector<FrameTransform> frames);

}  // namespace boresight::sessions
