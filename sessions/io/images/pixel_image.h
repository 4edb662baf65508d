// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "sessions/io/images/image_file.h"

namespace boresight::sessions {

/// The image of pixels in memory, 8 bits of gray or of blue, green and red; as readImage would read
/// it from a file with these pixels. Colour whose channels are equal everywhere is gray. `file` is
/// their source; its hash stays empty. InputError for a size beyond the limits.
GrayImage grayImageOf(const std::filesystem::path& file, const cv::Mat& pixels);

}  // namespace boresight::sessions
