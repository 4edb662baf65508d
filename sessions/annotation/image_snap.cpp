// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/image_snap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace boresight::sessions {
namespace {

constexpr double kSmoothing_px = 1.0;
constexpr double kLeastContrast = 3.0;  ///< gray levels per pixel
constexpr int kDirections = 120;
constexpr double kRayStep_px = 0.25;
constexpr double kSmallestEllipse_px = 2.0;
constexpr double kLeastSupport = 0.6;
constexpr double kOnEllipse_px = 1.0;
constexpr double kLeastDirections = 0.15;  ///< of a corner; a disc of 8 px has 0.06

/// A piece of the image about a place, smoothed, and its gradient. Coordinates are the image's.
class Patch {
 public:
  Patch(const ImageView& image, const Eigen::Vector2d& about, double radius_px) {
    const int margin = static_cast<int>(std::ceil(radius_px)) + 6;
    const int x = static_cast<int>(std::floor(about.x() + 0.5));
    const int y = static_cast<int>(std::floor(about.y() + 0.5));
    const cv::Mat whole(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.data),
                        static_cast<std::size_t>(image.stride));
    const cv::Rect area = cv::Rect(x - margin, y - margin, 2 * margin + 1, 2 * margin + 1) &
                          cv::Rect(0, 0, image.width, image.height);
    if (area.width < 5 || area.height < 5) return;
    origin_ = {area.x, area.y};
    whole(area).convertTo(gray_, CV_32F);
    cv::Mat smooth;
    cv::GaussianBlur(gray_, smooth, cv::Size(), kSmoothing_px, kSmoothing_px, cv::BORDER_REPLICATE);
    // Central differences of the smoothed image.
    cv::Sobel(smooth, gradient_x_, CV_32F, 1, 0, 1, 0.5, 0.0, cv::BORDER_REPLICATE);
    cv::Sobel(smooth, gradient_y_, CV_32F, 0, 1, 1, 0.5, 0.0, cv::BORDER_REPLICATE);
  }

  bool empty() const { return gray_.empty(); }
  const cv::Mat& gray() const { return gray_; }
  Eigen::Vector2d origin() const { return origin_; }

  bool contains(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d at = pixel - origin_;
    return at.minCoeff() >= 0.0 && at.x() <= gray_.cols - 1.0 && at.y() <= gray_.rows - 1.0;
  }

  /// Bilinear.
  Eigen::Vector2d gradient(const Eigen::Vector2d& pixel) const {
    return {sample(gradient_x_, pixel - origin_), sample(gradient_y_, pixel - origin_)};
  }

 private:
  static double sample(const cv::Mat& values, const Eigen::Vector2d& at) {
    const int x = std::clamp(static_cast<int>(std::floor(at.x())), 0, values.cols - 2);
    const int y = std::clamp(static_cast<int>(std::floor(at.y())), 0, values.rows - 2);
    const double u = at.x() - x;
    const double v = at.y() - y;
    const auto value = [&](int dx, int dy) {
      return static_cast<double>(values.at<float>(y + dy, x + dx));
    };
    return (1.0 - v) * ((1.0 - u) * value(0, 0) + u * value(1, 0)) +
           v * ((1.0 - u) * value(0, 1) + u * value(1, 1));
  }

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  cv::Mat gray_;
  cv::Mat gradient_x_;
  cv::Mat gradient_y_;
};

