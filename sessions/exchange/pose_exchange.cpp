// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/pose_exchange.h"

#include "sessions/evaluation/bop_scene.h"
#include "sessions/io/errors.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/image_names.h"

namespace boresight::sessions {
namespace {

HandedPoses requirePoses(const Session& session, const std::vector<std::string>& case_ids) {
  HandedPoses handed = handedPoses(session, case_ids);
  if (handed.poses.empty())
    throw InputError("session", "cases",
                     handed.notes.empty() ? "there is none" : handed.notes.front());
  return handed;
}

void requireHonestName(const std::filesystem::path& file, const HandedPoses& handed) {
  if (file.filename().string().find(kNotValidatedName) != std::string::npos) return;
  for (const HandedPose& pose : handed.poses)
    if (!pose.validated)
      throw InputError(file, "case '" + pose.case_id + "' is " + pose.standing +
                                 "; the format has no room to say so, so its name has to: put " +
                                 kNotValidatedName + " into it, or name the validated cases alone");
}

}  // namespace

CasePoses posesToHandOver(const Session& session, const std::vector<std::string>& case_ids) {
  const HandedPoses handed = requirePoses(session, case_ids);
  CasePoses made;
  made.notes = handed.notes;
  for (const HandedPose& pose : handed.poses)
    made.poses.push_back({pose.case_id, pose.camera_from_station});
  return made;
}

ExportReport exportBopResults(const Session& session, const std::filesystem::path& file,
                              const std::vector<std::string>& case_ids, int scene_id) {
  const HandedPoses handed = requirePoses(session, case_ids);
  requireHonestName(file, handed);
  const std::vector<int> numbers = imageNumbers(session);
  const std::vector<int> stations = stationNumbers(session);
  std::vector<BopResult> results;
  ExportReport report;
  report.notes = handed.notes;
  for (const HandedPose& pose : handed.poses) {
    std::size_t place = 0;
    while (session.cases[place]->id != pose.case_id) ++place;
    results.push_back({scene_id, numbers[place], stations[place], pose.score,
                       pose.camera_from_station, pose.seconds});
    report.case_ids.push_back(pose.case_id);
  }
  writeBopResults(file, results);
  return report;
}

}  // namespace boresight::sessions
