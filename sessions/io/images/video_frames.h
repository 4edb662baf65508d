// SPDX-License-Identifier: Apache-2.0
// In a separate target (boresight_video), because OpenCV's video library loads some 60 others.
#pragma once

#include <filesystem>
#include <memory>

#include "sessions/io/images/frame_source.h"

namespace boresight::sessions {

/// Whether the name ends as that of a video (.mp4, .avi, .mkv, ...).
bool isVideoName(const std::filesystem::path& file);

/// The frames of a video, named "frame 000001", ..., by OpenCV's reader, as they are stored:
/// neither turned nor stretched as the file may state. Frames that cannot be decoded are left out.
/// The notes name both, errors that the decoder reported, and another number of frames than the
/// file states. InputError when the file is missing, or no reader of this machine's OpenCV opens
/// it.
std::unique_ptr<FrameSource> openVideo(const std::filesystem::path& file);

/// The frames of a video by isVideoName, else those of a folder or list (openImages), whose samples
/// become 8 bit by `options`. InputError.
std::unique_ptr<FrameSource> openFrames(const std::filesystem::path& images,
                                        const ImageReadOptions& options = {});

/// One frame of `openFrames`, counted from 1; empty when there are fewer. InputError.
std::optional<Frame> readFrame(const std::filesystem::path& images, std::int64_t number,
                               const ImageReadOptions& options = {});

}  // namespace boresight::sessions
