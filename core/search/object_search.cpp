// SPDX-License-Identifier: Apache-2.0
#include "core/search/object_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kSpan_px = 88.0;                ///< of the object in the search's image
constexpr double kTilt_rad = 8.0 * kDegree_rad;  ///< spacings of the grid, at most
constexpr double kRoll_rad = 6.0 * kDegree_rad;
constexpr double kDepth = 0.05;
constexpr int kMostPlaces = 61;
/// Tolerance on the seed's uncertainty, before a candidate is refined.
constexpr double kBeyond = 1.15;
constexpr double kApart = 0.03;  ///< of the size: nearer candidates are the same
constexpr double kMostDepth = 0.6;

/// Cells that a range to either side is divided into: odd, so that the seed is in the middle of
/// one.
int placesFor(double range, double spacing) {
  const int half = static_cast<int>(-std::floor(0.5 - std::min(range / spacing, 1e3)));
  return std::clamp(2 * half + 1, 1, kMostPlaces);
}

/// Middle of a cell.
double placeOf(int index, int count, double range) {
  return range * ((2.0 * index + 1.0) / count - 1.0);
}

int nearest(double value) { return static_cast<int>(std::floor(value + 0.5)); }

/// How far a turn about the pivot and a translation can move the scene's middle, per camera axis.
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

}  // namespace

void ObjectSearch::create(Arena& arena) {
  constexpr auto kPixels = static_cast<std::size_t>(kMaxSide_px) * kMaxSide_px;
  for (auto& map : maps_) map = arena.allocate<std::uint8_t>(kPixels);
  sums_ = arena.allocate<std::uint16_t>(kPixels);
}

bool ObjectSearch::begin(const SearchProblem& problem, ViewEdges& view_edges,
                         EdgeRenderer& renderer, EdgeRender& render) {
  problem_ = &problem;
  view_edges_ = &view_edges;
  renderer_ = &renderer;
  render_ = &render;
  phase_ = Phase::kDone;
  found_ = CandidateList();
  poses_ = 0;
  const Eigen::Vector3d middle_m = problem.camera_from_station_seed * problem.scene.centre();
  if (!(middle_m.z() > 0.0)) return false;
  depth_m_ = std::sqrt(middle_m.squaredNorm());
  const Eigen::Matrix3d turn = viewTowards(middle_m).matrix().cwiseAbs();
  const Eigen::Vector3d reach_m = turn * reachOf(problem);
  constexpr double kFarthestSlide = 1.5;  // 56 deg off the view's axis
  ViewSize size;
  size.span_px = kSpan_px;
  size.margin_px = 0.1 * kSpan_px;
  size.slide_x = std::min(reach_m.x() / depth_m_, kFarthestSlide);
  size.slide_y = std::min(reach_m.y() / depth_m_, kFarthestSlide);
  size.most_px = kMaxSide_px;
  if (!view_edges.begin(problem, problem.camera_from_station_seed, size)) return false;
  const double focal_px = view_edges.view().camera.fx;
  grid_ = SearchGrid();
  grid_.slide_x_px = std::min(static_cast<int>(size.slide_x * focal_px) + 1,
                              view_edges.view().camera.width / 2 - 1);
  grid_.slide_y_px = std::min(static_cast<int>(size.slide_y * focal_px) + 1,
                              view_edges.view().camera.height / 2 - 1);
  layOutGrid(reach_m, turn * problem.uncertainty.rotation_rad);
  found_ = CandidateList(0.5 * view_edges.view().span_px, kApart * view_edges.view().span_px);
  tilt_ = 0;
  rendering_ = false;
  phase_ = Phase::kView;
  return true;
}

void ObjectSearch::layOutGrid(const Eigen::Vector3d& reach_m, const Eigen::Vector3d& reach_rad) {
  // What is seen from aside is seen tilted.
  grid_.tilt_x_rad = std::min(reach_rad.x() + arcTangent(reach_m.y() / depth_m_), kPi);
  grid_.tilt_y_rad = std::min(reach_rad.y() + arcTangent(reach_m.x() / depth_m_), kPi);
  grid_.roll_rad = std::min(reach_rad.z(), kPi);
  grid_.depth = std::min(reach_m.z() / depth_m_, kMostDepth);
  grid_.tilts_x = placesFor(grid_.tilt_x_rad, kTilt_rad);
  grid_.tilts_y = placesFor(grid_.tilt_y_rad, kTilt_rad);
  grid_.rolls = placesFor(grid_.roll_rad, kRoll_rad);
  grid_.depths = placesFor(grid_.depth, kDepth);
}

