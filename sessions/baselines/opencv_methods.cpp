// SPDX-License-Identifier: Apache-2.0
// Methods of OpenCV: SSD, NCC and ORB.
#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/match/whs.h"
#include "sessions/baselines/matching_methods.h"

namespace boresight::sessions {
namespace {

/// 255 where a matched part was rendered, else 0.
cv::Mat maskOf(const MatchQuery& query) {
  cv::Mat mask;
  cv::compare(matOf(query.intensity), 0, mask, cv::CMP_GT);
  // Parts that are not matched may occlude, no more.
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (!query.iteration.render.mask.get(x, y)) mask.at<std::uint8_t>(y, x) = 0;
  return mask;
}

/// Histogram equalization over the pixels of a mask alone; those outside it become 0.
cv::Mat equalizedWithin(const cv::Mat& gray, const cv::Mat& mask) {
  std::array<int, 256> below{};  // pixels of the mask at most this bright
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x)
      if (mask.at<std::uint8_t>(y, x) != 0) ++below[gray.at<std::uint8_t>(y, x)];
  for (std::size_t value = 1; value < below.size(); ++value) below[value] += below[value - 1];
  cv::Mat table(1, 256, CV_8U);
  const double scale = 255.0 / std::max(1, below[255]);
  for (int value = 0; value < 256; ++value)
    table.at<std::uint8_t>(value) =
        cv::saturate_cast<std::uint8_t>(scale * below[static_cast<std::size_t>(value)]);
  cv::Mat equalized;
  cv::LUT(gray, table, equalized);
  equalized.setTo(0, mask == 0);
  return equalized;
}

/// The level of the test image that is searched.
cv::Mat searched(const MatchQuery& query, bool equalized) {
  if (!equalized) return matOf(query.image);
  cv::Mat image;
  cv::equalizeHist(matOf(query.image), image);
  return image;
}

cv::Mat rendered(const MatchQuery& query, const cv::Mat& mask, bool equalized) {
  return equalized ? equalizedWithin(matOf(query.intensity), mask) : matOf(query.intensity);
}

struct Correlation {
  cv::TemplateMatchModes mode = cv::TM_SQDIFF;
  bool masked = false;
  bool equalized = false;
};

/// Smallest standard deviation of the gray values of a template that can be located.
constexpr double kLeastContrast = 1.0;

/// Offset of a parabola's top from the middle of three values, where it is one.
double parabolaTop(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

class CorrelationMethod final : public MatchingMethod {
 public:
  explicit CorrelationMethod(const Correlation& settings) : settings_(settings) {}

  void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) override {
    image_ = searched(query, settings_.equalized);
    mask_ = maskOf(query);
    render_ = rendered(query, mask_, settings_.equalized);
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
    // A correlation beyond 1 is one divided by a contrast that is rounding alone.
    cv::Mat valid;
    cv::inRange(scores, 0.0F, 2.001F, valid);
    scores.setTo(0.0F, valid == 0);
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
    const int exclusion = kSecondPeakExclusion_px;
    const cv::Rect around(at.x - exclusion, at.y - exclusion, 2 * exclusion + 1, 2 * exclusion + 1);
    scores(around & cv::Rect(0, 0, scores.cols, scores.rows)).setTo(0.0F);
    cv::minMaxLoc(scores, nullptr, &match.second_score);
    match.has_second = match.second_score > 0.0;
  }

  Correlation settings_;
  cv::Mat image_, render_, mask_;
};

constexpr int kPatch_px = 31;         ///< of ORB's descriptors, at their level
constexpr float kScaleFactor = 1.2F;  ///< between levels, as the authors of ORB have it
constexpr int kDescriptorBits = 256;
constexpr int kFurthest = kDescriptorBits + 1;

struct Features {
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
};

/// A feature of the render on the object, and the best of the image's features in its window.
struct Candidate {
  SuppliedMatch match;
  int feature = -1;
  int best = -1;
  int distance = kFurthest, second = kFurthest;
};

int distanceOf(const Features& one, int i, const Features& other, int j) {
  return static_cast<int>(
      cv::norm(one.descriptors.row(i), other.descriptors.row(j), cv::NORM_HAMMING));
}

class OrbMethod final : public MatchingMethod {
 public:
  explicit OrbMethod(const OrbOptions& options) : options_(options) {}

  int capacity() const override { return options_.features; }

