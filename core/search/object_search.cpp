// SPDX-License-Identifier: Apache-2.0
#include "core/search/object_search.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr double kDepthSpacing = 0.1;  ///< spacing of depths, at most, as a share of the depth
constexpr int kMostDepths = 15;
constexpr double kMostDepth = 0.6;
constexpr double kFarthestSlide = 1.5;  ///< 56 deg off the view's axis
/// Tolerance on the seed's uncertainty, before a candidate is refined.
constexpr double kBeyond = 1.15;
/// Nearer candidates are the same: share of the size, on the grid and after the descent.
constexpr double kApartOnGrid = 0.06;
constexpr double kApart = 0.03;
/// Candidates on the grid whose distance exceeds the least one by more are left out.
constexpr double kBehind_px = 0.7;

/// Cells that a range to either side is divided into: odd, so that the seed is in the middle of
/// one.
int placesFor(double range, double spacing) {
  const int half = static_cast<int>(-std::floor(0.5 - std::min(range / spacing, 1e3)));
  return std::clamp(2 * half + 1, 1, kMostDepths);
}

/// Largest motion of the scene's centre by a turn about the pivot and a translation, per camera
/// axis.
Eigen::Vector3d reachOf(const SearchProblem& problem) {
  const SeedUncertainty& seed = problem.uncertainty;
  const Eigen::Vector3d arm_m =
      (problem.camera_from_station_seed * problem.scene.centre() - seed.pivot_in_camera_m)
          .cwiseAbs();
  const Eigen::Vector3d turn = seed.rotation_rad.cwiseMin(1.0);  // sine, at most
  const Eigen::Vector3d squared = seed.rotation_rad.cwiseProduct(seed.rotation_rad);
  const auto away = [](double squared_rad2) { return std::min(0.5 * squared_rad2, 2.0); };
  return seed.translation_m + Eigen::Vector3d(turn.y() * arm_m.z() + turn.z() * arm_m.y() +
                                                  away(squared.y() + squared.z()) * arm_m.x(),
                                              turn.x() * arm_m.z() + turn.z() * arm_m.x() +
                                                  away(squared.x() + squared.z()) * arm_m.y(),
                                              turn.x() * arm_m.y() + turn.y() * arm_m.x() +
                                                  away(squared.x() + squared.y()) * arm_m.z());
}

/// The nearest rotation inside the seed's box: a grid sample beyond the box represents the
/// rotations inside. The object's centre keeps its position.
Pose pulledIntoBox(const SearchProblem& problem, const Pose& camera_from_station) {
  const Eigen::Quaterniond& seed = problem.camera_from_station_seed.rotation;
  const Eigen::Vector3d box_rad = problem.uncertainty.rotation_rad;
  const Eigen::Vector3d rotation_rad = rotationLog(camera_from_station.rotation * seed.conjugate());
  Pose pulled;
  pulled.rotation = rotationExp(rotation_rad.cwiseMax(-box_rad).cwiseMin(box_rad)) * seed;
  pulled.rotation.normalize();
  pulled.translation_m = camera_from_station * problem.scene.centre() -
                         pulled.rotation.toRotationMatrix() * problem.scene.centre();
  return pulled;
}

}  // namespace

bool ObjectSearch::begin(const SearchProblem& problem, ViewEdges& view_edges,
                         EdgeRenderer& renderer, EdgeRender& render) {
  problem_ = &problem;
  view_edges_ = &view_edges;
  renderer_ = &renderer;
  render_ = &render;
  phase_ = Phase::kDone;
  found_ = CandidateList();
  poses_ = 0;
  if (!layOut() || !beginView()) return false;
  const FacingView& view = view_edges.view();
  const double focal_px = view.camera.fx;
  slide_x_px_ =
      std::min(static_cast<int>(view_size_.slide_x * focal_px) + 1, view.camera.width / 2 - 1);
  slide_y_px_ =
      std::min(static_cast<int>(view_size_.slide_y * focal_px) + 1, view.camera.height / 2 - 1);
  sums_.begin(view.camera.width, view.camera.height, slide_x_px_, slide_y_px_);
  const Eigen::Vector3d axis = view.view_from_camera.inverse().rotation * Eigen::Vector3d::UnitZ();
  grid_found_ = CandidateList(0.5 * view.span_px, kApartOnGrid * view.span_px, axis);
  found_ = CandidateList(0.5 * view.span_px, kApart * view.span_px, axis);
  next_ = 0;
  descends_ = false;
  rendering_ = false;
  phase_ = Phase::kView;
  return true;
}

