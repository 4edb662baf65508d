// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/io/cameras/frame_transform.h"

namespace boresight::test {

inline sessions::FrameTransform joining(const sessions::FrameName& target,
                                        const sessions::FrameName& source, const Pose& pose,
                                        const char* file = "frames.json") {
  return {target, source, pose, std::nullopt, {}, "by hand", file, ""};
}

}  // namespace boresight::test