  void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) override {
    const cv::Mat mask = maskOf(query);
    const Features shown =
        detect(rendered(query, mask, options_.equalized), mask, options_.features);
    std::vector<Candidate> candidates = candidatesOf(query, shown);
    if (candidates.empty()) return;
    const Features seen = detectInWindows(query, candidates);
    for (Candidate& one : candidates) compare(shown, seen, one);
    for (const Candidate& one : candidates) {
      if (!accepted(one, candidates)) continue;
      SuppliedMatch match = one.match;
      const cv::Point2f& at = seen.points[static_cast<std::size_t>(one.best)].pt;
      match.x = static_cast<double>(at.x);
      match.y = static_cast<double>(at.y);
      match.score = scoreOf(one.distance);
      match.has_second = one.second < kFurthest;
      if (match.has_second) match.second_score = scoreOf(one.second);
      match.found = true;
      found.push_back(match);
    }
  }

 private:
  static double scoreOf(int distance) { return 2.0 * (1.0 - distance / double(kDescriptorBits)); }

  Features detect(const cv::Mat& image, const cv::Mat& mask, int most) const {
    const auto orb = cv::ORB::create(most, kScaleFactor, options_.levels, kPatch_px / 2 + 1, 0, 2,
                                     cv::ORB::HARRIS_SCORE, kPatch_px, options_.fast_threshold);
    Features features;
    orb->detectAndCompute(image, mask, features.points, features.descriptors);
    // It may return a few more than requested.
    if (static_cast<int>(features.points.size()) > most) {
      features.points.resize(static_cast<std::size_t>(most));
      features.descriptors = features.descriptors.rowRange(0, most);
    }
    return features;
  }

  static std::vector<Candidate> candidatesOf(const MatchQuery& query, const Features& rendered) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < rendered.points.size(); ++i) {
      Candidate one;
      one.feature = static_cast<int>(i);
      const cv::Point2f& at = rendered.points[i].pt;
      if (!query.pointAt({static_cast<double>(at.x), static_cast<double>(at.y)}, one.match.item))
        continue;
      one.match.window = query.windowOf(one.match.item.point_in_station_m, 2);
      if (!one.match.window.empty()) candidates.push_back(one);
    }
    return candidates;
  }

  /// Features of the image are spent where some window is.
  Features detectInWindows(const MatchQuery& query,
                           const std::vector<Candidate>& candidates) const {
    const cv::Mat image = searched(query, options_.equalized);
    cv::Mat mask = cv::Mat::zeros(image.size(), CV_8U);
    for (const Candidate& one : candidates) {
      const SearchWindow& window = one.match.window;
      mask(cv::Rect(window.x_min, window.y_min, window.width(), window.height()) &
           cv::Rect(0, 0, mask.cols, mask.rows))
          .setTo(255);
    }
    for (int y = 0; query.ignore != nullptr && y < mask.rows; ++y)
      for (int x = 0; x < mask.cols; ++x)
        if (query.ignored(x, y)) mask.at<std::uint8_t>(y, x) = 0;
    return detect(image, mask, options_.image_features);
  }

  static void compare(const Features& rendered, const Features& seen, Candidate& one) {
    for (std::size_t j = 0; j < seen.points.size(); ++j) {
      const cv::Point2f& at = seen.points[j].pt;
      if (!one.match.window.contains(at.x, at.y)) continue;
      const int distance = distanceOf(rendered, one.feature, seen, static_cast<int>(j));
      if (distance < one.distance) {
        one.second = one.distance;
        one.distance = distance;
        one.best = static_cast<int>(j);
      } else {
        one.second = std::min(one.second, distance);
      }
    }
  }

  bool accepted(const Candidate& one, const std::vector<Candidate>& all) const {
    if (one.best < 0) return false;
    if (options_.ratio < 1.0 && one.second < kFurthest &&
        !(one.distance < options_.ratio * one.second))
      return false;
    // Of those that chose the same feature the nearest one stays, the first of equals.
    for (const Candidate& other : all) {
      if (other.best != one.best || &other == &one) continue;
      if (other.distance < one.distance || (other.distance == one.distance && &other < &one))
        return false;
    }
    return true;
  }

  OrbOptions options_;
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

std::unique_ptr<MatchingMethod> makeOrb(const OrbOptions& options) {
  return std::make_unique<OrbMethod>(options);
}

}  // namespace boresight::sessions