/// Top of the parabola through three values a step apart, in steps from the middle one.
double parabolaTop(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

/// Walks along `direction` to where the gradient along it is largest; nothing on the way up.
std::optional<EdgeSnap> climb(const Patch& patch, const Eigen::Vector2d& start) {
  Eigen::Vector2d at = start;
  for (int step = 0; step < 30; ++step) {
    if (!patch.contains(at)) return {};
    const Eigen::Vector2d gradient = patch.gradient(at);
    const double contrast = gradient.norm();
    if (contrast < kLeastContrast) return {};
    const Eigen::Vector2d normal = gradient / contrast;
    const auto across = [&](double offset) {
      return patch.gradient(at + offset * normal).dot(normal);
    };
    const double before = across(-1.0);
    const double after = across(1.0);
    const double middle = across(0.0);
    if (middle >= before && middle >= after) {
      // About its own top a symmetric profile has no bias.
      double top = 0.0;
      for (int round = 0; round < 4; ++round)
        top += parabolaTop(across(top - 1.0), across(top), across(top + 1.0));
      return EdgeSnap{at + top * normal, normal, contrast};
    }
    at += (after > before ? 0.5 : -0.5) * normal;
  }
  return {};
}

/// How much of the gradient about a place goes the second way: 0 on a straight edge, 1 where two
/// edges meet at right angles (ratio of the structure tensor's eigenvalues).
double directions(const Patch& patch, const Eigen::Vector2d& about) {
  constexpr int kHalf = 4;
  Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
  for (int y = -kHalf; y <= kHalf; ++y)
    for (int x = -kHalf; x <= kHalf; ++x) {
      const Eigen::Vector2d at = about + Eigen::Vector2d(x, y);
      if (!patch.contains(at)) continue;
      const Eigen::Vector2d gradient = patch.gradient(at);
      tensor += gradient * gradient.transpose();
    }
  const double mean = 0.5 * tensor.trace();
  const double spread = std::sqrt(std::max(0.0, mean * mean - tensor.determinant()));
  return mean + spread > 0.0 ? (mean - spread) / (mean + spread) : 0.0;
}

/// Farthest steep place inward of which nothing steeper lies: the first maximum of the gradient
/// along a ray whose contrast is at least half of the ray's best.
std::optional<Eigen::Vector2d> edgeOnRay(const Patch& patch, const Eigen::Vector2d& from,
                                         const Eigen::Vector2d& direction, double radius_px) {
  std::vector<double> along;
  for (double s = 0.0; s <= radius_px; s += kRayStep_px) {
    const Eigen::Vector2d at = from + s * direction;
    if (!patch.contains(at)) break;
    along.push_back(std::abs(patch.gradient(at).dot(direction)));
  }
  if (along.size() < 3) return {};
  const double best = *std::max_element(along.begin(), along.end());
  if (best < kLeastContrast) return {};
  for (std::size_t i = 1; i + 1 < along.size(); ++i) {
    if (along[i] < 0.5 * best || along[i] < along[i - 1] || along[i] < along[i + 1]) continue;
    const double s =
        kRayStep_px * (static_cast<double>(i) + parabolaTop(along[i - 1], along[i], along[i + 1]));
    return from + s * direction;
  }
  return {};
}

/// Distance from an ellipse to first order: (|q| - 1) along its normal, q in units of its axes.
double distanceFrom(const cv::RotatedRect& ellipse, const cv::Point2f& point) {
  const double angle = ellipse.angle * std::numbers::pi / 180.0;
  const Eigen::Vector2d offset(point.x - ellipse.center.x, point.y - ellipse.center.y);
  const Eigen::Vector2d half(0.5 * ellipse.size.width, 0.5 * ellipse.size.height);
  const Eigen::Vector2d in_axes(std::cos(angle) * offset.x() + std::sin(angle) * offset.y(),
                                -std::sin(angle) * offset.x() + std::cos(angle) * offset.y());
  const Eigen::Vector2d unit = in_axes.cwiseQuotient(half);
  const double value = unit.squaredNorm() - 1.0;
  return value / (2.0 * unit.cwiseQuotient(half)).norm();
}

/// Fits again and again to what agrees with the fit.
std::optional<cv::RotatedRect> fitEllipse(std::vector<cv::Point2f>& points) {
  double limit_px = 8.0;
  std::vector<cv::Point2f> kept = points;
  for (int round = 0; round < 8; ++round) {
    if (kept.size() < 6) return {};
    const cv::RotatedRect ellipse = cv::fitEllipse(kept);
    if (!(ellipse.size.width > 0.0f) || !(ellipse.size.height > 0.0f)) return {};
    if (round == 7) {
      points = kept;
      return ellipse;
    }
    limit_px = std::max(kOnEllipse_px, 0.6 * limit_px);
    kept.clear();
    for (const cv::Point2f& point : points)
      if (std::abs(distanceFrom(ellipse, point)) < limit_px) kept.push_back(point);
  }
  return {};
}

constexpr double kEdgeHandicap = 0.5;  ///< of the radius
/// An ellipse that is seen nearly all round is no accident: corners near its centre (the slot of a
/// screw) come after it.
constexpr double kSureSupport = 0.85;
constexpr double kCornersEdge_px = 3.0;  ///< how far a corner's edges lie from it
constexpr double kFaint = 0.5;           ///< of the contrast

double handicap_px(const ImageSnap& snap, double radius_px) {
  if (snap.kind == ImageSnapKind::kEdge) return kEdgeHandicap * radius_px;
  if (snap.kind != ImageSnapKind::kEllipse) return 0.0;
  return (snap.ellipse.support >= kSureSupport ? -0.5 : 0.25) * radius_px;
}

double handicap_px(const MeshSnap& snap, double radius_px) {
  return snap.kind == MeshSnapKind::kEdge ? kEdgeHandicap * radius_px : 0.0;
}

template <class Snap>
void sortByLikelihood(std::vector<Snap>& snaps, double radius_px) {
  std::stable_sort(snaps.begin(), snaps.end(), [radius_px](const Snap& a, const Snap& b) {
    return a.distance_px + handicap_px(a, radius_px) < b.distance_px + handicap_px(b, radius_px);
  });
}

/// Noise in a shadow makes corners, too; next to an edge the operator did not mean them.
bool isFainter(const ImageView& image, const Eigen::Vector2d& corner,
               const std::optional<EdgeSnap>& edge) {
  if (!edge) return false;
  const auto at_corner = snapToEdge(image, corner, kCornersEdge_px);
  return !at_corner || at_corner->contrast < kFaint * edge->contrast;
}

}  // namespace

