// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/named_poses.h"

#include <nlohmann/json.hpp>

#include "sessions/io/json_writer.h"

namespace boresight::sessions {

std::vector<NamedPose> namedPoses(const std::optional<CameraReference>& camera_reference,
                                  const std::optional<StationFrame>& station_frame,
                                  const Pose& camera_from_station) {
  if (!camera_reference) return {};
  const Pose reference_from_station =
      camera_reference->camera_from_reference.inverse() * camera_from_station;
  std::vector<NamedPose> made = {
      {"camera_model", camera_reference->frame, reference_from_station, ""}};
  if (!station_frame || !station_frame->joined_by) return made;
  const FrameTransform& join = *station_frame->joined_by;
  const bool forward = sameFrame(join.target, camera_reference->frame);
  const Pose given_from_reference =
      forward ? join.target_from_source.inverse() : join.target_from_source;
  made.push_back({"station", station_frame->frame, given_from_reference * reference_from_station,
                  join.file.string() + ": " + join.comment});
  return made;
}

nlohmann::ordered_json toJson(const std::vector<NamedPose>& poses) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const NamedPose& pose : poses) {
    json[pose.of] = {{"frame", frameText(pose.frame)},
                     {"reference_from_station", toJson(pose.reference_from_station)}};
    if (!pose.joined_by.empty()) json[pose.of]["joined_by"] = pose.joined_by;
  }
  return json;
}

std::string namedPoseTitle(const NamedPose& pose) {
  return "reference_from_station in " + frameText(pose.frame);
}

}  // namespace boresight::sessions
