// SPDX-License-Identifier: Apache-2.0
// Inputs that the operator states for an existing case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// End effector, requirement and frames of a case. Members without a value change nothing.
struct StatedInputs {
  std::optional<Pose> camera_from_end_effector;
  std::optional<Requirement> requirement;
  /// Added; replaces a transform between the same two frames.
  std::vector<FrameTransform> frames;

  bool empty() const { return !camera_from_end_effector && !requirement && frames.empty(); }
};

/// The same session with these inputs of a case. Transforms that join CAMERA and END_EFFECTOR
/// give the end effector where it is not stated itself. InputError when there is no such case, and
/// when a transform closes a loop.
Session withStated(const Session& session, const std::string& case_id, const StatedInputs& stated);

}  // namespace boresight::sessions
