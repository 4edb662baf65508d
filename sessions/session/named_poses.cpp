// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/named_poses.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/pnp/normal_equations.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// "site_from_rover.json: by hand": of all links but the camera model's.
std::string joinText(const FrameChain& chain) {
  std::string text;
  for (const FrameLink& link : chain.links) {
    if (link.transform->target == kCameraFrame && link.transform->file_sha256.empty()) continue;
    text += (text.empty() ? "" : "; ") + link.transform->file.filename().string() + ": " +
            link.transform->comment;
  }
  return text;
}

std::string givenText(const FrameName& frame, const FrameTree& tree) {
  const auto chain = tree.chain(kCameraFrame, frame);
  const std::string joined = chain ? joinText(*chain) : "";
  return frameText(frame) + (joined.empty() ? "" : ", joined by " + joined);
}

NamedPose namedPose(const FrameName& frame, const FrameChain& chain,
                    const Pose& camera_from_station, const std::optional<Matrix6d>& covariance) {
  NamedPose pose{frame, chain.a_from_b * camera_from_station, std::nullopt, joinText(chain)};
  if (!covariance) return pose;
  const Matrix6d turn = adjointOf(chain.a_from_b);
  pose.covariance = chain.covariance + turn * *covariance * turn.transpose();
  return pose;
}

}  // namespace

std::vector<NamedPose> namedPoses(const SessionCase& session_case, const Pose& camera_from_station,
                                  const std::optional<Matrix6d>& covariance) {
  std::vector<NamedPose> poses;
  const auto& reference = session_case.camera_reference;
  if (reference && reference->frame.name.empty()) {
    FrameChain chain;
    chain.a_from_b = reference->camera_from_reference.inverse();
    poses.push_back(namedPose(reference->frame, chain, camera_from_station, covariance));
  }
  const FrameTree tree = framesOf(session_case);
  for (const FrameName& frame : tree.frames()) {
    if (frame == kCameraFrame || frame == kStationFrame) continue;
    if (const auto chain = tree.chain(frame, kCameraFrame))
      poses.push_back(namedPose(frame, *chain, camera_from_station, covariance));
  }
  if (session_case.station_frame)
    std::stable_partition(poses.begin(), poses.end(), [&](const NamedPose& pose) {
      return pose.frame != *session_case.station_frame;
    });
  return poses;
}

nlohmann::ordered_json toJson(const std::vector<NamedPose>& poses) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const NamedPose& pose : poses) {
    nlohmann::ordered_json& entry = json[frameText(pose.frame)];
    entry["reference_from_station"] = toJson(pose.reference_from_station);
    if (pose.covariance) entry["covariance"] = toJson(*pose.covariance);
    if (!pose.joined_by.empty()) entry["joined_by"] = pose.joined_by;
  }
  return json;
}

std::string namedPoseTitle(const NamedPose& pose) {
  return "reference_from_station in " + frameText(pose.frame);
}

std::vector<LabelItem> frameLines(const SessionCase& session_case) {
  std::vector<LabelItem> lines;
  if (const auto& reference = session_case.camera_reference) {
    const Eigen::Vector3d centre_m = reference->camera_from_reference.inverse().translation_m;
    lines.push_back({"camera model in", frameText(reference->frame) + ", its centre at " +
                                            fixedText(centre_m.x(), 4) + " " +
                                            fixedText(centre_m.y(), 4) + " " +
                                            fixedText(centre_m.z(), 4) + " m"});
  }
  const FrameTree tree = framesOf(session_case);
  if (session_case.station_frame)
    lines.push_back({"station given in", givenText(*session_case.station_frame, tree)});
  if (session_case.truth_frame)
    lines.push_back({"truth given in", givenText(*session_case.truth_frame, tree)});
  return lines;
}

}  // namespace boresight::sessions