bool ObjectSearch::step() {
  switch (phase_) {
    case Phase::kView:
      if (!view_edges_->step()) return false;
      phase_ = Phase::kMaps;
      next_ = 0;
      return false;
    case Phase::kMaps:
      makeMap(next_);
      if (++next_ == kEdgeDirections) phase_ = Phase::kRender;
      return false;
    case Phase::kRender:
      return stepRender();
    case Phase::kScore: {
      const RollDepth change = rollDepthOf(next_);
      sumDistances(change);
      takePeaks(change);
      return ++next_ == grid_.rolls * grid_.depths ? nextTilt() : false;
    }
    case Phase::kDone:
      break;
  }
  return true;
}

void ObjectSearch::makeMap(int direction) {
  const auto index = static_cast<std::size_t>(direction);
  const DirectedEdges& edges = view_edges_->edges();
  distanceToDirection(edges, direction, maps_[index]);
  const auto count = static_cast<std::size_t>(edges.width * edges.height);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += maps_[index][i];
  mean_[index] = static_cast<std::uint8_t>(sum / std::max<std::size_t>(count, 1));
}

/// A tilt that cannot be rendered is passed over.
bool ObjectSearch::stepRender() {
  bool complete = false;
  Status status = Status::kOk;
  if (!rendering_)
    status = renderer_->begin(view_edges_->rays(), tiltedPose(), *render_);
  else
    status = renderer_->stepWhole(complete);
  rendering_ = status == Status::kOk && !complete;
  if (rendering_) return false;
  point_count_ = 0;
  if (status == Status::kOk) takePoints();
  if (point_count_ == 0) return nextTilt();
  phase_ = Phase::kScore;
  next_ = 0;
  return false;
}

bool ObjectSearch::nextTilt() {
  phase_ = ++tilt_ < grid_.tilts_x * grid_.tilts_y ? Phase::kRender : Phase::kDone;
  return phase_ == Phase::kDone;
}

ObjectSearch::RollDepth ObjectSearch::rollDepthOf(int index) const {
  return {placeOf(index / grid_.depths, grid_.rolls, grid_.roll_rad),
          1.0 + placeOf(index % grid_.depths, grid_.depths, grid_.depth)};
}

double ObjectSearch::tiltX_rad() const {
  return placeOf(tilt_ / grid_.tilts_y, grid_.tilts_x, grid_.tilt_x_rad);
}

double ObjectSearch::tiltY_rad() const {
  return placeOf(tilt_ % grid_.tilts_y, grid_.tilts_y, grid_.tilt_y_rad);
}

/// The seed turned about the scene's middle, in the view.
Pose ObjectSearch::tiltedPose() const {
  Pose view_from_station;
  view_from_station.rotation = rotationExp({tiltX_rad(), tiltY_rad(), 0.0}) *
                               view_edges_->inView(problem_->camera_from_station_seed).rotation;
  view_from_station.translation_m =
      Eigen::Vector3d(0.0, 0.0, depth_m_) - view_from_station.matrix() * problem_->scene.centre();
  return view_from_station;
}

/// Outline places spread evenly over the render; where there is hardly any outline, all edges.
void ObjectSearch::takePoints() {
  const auto isOutline = [](const EdgePixel& pixel) {
    return (pixel.kind & (kEdgeBorder | kEdgeOccluding)) != 0;
  };
  const auto pixels = render_->pixels.first(static_cast<std::size_t>(render_->pixel_count));
  std::int64_t available = 0;
  for (const EdgePixel& pixel : pixels) available += isOutline(pixel) ? 1 : 0;
  const bool all = available < kMaxPoints / 2;
  if (all) available = render_->pixel_count;
  const std::int64_t wanted = std::min<std::int64_t>(kMaxPoints, available);
  const int middle_x = view_edges_->view().camera.width / 2;
  const int middle_y = view_edges_->view().camera.height / 2;
  std::int64_t place = 0;
  for (const EdgePixel& pixel : pixels) {
    if (!all && !isOutline(pixel)) continue;
    const bool taken = place * wanted / available != (place + 1) * wanted / available;
    ++place;
    if (!taken) continue;
    points_[static_cast<std::size_t>(point_count_++)] = {
        static_cast<std::int16_t>(pixel.x - middle_x),
        static_cast<std::int16_t>(pixel.y - middle_y), pixel.normal_x, pixel.normal_y};
  }
}

