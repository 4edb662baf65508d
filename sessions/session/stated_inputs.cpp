// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/stated_inputs.h"

#include "sessions/io/cameras/frame_tree.h"

namespace boresight::sessions {
namespace {

bool joinsTheSame(const FrameTransform& a, const FrameTransform& b) {
  return (a.target == b.target && a.source == b.source) ||
         (a.target == b.source && a.source == b.target);
}

void addTransform(std::vector<FrameTransform>& frames, FrameTransform transform) {
  transform.file = transform.file.filename();  // the numbers are here, so the name suffices
  std::erase_if(frames, [&transform](const FrameTransform& former) {
    return joinsTheSame(former, transform);
  });
  frames.push_back(std::move(transform));
}

}  // namespace

Session withStated(const Session& session, const std::string& case_id, const StatedInputs& stated) {
  SessionCase changed = knownCase(session, case_id);
  for (const FrameTransform& transform : stated.frames) addTransform(changed.frames, transform);
  const FrameTree tree = framesOf(changed);
  if (!stated.frames.empty())
    if (const auto chain = tree.chain(kCameraFrame, kEndEffectorFrame))
      changed.camera_from_end_effector = chain->a_from_b;
  if (stated.camera_from_end_effector)
    changed.camera_from_end_effector = stated.camera_from_end_effector;
  if (stated.requirement) changed.requirement = stated.requirement;
  return withCase(session, std::move(changed));
}

}  // namespace boresight::sessions
