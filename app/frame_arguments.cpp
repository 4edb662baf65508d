// SPDX-License-Identifier: Apache-2.0
#include "app/frame_arguments.h"

namespace boresight::app {

void FrameArguments::addTo(CLI::App& command) {
  command
      .add_option("--transform", files,
                  "transform.json between the frame that a pose names and that of the camera "
                  "model; may be repeated")
      ->type_name("FILE");
}

sessions::PoseFrames FrameArguments::of(const sessions::CameraFile& camera) const {
  return {camera.reference, sessions::readFrameTransforms(files)};
}

}  // namespace boresight::app
