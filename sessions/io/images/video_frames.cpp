// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/video_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <mutex>

extern "C" {
#include <libavutil/log.h>
}
#include <opencv2/videoio.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/pixel_image.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

/// Errors of FFmpeg's decoders, which conceal damage and report it in their log alone. Of all
/// videos of the process: decoders work in threads of their own.
class DecoderErrors {
 public:
  /// The number so far, and the text of the latest one.
  std::pair<std::int64_t, std::string> state() const {
    const std::lock_guard lock(mutex_);
    return {count_, latest_};
  }
  void add(std::string text) {
    const std::lock_guard lock(mutex_);
    ++count_;
    latest_ = std::move(text);
  }
  /// Receives the log, in place of the standard error, unless OpenCV's variable for it is set.
  void listen();

 private:
  mutable std::mutex mutex_;
  std::int64_t count_ = 0;
  std::string latest_;
};

DecoderErrors& decoderErrors() {
  static DecoderErrors errors;
  return errors;
}

void takeLogLine(void* context, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) return;
  std::array<char, 200> line{};
  int at_line_start = 1;
  av_log_format_line2(context, level, format, arguments, line.data(), line.size(), &at_line_start);
  std::string text = oneLine(line.data());
  while (text.starts_with('[') && text.find(']') != std::string::npos)  // the decoder's address
    text = trimmed(text.substr(text.find(']') + 1));
  decoderErrors().add(text);
}

void DecoderErrors::listen() {
  const std::lock_guard lock(mutex_);
  if (std::getenv("OPENCV_FFMPEG_LOGLEVEL") == nullptr) av_log_set_callback(takeLogLine);
}

class Video final : public FrameSource {
 public:
  Video(const std::filesystem::path& file, cv::VideoCapture capture)
      : file_(file), capture_(std::move(capture)), errors_before_(decoderErrors().state().first) {
    // Images, too, are read as they are stored: the camera is calibrated with the stored pixels.
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  }

  std::int64_t count() const override {
    const double stated = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    return std::isfinite(stated) ? std::clamp<std::int64_t>(std::llround(stated), 0, 1 << 30) : 0;
  }

  std::optional<Frame> next() override {
    cv::Mat pixels;
    if (!capture_.read(pixels) || pixels.empty()) {
      ended_ = true;
      return std::nullopt;
    }
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

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    const auto whole = [this](int property) { return std::lround(capture_.get(property)); };
    if (const long turn = whole(cv::CAP_PROP_ORIENTATION_META); turn % 360 != 0)
      notes.push_back("the video states a rotation of " + std::to_string(turn) +
                      " deg, which is not applied");
    const long wide = whole(cv::CAP_PROP_SAR_NUM), high = whole(cv::CAP_PROP_SAR_DEN);
    if (wide > 0 && high > 0 && wide != high)
      notes.push_back("the video states pixels of the shape " + std::to_string(wide) + ":" +
                      std::to_string(high) + ", which is not applied");
    if (const std::int64_t stated = count(); ended_ && stated > 0 && last_ != stated)
      notes.push_back("the video states " + countText(stated, "frame") + ", but " +
                      std::to_string(last_) + " could be read: it may be truncated or damaged");
    const auto [errors, latest] = decoderErrors().state();
    if (errors > errors_before_)
      notes.push_back("the video's decoder reports " + countText(errors - errors_before_, "error") +
                      " (" + latest + "): frames may be damaged");
    return notes;
  }

 private:
  std::filesystem::path file_;
  cv::VideoCapture capture_;
  long long last_ = 0;  ///< frames are counted from 1
  bool ended_ = false;
  std::int64_t errors_before_;
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
  noteInput(file);
  (void)readBeginning(file, 1);  // an empty file, or what a download left in its place
  decoderErrors().listen();
  cv::VideoCapture capture;
  try {
    // Of a relative name FFmpeg takes what is in front of a colon for a protocol.
    capture.open(std::filesystem::absolute(file).string(), cv::CAP_FFMPEG);
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
