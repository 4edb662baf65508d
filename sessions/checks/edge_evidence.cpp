// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/edge_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/base/math.h"
#include "core/render/edge_render.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/checks/checks.h"
#include "sessions/checks/generalized_eigen.h"
#include "sessions/trace/scene_render.h"

namespace boresight::sessions {
namespace {

constexpr double kSigma_px = 1.5;
constexpr int kBlurReach_px = 6;
constexpr double kStep_px = 0.5;
constexpr double kAlongNormal = 0.906;  // cos 25 deg
/// Scharr's kernel sums to 32 for a slope of 1 gray/px.
constexpr double kScharrScale = 1.0 / 32.0;
constexpr int kMostSteps = 128;

constexpr double kExplained_px = 2.0;
constexpr double kSameDirection = 0.866;  // cos 30 deg
constexpr double kShareOfSlope = 0.5;

// Chance is what displaced outlines show.
constexpr std::array<double, 2> kChanceReach = {0.05, 0.1};  ///< of the outline's longer side
constexpr std::array<double, 2> kLeastChanceReach_px = {12.0, 24.0};
constexpr int kChanceWays = 8;
constexpr std::size_t kChancePlaces = 1500;
/// Share of a right pose's edges that the image shows beyond chance, at least.
constexpr double kShownAtRight = 0.4;

/// Index of the predicted place that is nearest to each pixel of a region, within kExplained_px;
/// -1: none.
cv::Mat1i nearestPlaces(const cv::Rect& region, const std::vector<EdgePlace>& places) {
  cv::Mat1i nearest(region.size(), -1);
  const int reach = static_cast<int>(std::ceil(kExplained_px));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector2d& place = places[i].pixel;
    const cv::Point centre(cvRound(place.x()), cvRound(place.y()));
    for (int y = centre.y - reach; y <= centre.y + reach; ++y)
      for (int x = centre.x - reach; x <= centre.x + reach; ++x) {
        const Eigen::Vector2d pixel(x, y);
        const double distance_px = (pixel - place).norm();
        if (!region.contains({x, y}) || distance_px > kExplained_px) continue;
        int& known = nearest(cv::Point(x, y) - region.tl());
        if (known < 0 ||
            distance_px < (pixel - places[static_cast<std::size_t>(known)].pixel).norm())
          known = static_cast<int>(i);
      }
  }
  return nearest;
}

bool isSeen(const std::optional<FoundEdge>& found) {
  return found && std::abs(found->offset_px) <= kNearEdge_px;
}

/// How steep an edge of the image is that counts as clutter.
double clutterSlope(const std::vector<LookedPlace>& looked) {
  std::vector<double> slopes;
  for (const auto& [place, found] : looked)
    if (isSeen(found)) slopes.push_back(found->slope);
  if (slopes.empty()) return 2.0 * kLeastSlope;
  return std::max(kLeastSlope, kShareOfSlope * medianOf(slopes));
}

double longerSideOf(const std::vector<LookedPlace>& looked) {
  Eigen::AlignedBox2d box;
  for (const auto& [place, found] : looked) box.extend(place.pixel);
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

std::vector<Eigen::Vector2d> chanceOffsets_px(double longer_side_px) {
  std::vector<Eigen::Vector2d> offsets_px;
  for (std::size_t ring = 0; ring < kChanceReach.size(); ++ring) {
    const double reach_px =
        std::max(kLeastChanceReach_px[ring], kChanceReach[ring] * longer_side_px);
    for (int way = 0; way < kChanceWays; ++way) {
      const double angle_rad = 2.0 * kPi * way / kChanceWays;
      offsets_px.emplace_back(reach_px * std::cos(angle_rad), reach_px * std::sin(angle_rad));
    }
  }
  return offsets_px;
}

/// In the order of a perturbation's coordinates.
constexpr std::array<const char*, 6> kAxisNames = {
    "turned about the image's x axis", "turned about the image's y axis",
    "turned about the view axis",      "moved along the image's x axis",
    "moved along the image's y axis",  "moved along the view axis"};
/// Keeps ways that hardly move the image at all out of the search for the least determined one.
constexpr double kLeastMotion = 1e-3;
/// Of a displacement along an axis: less without symmetric motions does not belong to the axis.
constexpr double kLeastOfWay = 0.3;

/// How the image follows perturbations about the station's middle.
struct Motion {
  Matrix6d image = Matrix6d::Zero();   ///< mean of J' J of both coordinates
  Matrix6d across = Matrix6d::Zero();  ///< mean of that along the edges' normals alone
};

Eigen::Vector3d middleOf(const std::vector<EdgePlace>& places, const Pose& camera_from_station) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const EdgePlace& place : places) sum += camera_from_station * place.point_in_station_m;
  return sum / static_cast<double>(places.size());
}

