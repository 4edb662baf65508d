// SPDX-License-Identifier: Apache-2.0
#include "app/info_poses.h"

#include "sessions/annotation/marks_file.h"
#include "sessions/io/pose_file.h"
#include "sessions/run/run_text.h"

namespace boresight::app {
namespace {

using std::filesystem::path;

void printPose(const Pose& pose, const char* name) {
  std::cout << sessions::poseText(pose, Matrix6d::Zero(), name);
}

/// What stands in a file beside the pose, in whatever frame that is.
void describeSeed(const sessions::PoseFile& pose) {
  if (pose.uncertainty)
    line("uncertainty " + vectorText(pose.uncertainty->translation_m, 4) + " m, " +
         vectorText(pose.uncertainty->rotation_deg, 2) + " deg about the " +
         (pose.uncertainty->pivot == sessions::UncertaintyPivot::kStation ? "station" : "camera") +
         ", along and about the camera's axes");
  const std::string projected = sessions::projectionNote(pose.rotation_deviation);
  if (!projected.empty()) flag(projected);
}

void describeCameraPose(const sessions::PoseFile& pose) {
  printPose(pose.camera_from_station, "camera_from_station");
  const Eigen::Vector3d camera_in_station_m = pose.camera_from_station.inverse().translation_m;
  line("camera centre in the station frame " + vectorText(camera_in_station_m, 4) + " m");
  describeSeed(pose);
  if (pose.camera_from_station.translation_m.z() <= 0.0)
    flag("the station's origin lies behind the camera");
}

/// A pose in the frame of a camera model, which this file alone does not place in the camera.
void describeReferencePose(const path& file, const sessions::JsonReader& root) {
  sessions::CameraReference there;
  if (const auto frame = root.find("reference_frame"))
    there.frame = sessions::readFrameName(*frame);
  line("reference_from_station in " +
       (there.frame.name.empty() ? "the frame of the camera model" : frameText(there.frame)));
  const sessions::PoseFile pose = sessions::readPose(file, {there, {}});
  printPose(pose.camera_from_station, "reference_from_station");
  describeSeed(pose);
}

}  // namespace

void describePoseFile(const path& file, const sessions::JsonReader& root) {
  if (root.has("reference_from_station") && !root.has("camera_from_station"))
    describeReferencePose(file, root);
  else
    describeCameraPose(sessions::readPose(file));
}

void describeTransform(const sessions::FrameTransform& transform) {
  line("from " + frameText(transform.source) + " to " + frameText(transform.target) + ": " +
       transform.comment);
  printPose(transform.target_from_source, "target_from_source");
}

void describeValidatedPose(const sessions::JsonReader& root) {
  line("case " + root.at("case").text() + ": " + root.at("standing").text());
  printPose(sessions::readTransform(root.at("pose").at("camera_from_station")),
            "camera_from_station");
  if (const auto frames = root.find("frames"))
    for (const char* name : {"camera_model", "station"})
      if (const auto frame = frames->find(name)) {
        line("in " + frame->at("frame").text());
        printPose(sessions::readTransform(frame->at("reference_from_station")),
                  "reference_from_station");
      }
  line("whs verify checks it against its signature and its inputs");
}

void describeRig(const path& file) {
  for (const sessions::MarkedView& view : sessions::readRig(file)) {
    line("view " + view.name + ": camera of " + std::to_string(view.camera.width) + " x " +
         std::to_string(view.camera.height) + " px, " +
         countText(view.marks.points.size(), "point") + ", " +
         countText(view.marks.lines.size(), "line"));
    printPose(view.camera_from_rig, "camera_from_rig");
  }
}

}  // namespace boresight::app