void ObjectSearch::sumDistances(const RollDepth& change) {
  const double c = cosine(change.roll_rad);
  const double s = sine(change.roll_rad);
  std::fill_n(sums_.begin(), static_cast<std::size_t>(columns() * rows()), std::uint16_t{0});
  for (int i = 0; i < point_count_; ++i) {
    const Point& point = points_[static_cast<std::size_t>(i)];
    const int direction =
        edgeDirectionOf(nearest(16.0 * (c * point.normal_x - s * point.normal_y)),
                        nearest(16.0 * (s * point.normal_x + c * point.normal_y)));
    addPlace(direction, nearest((c * point.x - s * point.y) / change.depth_ratio),
             nearest((s * point.x + c * point.y) / change.depth_ratio));
  }
  poses_ += columns() * rows();
}

/// Adds the distances of one place for all slides; outside the image the mean of the map counts.
void ObjectSearch::addPlace(int direction, int x, int y) {
  const DirectedEdges& edges = view_edges_->edges();
  const auto index = static_cast<std::size_t>(direction);
  const std::uint8_t mean = mean_[index];
  const int left = edges.width / 2 + x - grid_.slide_x_px;
  const int top = edges.height / 2 + y - grid_.slide_y_px;
  const int first = std::clamp(-left, 0, columns());
  const int end = std::clamp(edges.width - left, first, columns());
  for (int row = 0; row < rows(); ++row) {
    std::uint16_t* sum = sums_.data() + row * columns();
    const auto addMean = [&](int from, int to) {
      for (int k = from; k < to; ++k) sum[k] = static_cast<std::uint16_t>(sum[k] + mean);
    };
    const int y_px = top + row;
    if (y_px < 0 || y_px >= edges.height) {
      addMean(0, columns());
      continue;
    }
    const std::uint8_t* row_of_map = maps_[index].data() + y_px * edges.width;
    addMean(0, first);
    for (int k = first; k < end; ++k)
      sum[k] = static_cast<std::uint16_t>(sum[k] + row_of_map[left + k]);
    addMean(end, columns());
  }
}

/// Whether no neighbouring slide is better.
bool ObjectSearch::isPeak(int x, int y) const {
  const std::uint16_t* sum = sums_.data() + y * columns() + x;
  for (int dy = y > 0 ? -1 : 0; dy <= (y + 1 < rows() ? 1 : 0); ++dy)
    for (int dx = x > 0 ? -1 : 0; dx <= (x + 1 < columns() ? 1 : 0); ++dx)
      if (sum[dy * columns() + dx] < *sum) return false;
  return true;
}

void ObjectSearch::takePeaks(const RollDepth& change) {
  const double unit_px = kDistanceUnit_px / point_count_;
  for (int y = 0; y < rows(); ++y) {
    for (int x = 0; x < columns(); ++x) {
      const double distance_px = unit_px * sums_[static_cast<std::size_t>(y * columns() + x)];
      if (!found_.accepts(distance_px) || !isPeak(x, y)) continue;
      SearchCandidate candidate;
      candidate.distance_px = distance_px;
      candidate.tilt_x_rad = tiltX_rad();
      candidate.tilt_y_rad = tiltY_rad();
      candidate.roll_rad = change.roll_rad;
      candidate.depth_ratio = change.depth_ratio;
      candidate.slide_x_px = x - grid_.slide_x_px;
      candidate.slide_y_px = y - grid_.slide_y_px;
      candidate.camera_from_station = poseOf(candidate);
      if (isWithinSeed(candidate.camera_from_station)) found_.insert(candidate);
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
  // Beside a large turn a tilt is a longer rotation vector than alone.
  const double half_rad = 0.5 * std::sqrt(offset.head<3>().squaredNorm());
  const double longer = half_rad > 0.1 ? half_rad / sine(std::min(half_rad, 0.5 * kPi)) : 1.0;
  // Half a step of the grid more.
  const double step_m = depth_m_ * (1.5 / view_edges_->view().camera.fx + 0.5 * kDepth);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(offset[i]) > longer * kBeyond * seed.rotation_rad[i] + 0.5 * kTilt_rad)
      return false;
    if (std::abs(offset[i + 3]) > kBeyond * seed.translation_m[i] + step_m) return false;
  }
  return true;
}

}  // namespace boresight