/// Ranges of the grid, and the view that holds them.
bool ObjectSearch::layOut() {
  const SearchProblem& problem = *problem_;
  const Eigen::Vector3d middle_m = problem.camera_from_station_seed * problem.scene.centre();
  if (!(middle_m.z() > 0.0)) return false;
  depth_m_ = std::sqrt(middle_m.squaredNorm());
  const Pose view_from_camera = viewTowards(middle_m);
  const Eigen::Matrix3d turn = view_from_camera.matrix().cwiseAbs();
  const Eigen::Vector3d reach_m = turn * reachOf(problem);
  const Eigen::Vector3d box_rad =
      problem.uncertainty.rotation_rad.cwiseMin(Eigen::Vector3d::Constant(kPi));
  // An object off the camera's axis appears tilted.
  rotations_ = RotationGrid({box_rad,
                             view_from_camera.rotation,
                             {atan(reach_m.y() / depth_m_), atan(reach_m.x() / depth_m_)}});
  depth_range_ = std::min(reach_m.z() / depth_m_, kMostDepth);
  depths_ = placesFor(depth_range_, kDepthSpacing);
  ViewSize& size = view_size_;
  size.span_px = kSpan_px;
  size.margin_px = kViewMargin * kSpan_px;
  size.slide_x = std::min(reach_m.x() / depth_m_, kFarthestSlide);
  size.slide_y = std::min(reach_m.y() / depth_m_, kFarthestSlide);
  size.most_px = SlideSums::kMaxView_px;
  // Half of the largest side that a tilt brings into view.
  const double tilt_rad = std::min((turn * box_rad).head<2>().maxCoeff(), 0.5 * kPi);
  const Eigen::Vector3d extent_m = problem.scene.maximum_m - problem.scene.minimum_m;
  size.least_half = sin(tilt_rad) * 0.5 * extent_m.maxCoeff() / depth_m_;
  return true;
}

bool ObjectSearch::step() {
  switch (phase_) {
    case Phase::kView:
      if (view_edges_->step()) phase_ = Phase::kMaps;
      return false;
    case Phase::kMaps:
      sums_.takeMap(view_edges_->edges(), next_);
      return ++next_ == kEdgeDirections ? nextDirection() : false;
    case Phase::kRender:
      return stepRender();
    case Phase::kScore:
      scoreTurn(next_);
      while (++next_ < rotations_.count())
        if ((rotations_.turns() >> next_ & 1U) != 0) return false;
      return nextDirection();
    case Phase::kDescend:
      descend();
      return nextDescent();
    case Phase::kDone:
      break;
  }
  return true;
}

bool ObjectSearch::nextDirection() {
  phase_ = Phase::kRender;
  if (rotations_.next()) return false;
  descends_ = true;
  next_ = -1;
  return nextDescent();
}

bool ObjectSearch::nextDescent() {
  const std::span<const SearchCandidate> candidates = grid_found_.candidates();
  const bool continues =
      ++next_ < static_cast<int>(candidates.size()) &&
      nth(candidates, next_).distance_px < candidates.front().distance_px + kBehind_px;
  phase_ = continues ? Phase::kRender : Phase::kDone;
  return !continues;
}

void ObjectSearch::descend() {
  SearchCandidate candidate = nth(grid_found_.candidates(), next_);
  Pose view_from_station = view_edges_->inView(candidate.camera_from_station);
  candidate.distance_px = compass_.descend(sums_, problem_->scene.centre(), view_from_station);
  candidate.camera_from_station = view_edges_->inCamera(view_from_station);
  found_.insert(candidate);
}

/// A pose that cannot be rendered is skipped.
bool ObjectSearch::stepRender() {
  const Status status = view_edges_->render(*renderer_, renderedPose(), *render_, rendering_);
  if (rendering_) return false;
  if (descends_) {
    phase_ = Phase::kDescend;
    return status == Status::kOk && compass_.takePlaces(problem_->mesh, *render_) ? false
                                                                                  : nextDescent();
  }
  points_.clear();
  if (status == Status::kOk) takePoints();
  if (points_.size() == 0) return nextDirection();
  phase_ = Phase::kScore;
  next_ = std::countr_zero(rotations_.turns());
  return false;
}

/// Middle of a cell.
double ObjectSearch::depthRatio(int depth) const {
  return 1.0 + depth_range_ * ((2.0 * depth + 1.0) / depths_ - 1.0);
}

/// A candidate, or the seed turned about the scene's middle, in the view.
Pose ObjectSearch::renderedPose() const {
  if (descends_)
    return view_edges_->inView(nth(grid_found_.candidates(), next_).camera_from_station);
  Pose view_from_station;
  view_from_station.rotation = rotationExp(rotations_.tilt_rad()) *
                               view_edges_->inView(problem_->camera_from_station_seed).rotation;
  view_from_station.translation_m =
      Eigen::Vector3d(0.0, 0.0, depth_m_) - view_from_station.matrix() * problem_->scene.centre();
  return view_from_station;
}