/// A perturbation about a point of the camera frame as one about the camera's centre.
Vector6d aboutCamera(const Vector6d& xi, const Eigen::Vector3d& middle_m) {
  Vector6d result = xi;
  result.tail<3>() += middle_m - rotationExp(xi.head<3>()) * middle_m;
  return result;
}

Motion motionOf(const std::vector<EdgePlace>& places, const Camera& camera,
                const Pose& camera_from_station, const Eigen::Vector3d& middle_m) {
  Matrix6d shift = Matrix6d::Identity();  // d (about the camera) / d (about the middle)
  for (int i = 0; i < 3; ++i)
    shift.block<3, 1>(3, i) = middle_m.cross(Eigen::Vector3d(Eigen::Vector3d::Unit(i)));
  Motion motion;
  double count = 0.0;
  for (const EdgePlace& place : places) {
    const PredictedPlace at = predictPlace(camera, camera_from_station, place.point_in_station_m);
    if (!at.valid) continue;
    const Eigen::Matrix<double, 2, 6> rows = at.pixel_by_xi * shift;
    const Vector6d across = rows.transpose() * place.normal;
    motion.image += rows.transpose() * rows;
    motion.across += across * across.transpose();
    count += 1.0;
  }
  if (count > 0.0) {
    motion.image /= count;
    motion.across /= count;
  }
  return motion;
}

/// Small motions about the camera as such about a point of the camera frame.
PoseMotions aboutMiddle(PoseMotions motions, const Eigen::Vector3d& middle_m) {
  for (auto motion : motions.colwise()) {
    const Eigen::Vector3d turn = motion.head<3>();
    motion.tail<3>() += turn.cross(middle_m);
  }
  return motions;
}

/// Across, with `motions` as if they were seen better than any other.
Matrix6d acrossWithout(const Motion& motion, const Matrix6d& determined) {
  constexpr double kWellSeen = 1e6;
  const Matrix6d along = Matrix6d::Identity() - determined;
  return determined.transpose() * motion.across * determined +
         kWellSeen * along.transpose() * motion.image * along;
}

/// The way in which the image moves most along the edges and least across them.
Vector6d leastDetermined(const Motion& motion, const Matrix6d& determined) {
  Matrix6d image = motion.image;
  image.diagonal() *= 1.0 + kLeastMotion;
  const auto eigen = generalizedEigen<6>(acrossWithout(motion, determined), image);
  return eigen ? Vector6d(eigen->vectors.col(0)) : Vector6d(Vector6d::Unit(2));
}

/// The places as a displaced pose predicts them; which are hidden is left as it was.
std::vector<EdgePlace> displacedPlaces(const std::vector<EdgePlace>& places, const Camera& camera,
                                       const Pose& displaced_camera_from_station) {
  std::vector<EdgePlace> moved;
  moved.reserve(places.size());
  for (EdgePlace place : places) {
    Eigen::Vector2d pixel;
    if (!project(camera, displaced_camera_from_station * place.point_in_station_m, pixel)) continue;
    place.pixel = pixel;
    moved.push_back(place);
  }
  return moved;
}

/// The axis that moves the image most in a mixture of them.
std::string mainlyText(const Vector6d& xi, const Motion& motion) {
  Eigen::Index axis = 0;
  (xi.cwiseAbs2().cwiseProduct(motion.image.diagonal())).maxCoeff(&axis);
  return std::string("in the least determined way, mainly ") +
         kAxisNames[static_cast<std::size_t>(axis)];
}

}  // namespace

