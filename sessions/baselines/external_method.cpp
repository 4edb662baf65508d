// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/external_method.h"

#include <algorithm>

#include "sessions/baselines/matcher_client.h"

namespace boresight::sessions {
namespace {

/// A rectangle of both images.
struct Frame {
  int x = 0, y = 0, width = 0, height = 0;

  ImageView of(const ImageView& image) const {
    return {image.row(y) + x, width, height, image.stride};
  }
};

/// Of a matcher that does not tell its own.
constexpr int kFrameWidth_px = 640, kFrameHeight_px = 480;
/// Frames with less of the object than this share are not worth a look.
constexpr double kLeastObject = 0.02;

/// The least frame that holds all that was rendered; empty when nothing was.
Frame boundsOf(const ImageView& intensity) {
  int x_min = intensity.width, y_min = intensity.height, x_max = -1, y_max = -1;
  for (int y = 0; y < intensity.height; ++y) {
    for (int x = 0; x < intensity.width; ++x) {
      if (intensity.at(x, y) == 0) continue;
      x_min = std::min(x_min, x);
      x_max = std::max(x_max, x);
      y_min = std::min(y_min, y);
      y_max = y;
    }
  }
  return x_max < 0 ? Frame{} : Frame{x_min, y_min, x_max - x_min + 1, y_max - y_min + 1};
}

double objectShare(const ImageView& intensity) {
  std::int64_t rendered = 0;
  for (int y = 0; y < intensity.height; ++y)
    for (int x = 0; x < intensity.width; ++x) rendered += intensity.at(x, y) != 0 ? 1 : 0;
  return static_cast<double>(rendered) / (double(intensity.width) * double(intensity.height));
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

std::vector<Frame> subframes(const ImageView& intensity, int width, int height) {
  const Frame bounds = boundsOf(intensity);
  const int frame_width = std::min(width, intensity.width);
  const int frame_height = std::min(height, intensity.height);
  std::vector<Frame> frames;
  for (const int y : stretches(bounds.y, bounds.height, frame_height, intensity.height)) {
    for (const int x : stretches(bounds.x, bounds.width, frame_width, intensity.width)) {
      const Frame frame{x, y, frame_width, frame_height};
      if (objectShare(frame.of(intensity)) >= kLeastObject) frames.push_back(frame);
    }
  }
  return frames;
}

bool holds(const SearchWindow& window, double x, double y) {
  return x >= window.x_min && x <= window.x_max && y >= window.y_min && y <= window.y_max;
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
    for (const Frame& frame : framesOf(query)) {
      const std::vector<PixelPair> pairs = client_->match(
          frame.of(query.intensity), frame.of(query.image), most, options_.timeout_s, stop_);
      for (const PixelPair& pair : pairs) take(query, frame, pair, found);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    if (found.size() > static_cast<std::size_t>(most)) found.resize(static_cast<std::size_t>(most));
  }

 private:
  std::vector<Frame> framesOf(const MatchQuery& query) {
    const Iteration& iteration = query.iteration;
    if (iteration.attempt != attempt_) first_iteration_ = iteration.index;
    attempt_ = iteration.attempt;
    if (frames_ == ExternalFrames::kSubframes && iteration.index > first_iteration_) {
      const bool told = client_->width() > 0 && client_->height() > 0;
      return subframes(query.intensity, told ? client_->width() : kFrameWidth_px,
                       told ? client_->height() : kFrameHeight_px);
    }
    return {Frame{0, 0, query.intensity.width, query.intensity.height}};
  }

  static void take(const MatchQuery& query, const Frame& frame, const PixelPair& pair,
                   std::vector<SuppliedMatch>& found) {
    SuppliedMatch match;
    if (!query.pointAt({frame.x + pair.first_x, frame.y + pair.first_y}, match.item)) return;
    match.window = query.windowOf(match.item.point_in_station_m, 2);
    match.x = frame.x + pair.second_x;
    match.y = frame.y + pair.second_y;
    match.score = 2.0 * pair.score;
    match.found = true;
    if (holds(match.window, match.x, match.y)) found.push_back(match);
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
