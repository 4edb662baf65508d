// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rig_links.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace boresight::sessions {
namespace {

Session withRig(const Session& session, const std::string& case_id, std::optional<Rig> rig) {
  return withChanged(session, case_id,
                     [&](SessionCase& session_case) { session_case.rig = std::move(rig); });
}

/// Frames that move from image to image relative to the others, or have no name.
bool isOfOneImage(const FrameName& frame) {
  return frame.name.empty() || frame == kCameraFrame || frame == kStationFrame ||
         frame == kEndEffectorFrame;
}

/// A way over the station would be that of the seeds.
bool passesStation(const FrameChain& chain) {
  return std::any_of(chain.links.begin(), chain.links.end(),
                     [](const FrameLink& link) { return link.from() == kStationFrame; });
}

/// A rig's name that no other rig has.
std::string unusedRigId(const Session& session, const std::string& wanted) {
  std::string id = wanted;
  for (int i = 2; !session.cases.findGroup(id).empty(); ++i) id = wanted + "-" + std::to_string(i);
  return id;
}

}  // namespace

std::vector<std::string> casesOfRig(const Session& session, const std::string& case_id) {
  std::vector<std::string> ids;
  const SessionCase* chosen = session.findCase(case_id);
  if (chosen == nullptr || !chosen->rig) return ids;
  for (const auto* session_case : session.cases.findGroup(chosen->rig->id))
    if ((*session_case)->id != case_id) ids.push_back((*session_case)->id);
  return ids;
}

const RunRecord* ownRunOf(const Session& session, const std::string& other,
                          const std::string& case_id) {
  const RunRecord* last = nullptr;
  for (const RunRecord* run : session.runs.findAll(other)) {
    const auto together = run->together ? casesOf(*run->together) : std::vector<std::string>();
    if (std::ranges::find(together, case_id) == together.end()) last = run;
  }
  return last;
}

std::optional<Pose> linkOfRig(const SessionCase& session_case, const SessionCase& other) {
  if (!session_case.rig || !other.rig || session_case.rig->id != other.rig->id) return {};
  return other.rig->camera_from_rig * session_case.rig->camera_from_rig.inverse();
}

std::optional<Pose> linkOfTruths(const SessionCase& session_case, const SessionCase& other) {
  if (!session_case.camera_from_station_truth || !other.camera_from_station_truth) return {};
  return *other.camera_from_station_truth * session_case.camera_from_station_truth->inverse();
}

std::optional<FrameLinkOfCases> linkOfFrames(const SessionCase& session_case,
                                             const SessionCase& other) {
  const FrameTree own = framesOf(session_case);
  const FrameTree others = framesOf(other);
  std::optional<FrameLinkOfCases> link;
  std::size_t farthest = 0;
  for (const FrameName& frame : own.frames()) {
    if (isOfOneImage(frame)) continue;
    const auto to_own = own.chain(kCameraFrame, frame);
    const auto to_other = others.chain(kCameraFrame, frame);
    if (!to_own || !to_other || passesStation(*to_own) || passesStation(*to_other)) continue;
    if (to_own->links.size() <= farthest) continue;
    farthest = to_own->links.size();
    link = {frame, to_other->a_from_b * to_own->a_from_b.inverse()};
  }
  return link;
}

Session withRigLink(const Session& session, const std::string& case_id, const std::string& other_id,
                    const Pose& other_from_case) {
  if (session.findCase(case_id) == nullptr || session.findCase(other_id) == nullptr ||
      case_id == other_id)
    throw std::invalid_argument("withRigLink: two different cases of the session are linked");
  if (!other_from_case.isFinite())
    throw std::invalid_argument("withRigLink: the pose between the cameras is not finite");
  Session linked = withoutRigLink(session, other_id);
  if (!linked.findCase(case_id)->rig)
    linked = withRig(linked, case_id, Rig{unusedRigId(linked, case_id), Pose()});
  const Rig& rig = *linked.findCase(case_id)->rig;
  return withRig(linked, other_id, Rig{rig.id, other_from_case * rig.camera_from_rig});
}

Session withoutRigLink(const Session& session, const std::string& case_id) {
  const SessionCase* chosen = session.findCase(case_id);
  if (chosen == nullptr || !chosen->rig) return session;
  const std::vector<std::string> others = casesOfRig(session, case_id);
  Session unlinked = withRig(session, case_id, std::nullopt);
  if (others.size() == 1) unlinked = withRig(unlinked, others.front(), std::nullopt);
  return unlinked;
}

}  // namespace boresight::sessions