ImageEdges::ImageEdges(const ImageView& image, const BitImage* ignore, const cv::Rect& region)
    : region_(region & cv::Rect(0, 0, image.width, image.height)) {
  if (region_.empty()) return;
  // OpenCV has no const headers; nothing is written.
  const cv::Mat whole(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.data),
                      static_cast<std::size_t>(image.stride));
  const cv::Point reach(kBlurReach_px, kBlurReach_px);
  const cv::Rect wide = cv::Rect(region_.tl() - reach, region_.br() + reach) &
                        cv::Rect(0, 0, image.width, image.height);
  cv::Mat blurred, dx, dy;
  whole(wide).convertTo(blurred, CV_32F);
  cv::GaussianBlur(blurred, blurred, cv::Size(), kSigma_px, kSigma_px, cv::BORDER_REPLICATE);
  cv::Scharr(blurred, dx, CV_32F, 1, 0, kScharrScale, 0.0, cv::BORDER_REPLICATE);
  cv::Scharr(blurred, dy, CV_32F, 0, 1, kScharrScale, 0.0, cv::BORDER_REPLICATE);
  dx_ = dx(region_ - wide.tl());
  dy_ = dy(region_ - wide.tl());
  ignored_ = cv::Mat1b::zeros(region_.size());
  for (int y = 0; ignore != nullptr && y < region_.height; ++y)
    for (int x = 0; x < region_.width; ++x)
      ignored_(y, x) = ignore->get(region_.x + x, region_.y + y) ? 255 : 0;
}

Eigen::Vector2d ImageEdges::between(const Eigen::Vector2d& pixel) const {
  const cv::Point last = region_.br() - cv::Point(2, 2);
  const int x = std::clamp(cvFloor(pixel.x()), region_.x, last.x);
  const int y = std::clamp(cvFloor(pixel.y()), region_.y, last.y);
  const double u = pixel.x() - x;
  const double v = pixel.y() - y;
  return (1.0 - v) * ((1.0 - u) * gradient({x, y}) + u * gradient({x + 1, y})) +
         v * ((1.0 - u) * gradient({x, y + 1}) + u * gradient({x + 1, y + 1}));
}

bool ImageEdges::canLook(const Eigen::Vector2d& predicted_px, double radius_px) const {
  const double reach = radius_px + 1.0;
  return predicted_px.x() - reach >= region_.x && predicted_px.y() - reach >= region_.y &&
         predicted_px.x() + reach <= region_.br().x - 1 &&
         predicted_px.y() + reach <= region_.br().y - 1 &&
         !isIgnored({cvRound(predicted_px.x()), cvRound(predicted_px.y())});
}

std::optional<FoundEdge> ImageEdges::across(const Eigen::Vector2d& predicted_px,
                                            const Eigen::Vector2d& normal, double radius_px,
                                            double least_slope) const {
  if (!canLook(predicted_px, radius_px)) return {};
  const int reach = std::min(static_cast<int>(radius_px / kStep_px), kMostSteps / 2 - 1);
  std::array<double, kMostSteps + 1> slope{};  // of steps -reach - 1 ... reach + 1
  std::array<bool, kMostSteps + 1> agrees{};
  const int count = 2 * reach + 3;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at = predicted_px + (i - reach - 1) * kStep_px * normal;
    const Eigen::Vector2d found = between(at);
    slope[static_cast<std::size_t>(i)] = std::abs(found.dot(normal));
    agrees[static_cast<std::size_t>(i)] =
        slope[static_cast<std::size_t>(i)] >= kAlongNormal * found.norm();
    if (isIgnored({cvRound(at.x()), cvRound(at.y())})) agrees[static_cast<std::size_t>(i)] = false;
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(count); ++i) {
    const bool peak = slope[i] >= slope[i - 1] && slope[i] > slope[i + 1];
    if (peak && agrees[i] && slope[i] >= least_slope && (best == 0 || slope[i] > slope[best]))
      best = i;
  }
  if (best == 0) return {};
  const double curvature = slope[best - 1] - 2.0 * slope[best] + slope[best + 1];
  const double shift =
      curvature < 0.0 ? 0.5 * (slope[best - 1] - slope[best + 1]) / curvature : 0.0;
  return FoundEdge{(static_cast<double>(best) - reach - 1 + shift) * kStep_px, slope[best]};
}

