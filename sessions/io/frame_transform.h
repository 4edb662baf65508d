// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/camera_file.h"

namespace boresight::sessions {

/// A transform between two named frames, as an operator gave it.
struct FrameTransform {
  FrameName target;
  FrameName source;
  Pose target_from_source;
  std::string comment;  ///< where it comes from, not empty
  std::filesystem::path file;
  std::string file_sha256;

  bool operator==(const FrameTransform&) const = default;
};

/// Reads transform.json (`boresight-transform`, version 1). InputError.
FrameTransform readFrameTransform(const std::filesystem::path& file);
std::vector<FrameTransform> readFrameTransforms(const std::vector<std::string>& files);

/// The frame that a pose of the station was given in, and what joined it to the camera model's.
struct StationFrame {
  FrameName frame;
  /// None where the frame is that of the camera model.
  std::optional<FrameTransform> joined_by = std::nullopt;

  bool operator==(const StationFrame&) const = default;
};

/// The transform from frame `b` to frame `a` by one of `given` or its inverse, and which one it
/// was. InputError about `at`, naming both frames, when none leads from one to the other, or two of
/// them by different numbers: frames are never chained, nor converted by what a label says of them.
struct JoinedFrames {
  Pose a_from_b;
  std::optional<FrameTransform> by;  ///< with its file's name alone; none where the two are one
};
JoinedFrames joinFrames(const FrameName& a, const FrameName& b,
                        std::span<const FrameTransform> given, const JsonReader& at);

}  // namespace boresight::sessions
