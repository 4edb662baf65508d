// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/video_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <opencv2/videoio.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/images/pixel_image.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

class Video final : public FrameSource {
 public:
  Video(const std::filesystem::path& file, cv::VideoCapture capture)
      : file_(file), capture_(std::move(capture)) {}

  std::int64_t count() const override {
    const double stated = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    return std::isfinite(stated) ? std::clamp<std::int64_t>(std::llround(stated), 0, 1 << 30) : 0;
  }

  std::optional<Frame> next() override {
    cv::Mat pixels;
    if (!capture_.read(pixels) || pixels.empty()) return std::nullopt;
    Frame frame{formatText("frame %06lld", ++last_), std::nullopt, ""};
    try {
      frame.image = grayImageOf(file_, pixels);
    } catch (const FileError& error) {
      frame.problem = error.what();
    }
    return frame;
  }

  void skip() override {
    if (capture_.grab()) ++last_;
  }

 private:
  std::filesystem::path file_;
  cv::VideoCapture capture_;
  long long last_ = 0;  ///< frames are counted from 1
};

}  // namespace

bool isVideoName(const std::filesystem::path& file) {
  constexpr std::array kEnds = {".mp4", ".m4v",  ".mov", ".avi", ".mkv",   ".webm",
                                ".mpg", ".mpeg", ".ogv", ".wmv", ".mjpeg", ".mjpg"};
  const std::string end = lowerCase(file.extension().string());
  return std::find(kEnds.begin(), kEnds.end(), end) != kEnds.end();
}

std::unique_ptr<FrameSource> openVideo(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file, "there is no such file");
  // FFmpeg would print its own words; those of the caller who set the variable are kept.
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  cv::VideoCapture capture;
  try {
    capture.open(file.string(), cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {  // as when it cannot be opened
  }
  if (!capture.isOpened())
    throw InputError(file, std::string("OpenCV ") + CV_VERSION +
                               " cannot read this video; write its frames as PNG images into a "
                               "folder, e.g. with ffmpeg, and give the folder");
  return std::make_unique<Video>(file, std::move(capture));
}

std::unique_ptr<FrameSource> openFrames(const std::filesystem::path& images,
                                        const ImageReadOptions& options) {
  return isVideoName(images) ? openVideo(images) : openImages(images, options);
}

std::optional<Frame> readFrame(const std::filesystem::path& images, std::int64_t number,
                               const ImageReadOptions& options) {
  const std::unique_ptr<FrameSource> source = openFrames(images, options);
  for (std::int64_t i = 1; i < number; ++i) source->skip();
  return source->next();
}

}  // namespace boresight::sessions
