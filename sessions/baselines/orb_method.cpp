// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/orb_method.h"

#include <algorithm>

#include <opencv2/features2d.hpp>

#include "sessions/baselines/gray_images.h"

namespace boresight::sessions {
namespace {

constexpr int kPatch_px = 31;  ///< of ORB's descriptors, at their level
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

bool holds(const SearchWindow& window, const cv::Point2f& point) {
  return point.x >= static_cast<float>(window.x_min) &&
         point.x <= static_cast<float>(window.x_max) &&
         point.y >= static_cast<float>(window.y_min) && point.y <= static_cast<float>(window.y_max);
}

int distanceOf(const Features& one, int i, const Features& other, int j) {
  return static_cast<int>(
      cv::norm(one.descriptors.row(i), other.descriptors.row(j), cv::NORM_HAMMING));
}

class OrbMethod final : public MatchingMethod {
 public:
  explicit OrbMethod(const OrbOptions& options) : options_(options) {}

  void begin(const std::stop_token&) override { equalized_.clear(); }
  int capacity() const override { return options_.features; }

  void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) override {
    const cv::Mat mask = maskOf(query);
    const cv::Mat render =
        options_.equalized ? equalizedWithin(matOf(query.intensity), mask) : matOf(query.intensity);
    const Features rendered = detect(render, mask, options_.features);
    std::vector<Candidate> candidates = candidatesOf(query, rendered);
    if (candidates.empty()) return;
    const Features seen = detectInWindows(query, candidates);
    for (Candidate& one : candidates) compare(rendered, seen, one);
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
    const auto orb = cv::ORB::create(most, static_cast<float>(options_.scale_factor),
                                     options_.levels, kPatch_px / 2 + 1, 0, 2,
                                     cv::ORB::HARRIS_SCORE, kPatch_px, options_.fast_threshold);
    Features features;
    orb->detectAndCompute(image, mask, features.points, features.descriptors);
    // It may give a few more than it was asked for.
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
  Features detectInWindows(const MatchQuery& query, const std::vector<Candidate>& candidates) {
    const cv::Mat image = options_.equalized ? equalized_.get(query) : matOf(query.image);
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
      if (!holds(one.match.window, seen.points[j].pt)) continue;
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
    if (!options_.unique) return true;
    // Of those that chose the same feature the nearest one stays, the first of equals.
    for (const Candidate& other : all) {
      if (other.best != one.best || &other == &one) continue;
      if (other.distance < one.distance || (other.distance == one.distance && &other < &one))
        return false;
    }
    return true;
  }

  OrbOptions options_;
  EqualizedImages equalized_;
};

}  // namespace

std::unique_ptr<MatchingMethod> makeOrb(const OrbOptions& options) {
  return std::make_unique<OrbMethod>(options);
}

}  // namespace boresight::sessions