cv::Mat1b ImageEdges::thinEdges(double least_slope) const {
  if (region_.empty()) return {};
  // Canny takes integers: a 64th of a gray value per pixel is fine enough.
  constexpr double kUnits = 64.0;
  cv::Mat dx, dy;
  cv::Mat1b edges;
  dx_.convertTo(dx, CV_16S, kUnits);
  dy_.convertTo(dy, CV_16S, kUnits);
  cv::Canny(dx, dy, edges, 0.5 * kUnits * least_slope, kUnits * least_slope, true);
  edges.setTo(0, ignored_);
  return edges;
}

std::vector<LookedPlace> lookAt(const ImageEdges& image, const std::vector<EdgePlace>& places) {
  std::vector<LookedPlace> looked;
  looked.reserve(places.size());
  for (const EdgePlace& place : places) {
    if (!image.canLook(place.pixel, kEdgeRadius_px)) continue;
    looked.push_back({place, image.across(place.pixel, place.normal, kEdgeRadius_px, kLeastSlope)});
  }
  return looked;
}

Share coverageOf(const std::vector<LookedPlace>& looked) {
  Share share;
  for (const auto& [place, found] : looked) {
    share.whole += place.length_px;
    if (isSeen(found)) share.part += place.length_px;
  }
  return share;
}

Share evidenceOf(const ImageEdges& image, const std::vector<LookedPlace>& looked) {
  Share share;
  const auto offsets_px = chanceOffsets_px(longerSideOf(looked));
  const std::size_t stride =
      std::max<std::size_t>(1, (looked.size() + kChancePlaces - 1) / kChancePlaces);
  for (std::size_t i = 0; i < looked.size(); i += stride) {
    const EdgePlace& place = looked[i].place;
    double seen = 0.5;  // one look more that is half seen: chance is neither 0 nor 1
    double looks = 1.0;
    for (const Eigen::Vector2d& offset_px : offsets_px) {
      const Eigen::Vector2d at = place.pixel + offset_px;
      if (!image.canLook(at, kEdgeRadius_px)) continue;
      looks += 1.0;
      if (isSeen(image.across(at, place.normal, kEdgeRadius_px, kLeastSlope))) seen += 1.0;
    }
    const double chance = seen / looks;
    const double right = kShownAtRight + (1.0 - kShownAtRight) * chance;
    const double if_seen = std::log(right / chance);
    const double if_not = std::log1p(-kShownAtRight);
    share.part += place.length_px * (isSeen(looked[i].found) ? if_seen : if_not);
    share.whole += place.length_px * (right * if_seen + (1.0 - right) * if_not);
  }
  return share;
}

Share coverageOfPose(const LoadedCase& loaded, const Pose& camera_from_station) {
  const PredictedEdges edges =
      predictEdges(loaded.source.camera, loaded.scene.view(), camera_from_station);
  const ImageEdges image(loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
                         regionOf(edges));
  return coverageOf(lookAt(image, thinned(edges.places, kEdgePlaces)));
}

Share clutterOf(const ImageEdges& image, const PredictedEdges& edges,
                const std::vector<LookedPlace>& looked) {
  Share share;
  const cv::Rect& region = image.region();
  if (region.empty() || edges.mask.words.empty()) return share;
  const cv::Mat1b seen = image.thinEdges(clutterSlope(looked));
  const cv::Mat1i nearest = nearestPlaces(region, edges.places);
  const BitImage mask = edges.mask.view();
  for (int y = 0; y < region.height; ++y)
    for (int x = 0; x < region.width; ++x) {
      const cv::Point pixel = region.tl() + cv::Point(x, y);
      if (seen(y, x) == 0 || !mask.get(pixel.x, pixel.y)) continue;
      share.whole += 1.0;
      const int place = nearest(y, x);
      const bool explained =
          place >= 0 &&
          std::abs(image.gradient(pixel).normalized().dot(
              edges.places[static_cast<std::size_t>(place)].normal)) >= kSameDirection;
      if (!explained) share.part += 1.0;
    }
  return share;
}

