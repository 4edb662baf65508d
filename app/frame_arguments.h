// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/commands.h"
#include "sessions/io/pose_file.h"

namespace boresight::app {

/// --transform: what joins the frame of a pose to that of a camera model.
struct FrameArguments {
  std::vector<std::string> files;

  void addTo(CLI::App& command);
  /// InputError.
  sessions::PoseFrames of(const sessions::CameraFile& camera) const;
};

/// What --camera takes, for its help.
inline constexpr const char* kCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model";
/// The same where the image's own label does without it.
inline constexpr const char* kOwnCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model; without it the "
    "label of the image itself";

}  // namespace boresight::app
