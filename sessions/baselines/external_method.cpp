// SPDX-License-Identifier: Apache-2.0
// External matchers.
#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "sessions/baselines/matcher_client.h"
#include "sessions/baselines/matching_methods.h"

namespace boresight::sessions {
namespace {

/// For a matcher that does not announce a size.
constexpr int kFrameWidth_px = 640, kFrameHeight_px = 480;
/// Frames with a smaller share of the object are left out.
constexpr double kLeastObject = 0.02;

/// The part of an image in a rectangle.
ImageView partOf(const ImageView& image, const cv::Rect& frame) {
  return {image.row(frame.y) + frame.x, frame.width, frame.height, image.stride};
}

/// Beginnings of the fewest stretches of `length` that cover `begin` ... `begin + extent - 1`,
/// spread evenly about it, all inside 0 ... `size` - 1.
std::vector<int> stretches(int begin, int extent, int length, int size) {
  const int count = (extent + length - 1) / length;
  const int slack = count * length - extent;
  std::vector<int> starts;
  for (int i = 0; i < count; ++i) {
    const int start = begin - slack / 2 + i * length;
    starts.push_back(std::clamp(start, 0, std::max(0, size - length)));
  }
  return starts;
}

/// Frames of the size, or of the image where that is smaller, that cover all that was rendered.
std::vector<cv::Rect> subframes(const cv::Mat& intensity, int width, int height) {
  const cv::Rect bounds = cv::boundingRect(intensity);
  const cv::Size size(std::min(width, intensity.cols), std::min(height, intensity.rows));
  std::vector<cv::Rect> frames;
  for (const int y : stretches(bounds.y, bounds.height, size.height, intensity.rows))
    for (const int x : stretches(bounds.x, bounds.width, size.width, intensity.cols)) {
      const cv::Rect frame(x, y, size.width, size.height);
      if (cv::countNonZero(intensity(frame)) >= kLeastObject * frame.area())
        frames.push_back(frame);
    }
  return frames;
}

class ExternalMethod final : public MatchingMethod {
 public:
  ExternalMethod(const std::string& command, const ExternalOptions& options, ExternalFrames frames)
      : command_(command), options_(options), frames_(frames) {}

  int capacity() const override { return options_.matches; }

  void begin(const std::stop_token& stop) override {
    stop_ = stop;
    attempt_ = -1;
    if (!client_)
      client_ = std::make_unique<MatcherClient>(command_, options_.start_timeout_s, stop_);
  }

  void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) override {
    const int most = query.options.templates.count;
    for (const cv::Rect& frame : framesOf(query)) {
      const std::vector<PixelPair> pairs =
          client_->match(partOf(query.intensity, frame), partOf(query.image, frame), most,
                         options_.timeout_s, stop_);
      for (const PixelPair& pair : pairs) take(query, frame, pair, found);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    if (found.size() > static_cast<std::size_t>(most)) found.resize(static_cast<std::size_t>(most));
  }

 private:
  std::vector<cv::Rect> framesOf(const MatchQuery& query) {
    const Iteration& iteration = query.iteration;
    if (iteration.attempt != attempt_) first_iteration_ = iteration.index;
    attempt_ = iteration.attempt;
    if (frames_ == ExternalFrames::kSubframes && iteration.index > first_iteration_) {
      const bool told = client_->width() > 0 && client_->height() > 0;
      return subframes(matOf(query.intensity), told ? client_->width() : kFrameWidth_px,
                       told ? client_->height() : kFrameHeight_px);
    }
    return {cv::Rect(0, 0, query.intensity.width, query.intensity.height)};
  }

  static void take(const MatchQuery& query, const cv::Rect& frame, const PixelPair& pair,
                   std::vector<SuppliedMatch>& found) {
    SuppliedMatch match;
    if (!query.pointAt({frame.x + pair.first_x, frame.y + pair.first_y}, match.item)) return;
    match.window = query.windowOf(match.item.point_in_station_m, 2);
    match.x = frame.x + pair.second_x;
    match.y = frame.y + pair.second_y;
    match.score = 2.0 * pair.score;
    match.found = true;
    if (match.window.contains(match.x, match.y)) found.push_back(match);
  }

  std::string command_;
  ExternalOptions options_;
  ExternalFrames frames_;
  std::unique_ptr<MatcherClient> client_;
  std::stop_token stop_;
  int attempt_ = -1;
  int first_iteration_ = 0;
};

}  // namespace

std::unique_ptr<MatchingMethod> makeExternal(const std::string& command,
                                             const ExternalOptions& options,
                                             ExternalFrames frames) {
  return std::make_unique<ExternalMethod>(command, options, frames);
}

}  // namespace boresight::sessions
