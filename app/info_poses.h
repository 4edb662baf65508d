// SPDX-License-Identifier: Apache-2.0
// How `whs info` writes what it finds.
// What `whs info` says of files that hold poses.
#pragma once

#include <filesystem>
#include <iostream>
#include <string>

#include <Eigen/Core>

#include "sessions/io/frame_transform.h"
#include "sessions/io/json_reader.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {

inline void line(const std::string& text) { std::cout << sessions::plainLine("  " + text); }
inline void flag(const std::string& text) { line("! " + text); }

inline std::string vectorText(const Eigen::Vector3d& vector, int decimals) {
  using sessions::fixedText;
  return fixedText(vector.x(), decimals) + " " + fixedText(vector.y(), decimals) + " " +
         fixedText(vector.z(), decimals);
}

/// "1 case", "2 cases".
inline std::string countText(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

/// pose.json, in the camera's frame or in a named one.
void describePoseFile(const std::filesystem::path& file, const sessions::JsonReader& root);
void describeTransform(const sessions::FrameTransform& transform);
/// validated_pose.json: what it states; `whs verify` asks whether that is so.
void describeValidatedPose(const sessions::JsonReader& root);
/// rig.json, with the cameras and points that it names.
void describeRig(const std::filesystem::path& file);

}  // namespace boresight::app