std::optional<EdgeSnap> snapToEdge(const ImageView& image, const Eigen::Vector2d& near,
                                   double radius_px) {
  const Patch patch(image, near, radius_px);
  if (patch.empty()) return {};
  std::optional<EdgeSnap> nearest;
  double nearest_px = radius_px;
  for (double dy = -radius_px; dy <= radius_px; dy += 1.0) {
    for (double dx = -radius_px; dx <= radius_px; dx += 1.0) {
      const std::optional<EdgeSnap> snap = climb(patch, near + Eigen::Vector2d(dx, dy));
      if (!snap) continue;
      const double distance_px = (snap->pixel - near).norm();
      if (distance_px > nearest_px) continue;
      nearest = snap;
      nearest_px = distance_px;
    }
  }
  return nearest;
}

std::optional<Eigen::Vector2d> snapToCorner(const ImageView& image, const Eigen::Vector2d& near,
                                            double radius_px) {
  const Patch patch(image, near, radius_px);
  if (patch.empty()) return {};
  cv::Mat strength;
  cv::cornerMinEigenVal(patch.gray() / 255.0f, strength, 3, 3);
  const Eigen::Vector2d in_patch = near - patch.origin();
  cv::Point2f best(-1.0f, -1.0f);
  float most = 1e-4f;
  for (int y = 0; y < strength.rows; ++y) {
    for (int x = 0; x < strength.cols; ++x) {
      if ((Eigen::Vector2d(x, y) - in_patch).norm() > radius_px) continue;
      if (strength.at<float>(y, x) <= most) continue;
      most = strength.at<float>(y, x);
      best = cv::Point2f(static_cast<float>(x), static_cast<float>(y));
    }
  }
  if (best.x < 0.0f) return {};
  std::vector<cv::Point2f> corner = {best};
  cv::cornerSubPix(patch.gray(), corner, cv::Size(4, 4), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-4));
  // It wanders off where there is no corner after all.
  if (cv::norm(corner[0] - best) > 3.0) return {};
  const Eigen::Vector2d found = patch.origin() + Eigen::Vector2d(corner[0].x, corner[0].y);
  if (directions(patch, found) < kLeastDirections) return {};
  if ((found - near).norm() > radius_px + 1.0) return {};
  return found;
}