cv::Rect regionOf(const PredictedEdges& edges) {
  if (edges.places.empty()) return {};
  Eigen::AlignedBox2d box;
  for (const EdgePlace& place : edges.places) box.extend(place.pixel);
  // Displaced places move by a few times the root of the mean square at most; chance is looked for
  // farther out.
  const double displaced_px = std::max({4.0 * kDisplaced_px, kLeastChanceReach_px.back(),
                                        kChanceReach.back() * box.sizes().maxCoeff()});
  const double margin = kEdgeRadius_px + displaced_px + 2.0;
  return {cv::Point(cvRound(box.min().x() - margin), cvRound(box.min().y() - margin)),
          cv::Point(cvRound(box.max().x() + margin) + 1, cvRound(box.max().y() + margin) + 1)};
}

std::vector<FallOff> fallOffOf(const ImageEdges& image, const std::vector<EdgePlace>& places,
                               const Camera& camera, const Pose& camera_from_station,
                               const PoseMotions& symmetric) {
  std::vector<FallOff> all;
  if (places.empty()) return all;
  const Eigen::Vector3d middle_m = middleOf(places, camera_from_station);
  const Motion motion = motionOf(places, camera, camera_from_station, middle_m);
  const Matrix6d determined = projectionWithout(aboutMiddle(symmetric, middle_m), motion.image);
  const auto add = [&](const Vector6d& whole, std::string name) {
    const Vector6d way = determined * whole;
    const double moves_px = std::sqrt(way.dot(motion.image * way));
    const double whole_px = std::sqrt(whole.dot(motion.image * whole));
    if (!(moves_px > kLeastOfWay * whole_px)) return;
    double coverage = 0.0;
    for (const double sense : {-1.0, 1.0}) {
      const Vector6d xi = (sense * kDisplaced_px / moves_px) * way;
      const Pose displaced = perturbed(aboutCamera(xi, middle_m), camera_from_station);
      const auto moved = displacedPlaces(places, camera, displaced);
      coverage += 0.5 * coverageOf(lookAt(image, moved)).value();
    }
    all.push_back({std::move(name), coverage});
  };
  for (int axis = 0; axis < 6; ++axis)
    add(Vector6d::Unit(axis), kAxisNames[static_cast<std::size_t>(axis)]);
  const Vector6d least = leastDetermined(motion, determined);
  add(least, mainlyText(least, motion));
  return all;
}

PredictedEdges predictEdges(const Camera& camera, const MeshView& mesh,
                            const Pose& camera_from_station) {
  PredictedEdges edges;
  RenderTrace render;
  if (renderScene(camera, mesh, camera_from_station, render) != Status::kOk) return edges;
  const RenderView owned = render.view();
  const EdgeRender& view = owned.render;
  edges.places.reserve(render.pixels.size());
  for (const EdgePixel& pixel : render.pixels) {
    EdgePlace place;
    if (!edgeLinePoint(view, mesh, pixel, place.pixel, place.point_in_station_m)) continue;
    place.normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y).normalized();
    place.kind = pixel.kind;
    if (!place.normal.allFinite()) continue;
    // A thin line has a pixel per column or per row, whichever it crosses more of.
    place.length_px = 1.0 / place.normal.cwiseAbs().maxCoeff();
    edges.places.push_back(place);
  }
  edges.mask = std::move(render.mask);
  return edges;
}

Eigen::Matrix<double, 2, 3> pixelByCamera(const Camera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Matrix<double, 2, 3> by_camera;
  by_camera << (pixel.x() - camera.cx) / camera.fx, 1.0, 0.0, (pixel.y() - camera.cy) / camera.fx,
      0.0, 1.0;
  return by_camera;
}

std::vector<EdgePlace> thinned(const std::vector<EdgePlace>& places, std::size_t most) {
  if (most == 0 || places.size() <= most) return places;
  std::vector<EdgePlace> kept;
  kept.reserve(most);
  for (std::size_t i = 0; i < most; ++i) kept.push_back(places[i * places.size() / most]);
  return kept;
}

}  // namespace boresight::sessions
