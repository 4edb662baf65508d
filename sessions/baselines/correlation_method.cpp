// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/correlation_method.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "sessions/baselines/gray_images.h"

namespace boresight::sessions {
namespace {

struct Correlation {
  cv::TemplateMatchModes mode = cv::TM_SQDIFF;
  bool masked = false;
  bool equalized = false;
};

/// Smallest standard deviation of a template's gray values that says where it is.
constexpr double kLeastContrast = 1.0;

/// Offset of a parabola's top from the middle of three values, where it is one.
double parabolaTop(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

class CorrelationMethod final : public MatchingMethod {
 public:
  explicit CorrelationMethod(const Correlation& settings) : settings_(settings) {}

  void begin(const std::stop_token&) override { equalized_.clear(); }

  void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) override {
    image_ = settings_.equalized ? equalized_.get(query) : matOf(query.image);
    mask_ = maskOf(query);
    render_ = settings_.equalized ? equalizedWithin(matOf(query.intensity), mask_)
                                  : matOf(query.intensity);
    const TemplateSet& templates = query.iteration.templates;
    for (std::int32_t i = 0; i < templates.count; ++i)
      found.push_back(find(query, templates.templates[static_cast<std::size_t>(i)]));
  }

 private:
  SuppliedMatch find(const MatchQuery& query, const Template& item) const {
    const int side = query.iteration.templates.side_px;
    SuppliedMatch match;
    match.item = item;
    match.window = query.windowOf(item.point_in_station_m, side);
    if (match.window.empty()) return match;
    const cv::Rect square(item.center_x - side / 2, item.center_y - side / 2, side, side);
    if (!hasContrast(square)) return match;
    const cv::Rect area(match.window.x_min - side / 2, match.window.y_min - side / 2,
                        match.window.width() + side - 1, match.window.height() + side - 1);
    cv::Mat scores = scoreMap(square, area);
    takePeak(query, scores, match);
    return match;
  }

  bool hasContrast(const cv::Rect& square) const {
    cv::Scalar mean, deviation;
    cv::meanStdDev(render_(square), mean, deviation, settings_.masked ? mask_(square) : cv::Mat());
    return deviation[0] >= kLeastContrast;
  }

  /// The higher the better, in [0, 2]; what is not finite becomes 0.
  cv::Mat scoreMap(const cv::Rect& square, const cv::Rect& area) const {
    cv::Mat scores;
    const cv::Mat mask = settings_.masked ? mask_(square).clone() : cv::Mat();
    cv::matchTemplate(image_(area), render_(square), scores, settings_.mode, mask);
    if (settings_.mode == cv::TM_SQDIFF) {
      const int compared = settings_.masked ? cv::countNonZero(mask) : square.area();
      scores.convertTo(scores, CV_32F, -2.0 / (255.0 * 255.0 * std::max(1, compared)), 2.0);
    } else {
      scores += 1.0F;
    }
    for (int y = 0; y < scores.rows; ++y) {
      float* row = scores.ptr<float>(y);
      // A correlation beyond 1 is one divided by a contrast that is rounding alone.
      for (int x = 0; x < scores.cols; ++x)
        if (!(row[x] >= 0.0F && row[x] <= 2.001F)) row[x] = 0.0F;
    }
    return scores;
  }

  static void takePeak(const MatchQuery& query, cv::Mat& scores, SuppliedMatch& match) {
    double best = 0.0;
    cv::Point at;
    cv::minMaxLoc(scores, nullptr, &best, nullptr, &at);
    if (!(best > 0.0)) return;
    match.found = true;
    match.score = best;
    match.x = match.window.x_min + at.x;
    match.y = match.window.y_min + at.y;
    const auto score = [&](int dx, int dy) {
      return static_cast<double>(scores.at<float>(at.y + dy, at.x + dx));
    };
    if (query.options.loop.subpixel_matches) {
      if (at.x > 0 && at.x + 1 < scores.cols)
        match.x += parabolaTop(score(-1, 0), best, score(1, 0));
      if (at.y > 0 && at.y + 1 < scores.rows)
        match.y += parabolaTop(score(0, -1), best, score(0, 1));
    }
    const int exclusion = query.options.loop.second_peak_exclusion_px;
    const cv::Rect around(at.x - exclusion, at.y - exclusion, 2 * exclusion + 1, 2 * exclusion + 1);
    scores(around & cv::Rect(0, 0, scores.cols, scores.rows)).setTo(0.0F);
    cv::minMaxLoc(scores, nullptr, &match.second_score);
    match.has_second = match.second_score > 0.0;
  }

  Correlation settings_;
  EqualizedImages equalized_;
  cv::Mat image_, render_, mask_;
};

}  // namespace

std::unique_ptr<MatchingMethod> makeSsd(const SsdOptions& options) {
  return std::make_unique<CorrelationMethod>(
      Correlation{cv::TM_SQDIFF, options.masked, options.equalized});
}

std::unique_ptr<MatchingMethod> makeNcc(const NccOptions& options) {
  const auto mode = options.kind == NccKind::kCcorr ? cv::TM_CCORR_NORMED : cv::TM_CCOEFF_NORMED;
  return std::make_unique<CorrelationMethod>(Correlation{mode, options.masked, options.equalized});
}

}  // namespace boresight::sessions