std::optional<EllipseSnap> snapToEllipse(const ImageView& image, const Eigen::Vector2d& inside,
                                         double radius_px) {
  const Patch patch(image, inside, radius_px);
  if (patch.empty()) return {};
  Eigen::Vector2d from = inside;
  std::optional<EllipseSnap> snap;
  // The second round starts from the centre found, from which all rays meet the ellipse alike.
  for (int round = 0; round < 2; ++round) {
    std::vector<cv::Point2f> points;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      const auto edge = edgeOnRay(patch, from, {std::cos(angle), std::sin(angle)}, radius_px);
      // The ray meets the edge at an angle: what counts is its steepest place straight across.
      const auto across = edge ? climb(patch, *edge) : std::nullopt;
      if (!across || (across->pixel - *edge).norm() > 2.0) continue;
      points.emplace_back(static_cast<float>(across->pixel.x()),
                          static_cast<float>(across->pixel.y()));
    }
    const std::optional<cv::RotatedRect> ellipse = fitEllipse(points);
    if (!ellipse) return {};
    double squares = 0.0;
    for (const cv::Point2f& point : points)
      squares += distanceFrom(*ellipse, point) * distanceFrom(*ellipse, point);
    EllipseSnap fit;
    fit.centre = {ellipse->center.x, ellipse->center.y};
    fit.half_axes_px = 0.5 * Eigen::Vector2d(ellipse->size.height, ellipse->size.width);
    fit.angle_rad = (ellipse->angle + 90.0) * std::numbers::pi / 180.0;
    if (fit.half_axes_px.x() < fit.half_axes_px.y()) {
      std::swap(fit.half_axes_px.x(), fit.half_axes_px.y());
      fit.angle_rad += 0.5 * std::numbers::pi;
    }
    fit.angle_rad = std::fmod(fit.angle_rad, std::numbers::pi);
    fit.support = static_cast<double>(points.size()) / kDirections;
    fit.rms_px = std::sqrt(squares / static_cast<double>(points.size()));
    if (fit.support < kLeastSupport || fit.half_axes_px.y() < kSmallestEllipse_px ||
        fit.half_axes_px.x() > radius_px || !patch.contains(fit.centre))
      return {};
    snap = fit;
    from = fit.centre;
  }
  return snap;
}

std::vector<ImageSnap> imageSnaps(const ImageView& image, const Eigen::Vector2d& near,
                                  double radius_px, double rim_px) {
  std::vector<ImageSnap> snaps;
  const auto offer = [&](ImageSnap snap) {
    snap.distance_px = (snap.pixel - near).norm();
    if (snap.distance_px <= radius_px) snaps.push_back(snap);
  };
  const auto edge = snapToEdge(image, near, radius_px);
  const auto corner = snapToCorner(image, near, radius_px);
  if (corner && !isFainter(image, *corner, edge))
    offer({ImageSnapKind::kCorner, *corner, 0.0, {}, {}});
  if (const auto ellipse = snapToEllipse(image, near, rim_px))
    offer({ImageSnapKind::kEllipse, ellipse->centre, 0.0, {}, *ellipse});
  if (edge) offer({ImageSnapKind::kEdge, edge->pixel, 0.0, *edge, {}});
  sortByLikelihood(snaps, radius_px);
  return snaps;
}

std::vector<MeshSnap> likeliestFirst(std::vector<MeshSnap> snaps, double radius_px) {
  sortByLikelihood(snaps, radius_px);
  return snaps;
}

}  // namespace boresight::sessions
