// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/named_poses.h"

#include <nlohmann/json.hpp>

#include "sessions/io/json_writer.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

std::string givenText(const StationFrame& given) {
  std::string text = frameText(given.frame);
  if (const auto& join = given.joined_by)
    text += ", joined by " + join->file.string() + " (" + join->comment + ")";
  return text;
}

}  // namespace

std::vector<NamedPose> namedPoses(const std::optional<CameraReference>& camera_reference,
                                  const std::optional<StationFrame>& station_frame,
                                  const Pose& camera_from_station) {
  if (!camera_reference) return {};
  const Pose reference_from_station =
      camera_reference->camera_from_reference.inverse() * camera_from_station;
  std::vector<NamedPose> named_poses = {
      {"camera_model", camera_reference->frame, reference_from_station, ""}};
  if (!station_frame || !station_frame->joined_by) return named_poses;
  const FrameTransform& join = *station_frame->joined_by;
  const bool forward = join.target == camera_reference->frame;
  const Pose given_from_reference =
      forward ? join.target_from_source.inverse() : join.target_from_source;
  named_poses.push_back({"station", station_frame->frame,
                         given_from_reference * reference_from_station,
                         join.file.string() + ": " + join.comment});
  return named_poses;
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

std::vector<LabelItem> frameLines(const SessionCase& session_case) {
  if (!session_case.camera_reference) return {};
  const Eigen::Vector3d centre_m =
      session_case.camera_reference->camera_from_reference.inverse().translation_m;
  std::vector<LabelItem> lines = {
      {"camera model in", frameText(session_case.camera_reference->frame) + ", its centre at " +
                              fixedText(centre_m.x(), 4) + " " + fixedText(centre_m.y(), 4) + " " +
                              fixedText(centre_m.z(), 4) + " m"}};
  if (session_case.station_frame)
    lines.push_back({"station given in", givenText(*session_case.station_frame)});
  if (session_case.truth_frame)
    lines.push_back({"truth given in", givenText(*session_case.truth_frame)});
  return lines;
}

}  // namespace boresight::sessions
