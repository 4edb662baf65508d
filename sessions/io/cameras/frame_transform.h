// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// Source of a transform's numbers.
enum class TransformSource { kUnstated, kTelemetry, kCalibration, kLabel, kCommanded };
inline constexpr const char* kTransformSourceNames[] = {"unstated", "telemetry", "calibration",
                                                        "label", "commanded"};

/// Largest number of transforms of a case, in all its files: a rover has some dozens of frames.
inline constexpr std::size_t kMostFrameTransforms = 200;

/// A transform between two named frames.
struct FrameTransform {
  FrameName target;
  FrameName source;
  Pose target_from_source;
  /// Over (rotation rad, translation m), left perturbation, target frame; empty: exact.
  std::optional<Matrix6d> covariance = std::nullopt;
  TransformSource origin = TransformSource::kUnstated;
  std::string comment;  ///< source, not empty; by default the name of its file
  std::filesystem::path file;
  std::string file_sha256;

  bool operator==(const FrameTransform&) const = default;
};

/// Reads a file with one transform (`boresight-transform`, version 1) or with several
/// (`boresight-frames`, version 1; sessions/io/cameras/cameras.md). InputError.
std::vector<FrameTransform> readFrameTransforms(const std::filesystem::path& file);
std::vector<FrameTransform> readFrameTransforms(const std::vector<std::string>& files);

/// Writes one transform as `boresight-transform`. OutputError when the file cannot be written.
void writeFrameTransform(const std::filesystem::path& file, const FrameTransform& transform);

}  // namespace boresight::sessions
