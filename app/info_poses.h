// SPDX-License-Identifier: Apache-2.0
// What `whs info` says of files that hold poses.
#pragma once

#include <filesystem>

#include "sessions/io/frame_transform.h"
#include "sessions/io/json_reader.h"

namespace boresight::app {

/// pose.json, in the camera's frame or in a named one.
void describePoseFile(const std::filesystem::path& file, const sessions::JsonReader& root);
void describeTransform(const sessions::FrameTransform& transform);
/// validated_pose.json: what it states; `whs verify` asks whether that is so.
void describeValidatedPose(const sessions::JsonReader& root);
/// rig.json, with the cameras and points that it names.
void describeRig(const std::filesystem::path& file);

}  // namespace boresight::app