void ObjectSearch::takePoints() {
  const Camera& camera = view_edges_->view().camera;
  takeEvenly(*render_, [&](const EdgePixel& pixel) {
    const Eigen::Vector2d normal = pixel.normal();
    const Eigen::Vector2d place_px = pixel.onLine_px();
    points_.add({place_px.x() - camera.cx, place_px.y() - camera.cy, normal.x(), normal.y()});
  });
}

/// The outline turned, at all depths and slides.
void ObjectSearch::scoreTurn(int turn) {
  const double c = cos(turn * rotations_.spacing_rad());
  const double s = sin(turn * rotations_.spacing_rad());
  std::array<SlideSums::Place, SlideSums::kMaxPlaces> places;
  const auto used = std::span(places).first(points_.items().size());
  for (int depth = 0; depth < depths_; ++depth) {
    const double ratio = depthRatio(depth);
    for (std::size_t i = 0; i < used.size(); ++i) {
      const Point& point = points_.items()[i];
      used[i] = {static_cast<std::int16_t>(nearestInt((c * point.x_px - s * point.y_px) / ratio)),
                 static_cast<std::int16_t>(nearestInt((s * point.x_px + c * point.y_px) / ratio)),
                 edgeDirectionOf(nearestInt(1024.0 * (c * point.normal_x - s * point.normal_y)),
                                 nearestInt(1024.0 * (s * point.normal_x + c * point.normal_y)))};
    }
    sums_.add(used);
    poses_ += std::int64_t{sums_.columns()} * sums_.rows();
    takePeaks(turn, ratio);
  }
}

void ObjectSearch::takePeaks(int turn, double depth_ratio) {
  const double unit_px = SlideSums::kStep_px / points_.size();
  if (!grid_found_.accepts(unit_px * sums_.least())) return;
  const Eigen::Vector3d tilt_rad = rotations_.tilt_rad();
  for (int row = 0; row < sums_.rows(); ++row) {
    for (int column = 0; column < sums_.columns(); ++column) {
      const double distance_px = unit_px * sums_.sum(column, row);
      if (!grid_found_.accepts(distance_px) || !sums_.isPeak(column, row)) continue;
      SearchCandidate candidate;
      candidate.distance_px = distance_px;
      candidate.tilt_x_rad = tilt_rad.x();
      candidate.tilt_y_rad = tilt_rad.y();
      candidate.roll_rad = turn * rotations_.spacing_rad();
      if (candidate.roll_rad > kPi) candidate.roll_rad -= 2.0 * kPi;
      candidate.depth_ratio = depth_ratio;
      candidate.slide_x_px = column - slide_x_px_;
      candidate.slide_y_px = row - slide_y_px_;
      candidate.camera_from_station = poseOf(candidate);
      if (!isWithinSeed(candidate.camera_from_station)) continue;
      candidate.camera_from_station = pulledIntoBox(*problem_, candidate.camera_from_station);
      grid_found_.insert(candidate);
    }
  }
}

Pose ObjectSearch::poseOf(const SearchCandidate& candidate) const {
  Pose pose;  // seen from a camera that faces the candidate
  pose.rotation = rotationExp({0.0, 0.0, candidate.roll_rad}) *
                  rotationExp({candidate.tilt_x_rad, candidate.tilt_y_rad, 0.0}) *
                  view_edges_->inView(problem_->camera_from_station_seed).rotation;
  pose.translation_m = Eigen::Vector3d(0.0, 0.0, depth_m_ * candidate.depth_ratio) -
                       pose.matrix() * problem_->scene.centre();
  const double focal_px = view_edges_->view().camera.fx;
  const Pose facing_from_view =
      viewTowards({candidate.slide_x_px / focal_px, candidate.slide_y_px / focal_px, 1.0});
  return view_edges_->inCamera(facing_from_view.inverse() * pose);
}

bool ObjectSearch::isWithinSeed(const Pose& camera_from_station) const {
  const SeedUncertainty& seed = problem_->uncertainty;
  const Vector6d offset = offsetAboutPivot(problem_->camera_from_station_seed, camera_from_station,
                                           seed.pivot_in_camera_m);
  // Half a step of the grid more.
  const double step_m = depth_m_ * (1.5 / view_edges_->view().camera.fx + 0.5 * kDepthSpacing);
  for (int i = 3; i < 6; ++i)
    if (std::abs(offset[i]) > kBeyond * seed.translation_m[i - 3] + step_m) return false;
  return isNearBox(offset.head<3>(), kBeyond * seed.rotation_rad,
                   Eigen::Vector3d::Constant(0.5 * rotations_.spacing_rad()));
}

}  // namespace boresight
