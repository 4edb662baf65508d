// SPDX-License-Identifier: Apache-2.0
// Cases of a session whose cameras are rigidly linked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Ids of the other cases of a case's rig, in the order of the session.
std::vector<std::string> casesOfRig(const Session& session, const std::string& case_id);

/// The last run of `other` that was not solved together with `case_id`: poses solved together
/// always agree. nullptr when there is none.
const RunRecord* ownRunOf(const Session& session, const std::string& other,
                          const std::string& case_id);

/// The transform other_from_case between two cases' cameras by their rig. Empty when they are not
/// in one rig.
std::optional<Pose> linkOfRig(const SessionCase& session_case, const SessionCase& other);

/// The same from the true poses of both; empty when one of them has none.
std::optional<Pose> linkOfTruths(const SessionCase& session_case, const SessionCase& other);

/// A link, and the frame that both cases join with their cameras.
struct FrameLinkOfCases {
  FrameName frame;
  Pose other_from_case;
};

/// The same by the named frame, farthest from the camera, that image labels, telemetry of an arm or
/// calibrations join with both cameras, on paths that do not pass the station. Empty when there is
/// none.
std::optional<FrameLinkOfCases> linkOfFrames(const SessionCase& session_case,
                                             const SessionCase& other);

/// The same session with `other_id` linked to the rig of `case_id`; a case without one becomes the
/// reference of a new rig that has its name. `other_from_case` maps points of the case's camera
/// frame into the other's: the identity for a second image by a camera that did not move. Any
/// former link of the other case is dropped. std::invalid_argument when a case does not exist, both
/// are the same, or the pose is not finite.
Session withRigLink(const Session& session, const std::string& case_id, const std::string& other_id,
                    const Pose& other_from_case);

/// The same session with this case linked to no other; a rig of one case that remains is dissolved.
Session withoutRigLink(const Session& session, const std::string& case_id);

}  // namespace boresight::sessions
