// SPDX-License-Identifier: Apache-2.0
#include "core/search/competing_poses.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/edges/direction_distance.h"
#include "core/geometry/surface_axes.h"
#include "core/search/pose_evidence_meter.h"

namespace boresight {
namespace {

/// The object's size, and the search radius of its refinement.
struct Scale {
  double span_px = 0.0;
  double radius_px = 0.0;
};
constexpr std::array<Scale, 3> kScales = {{{88.0, 6.0}, {158.0, 5.0}, {kEvidenceSpan_px[0], 4.0}}};
constexpr int kLastScale = static_cast<int>(kScales.size()) - 1;

/// Competing poses whose evidence is lower by more than this are not refined; not refined further.
constexpr double kBehind_nats = 0.6;
constexpr double kBehindRefined_nats = 0.25;
/// A place counts as common when the other pose has a place within this distance, kDistanceUnit_px.
constexpr int kSamePlace = 30;
/// Two renders differ visibly when each has at least this share of places without a counterpart.
constexpr double kVisible = 0.1;

/// A pose counts as slid when the object's centre is farther from that of the pose found, as a
/// share of the object's size.
constexpr double kSlid = 0.05;
/// Largest motion of a pose by the refinement, as shares of the object's size.
constexpr double kWidestLateral = 0.1;
constexpr double kWidestDepth = 0.2;
constexpr double kWidestRotation_rad = 0.3;

Eigen::Matrix3d halfTurn(const Eigen::Vector3d& axis) {
  return 2.0 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
}

/// The pose turned about a point of its frame.
Pose turnedAbout(const Eigen::Vector3d& point_m, const Eigen::Matrix3d& turn, const Pose& pose) {
  Pose turned;
  turned.rotation = Eigen::Quaterniond(Eigen::Matrix3d(turn * pose.matrix())).normalized();
  turned.translation_m = point_m + turn * (pose.translation_m - point_m);
  return turned;
}

}  // namespace

Status CompetingPoseTest::create(int channels, Arena& arena) {
  constexpr auto kPixels = static_cast<std::size_t>(kLongestView_px) * kLongestView_px;
  (void)view_edges_.create(kLongestView_px, channels, arena);  // its memory is not shared
  render_ = createEdgeRender(kLongestView_px, kLongestView_px, kMaxEdgePixels, arena);
  own_.marks.direction = arena.allocate<std::uint8_t>(kPixels);
  // A render is measured before places are compared; the marks of a competing pose are made after
  // its last measurement.
  const std::size_t start = arena.mark();
  if (refinement_.create(arena) != Status::kOk) return Status::kArenaTooSmall;
  // The hypotheses of the first view are measured one after the other.
  constexpr auto kFirst_px = static_cast<std::size_t>(SlideSums::kMaxView_px);
  meter_.create(std::max(kPixels, kEdgeDirections * kFirst_px * kFirst_px), arena);
  const std::size_t measured = arena.mark();
  arena.rewind(start);
  slides_.create(arena);  // used before
  const std::size_t end = std::max(measured, arena.mark());
  arena.rewind(start);
  other_.marks.direction = arena.allocate<std::uint8_t>(kPixels);
  distance_ = arena.allocate<std::uint8_t>(kPixels);
  apart_ = arena.allocate<std::uint8_t>(kPixels);
  arena.rewind(std::max(end, arena.mark()));
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

bool CompetingPoseTest::begin(const SearchProblem& problem, const Pose& camera_from_station,
                              EdgeRenderer& renderer) {
  problem_ = problem;
  renderer_ = &renderer;
  found_ = camera_from_station;
  competing_.clear();
  promising_.clear();
  competitor_ = 0;
  scale_ = 0;
  beginView(kScales[0].span_px, Purpose::kFound);
  return phase_ != Phase::kDone;
}

bool CompetingPoseTest::step() {
  switch (phase_) {
    case Phase::kView:
      if (view_edges_.step()) {
        meter_.begin(view_edges_.edges());
        const bool finds = purpose_ == Purpose::kFound;
        beginRender(finds ? view_edges_.inView(found_) : promising_[competitor_], purpose_);
      }
      break;
    case Phase::kSlides:
      stepSlides();
      break;
    case Phase::kRender:
      stepRender();
      break;
    case Phase::kCompare:
      compareDirection();
      break;
    case Phase::kDone:
      break;
  }
  return phase_ == Phase::kDone;
}

/// Faces the pose found at a scale.
void CompetingPoseTest::beginView(double span_px, Purpose purpose) {
  ViewSize size;
  size.span_px = span_px;
  const bool slides = purpose == Purpose::kFound;
  size.margin_px = kViewMargin * span_px + (slides ? SelfSlides::kLongest_px : 0);
  size.most_px = slides ? SlideSums::kMaxView_px : kLongestView_px;
  purpose_ = purpose;
  phase_ = view_edges_.begin(problem_, found_, size) ? Phase::kView : Phase::kDone;
}

void CompetingPoseTest::beginRender(const Pose& view_from_station, Purpose purpose) {
  current_ = view_from_station;
  purpose_ = purpose;
  rendering_ = false;
  phase_ = Phase::kRender;
}

void CompetingPoseTest::stepRender() {
  const Status status = view_edges_.render(*renderer_, current_, render_, rendering_);
  if (rendering_) return;
  if (status == Status::kOk)
    takeRender();
  else if (purpose_ == Purpose::kFound)
    phase_ = Phase::kDone;
  else if (scale_ == 0)
    nextHypothesis();
  else
    nextPromising();
}

void CompetingPoseTest::takeRender() {
  switch (purpose_) {
    case Purpose::kFound:
      takeFound();
      break;
    case Purpose::kScreen: {
      const double least = found_rank_nats_ - (refined_ ? kBehindRefined_nats : kBehind_nats);
      if (rankOfRender() < least) return nextHypothesis();
      if (refined_) {
        promising_.add(current_);
        return nextHypothesis();
      }
      refine();
      break;
    }
    case Purpose::kRefine:
      refine();
      break;
    case Purpose::kCompeting:
      markRender(other_.marks);
      beginRender(view_edges_.inView(found_), Purpose::kFoundAgain);
      break;
    case Purpose::kFoundAgain:
      markRender(own_.marks);
      own_.all = own_.alone = other_.all = other_.alone = 0;
      own_.nats = other_.nats = 0.0;
      direction_ = 0;
      phase_ = Phase::kCompare;
      break;
  }
}

/// Lists the turned hypotheses; the slid ones follow.
void CompetingPoseTest::takeFound() {
  found_rank_nats_ = rankOfRender();
  markRender(own_.marks);
  const SurfaceAxes surface = surfaceAxesOf(problem_.mesh);
  const Eigen::Vector3d middle_m = current_ * surface.middle_m;
  const Eigen::Matrix3d axes = current_.matrix() * surface.axes;
  poses_.clear();
  for (int i = 0; i < 3; ++i) poses_.add(turnedAbout(middle_m, halfTurn(axes.col(i)), current_));
  const Eigen::Matrix3d about_sight = halfTurn(middle_m.normalized());
  const Eigen::Vector3d normal = about_sight * axes.col(0);
  poses_.add(turnedAbout(middle_m, halfTurn(normal) * about_sight, current_));
  slides_.begin(render_, own_.marks);
  phase_ = Phase::kSlides;
}

/// Lists the slid hypotheses.
void CompetingPoseTest::stepSlides() {
  if (!slides_.step()) return;
  meter_.begin(view_edges_.edges());  // its memory was used
  const double depth_m = (current_ * problem_.scene.centre()).z();
  for (const Eigen::Vector2i& slide_px : slides_.slides_px()) {
    Pose slid = current_;
    slid.translation_m.head<2>() +=
        slide_px.cast<double>() * (depth_m / view_edges_.view().camera.fx);
    poses_.add(slid);
  }
  hypothesis_ = -1;
  nextHypothesis();
}

/// Moves the hypothesis towards the image's edges, from its render.
void CompetingPoseTest::refine() {
  const Scale& scale = nth(kScales, scale_);
  Pose moved = current_;
  refinement_.takePlaces(problem_.mesh, render_);
  const bool met =
      refinement_.refine(view_edges_.edges(), priorOf(current_), scale.radius_px, moved);
  if (!met) return scale_ == 0 ? nextHypothesis() : nextPromising();
  current_ = moved;
  if (scale_ == 0) {
    refined_ = true;
    return beginRender(current_, Purpose::kScreen);
  }
  promising_[competitor_] = current_;
  if (scale_ == kLastScale) return beginRender(current_, Purpose::kCompeting);
  ++scale_;
  beginView(nth(kScales, scale_).span_px, Purpose::kRefine);
}

void CompetingPoseTest::nextHypothesis() {
  if (++hypothesis_ < poses_.size()) {
    refined_ = false;
    return beginRender(poses_[hypothesis_], Purpose::kScreen);
  }
  competitor_ = -1;
  nextPromising();
}

void CompetingPoseTest::nextPromising() {
  phase_ = Phase::kDone;
  if (++competitor_ >= promising_.size()) return;
  scale_ = 1;
  beginView(kScales[1].span_px, Purpose::kRefine);
}

double CompetingPoseTest::rankOfRender() {
  takePlaces(render_, meter_);
  const ContourEvidence evidence = meter_.measure(view_edges_.view().span_px);
  return evidence.strongest_nats() + 0.5 * evidence.weakest_nats();
}

void CompetingPoseTest::markRender(DirectedEdges& marks) const {
  marks.width = render_.edges.width;
  marks.height = render_.edges.height;
  const auto pixels = static_cast<std::ptrdiff_t>(marks.width) * marks.height;
  std::fill(marks.direction.begin(), marks.direction.begin() + pixels, DirectedEdges::kNone);
  for (const EdgePixel& pixel : render_.eachPixel()) {
    nth(marks.direction, pixel.y * marks.width + pixel.x) =
        edgeDirectionOf(pixel.normal_x, pixel.normal_y);
  }
}

/// Places of the current direction without a counterpart in the other pose.
void CompetingPoseTest::addAlone(const DirectedEdges& others, Prediction& prediction) {
  const DirectedEdges& places = prediction.marks;
  const DirectedEdges& image = view_edges_.edges();
  distanceToDirection(others, direction_, apart_);
  const double window_px = kEvidenceWindow * view_edges_.view().span_px;
  for (int y = 0; y < places.height; ++y) {
    for (int x = 0; x < places.width; ++x) {
      if (places.at(x, y) != direction_ || image.at(x, y) == DirectedEdges::kUnseen) continue;
      ++prediction.all;
      if (nth(apart_, y * places.width + x) <= kSamePlace) continue;
      ++prediction.alone;
      const EvidencePlace place{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                                static_cast<std::uint8_t>(direction_)};
      prediction.nats += evidenceOfPlace(place, image, distance_, window_px).nats;
    }
  }
}

void CompetingPoseTest::compareDirection() {
  distanceToDirection(view_edges_.edges(), direction_, distance_);
  addAlone(other_.marks, own_);
  addAlone(own_.marks, other_);
  if (++direction_ == kEdgeDirections) conclude();
}

void CompetingPoseTest::conclude() {
  const double least = std::min(own_.share(), other_.share());
  const Pose camera_from_station = view_edges_.inCamera(promising_[competitor_]);
  // A slid pose competes even when it shows the same edges: the object's ends are out of view.
  if (least >= kVisible || slid_px(camera_from_station) >= kSlid * view_edges_.view().span_px) {
    competing_.add({camera_from_station, 1.0 - 0.5 * (own_.share() + other_.share()),
                    (own_.nats - other_.nats) / kAlongEdge_px, false});
  }
  nextPromising();
}

/// Distance of the object's centre at a pose from that of the pose found, px of the view.
double CompetingPoseTest::slid_px(const Pose& camera_from_station) const {
  const Eigen::Vector3d found_m = view_edges_.inView(found_) * problem_.scene.centre();
  const Eigen::Vector3d other_m = view_edges_.inView(camera_from_station) * problem_.scene.centre();
  return view_edges_.view().camera.fx *
         (found_m.head<2>() / found_m.z() - other_m.head<2>() / other_m.z()).norm();
}

PosePrior CompetingPoseTest::priorOf(const Pose& view_from_station) const {
  const double size_m = problem_.scene.diagonal();
  PosePrior prior;
  prior.camera_from_station = view_from_station;
  prior.sigma.translation_m =
      size_m * Eigen::Vector3d(kWidestLateral, kWidestLateral, kWidestDepth);
  prior.sigma.rotation_rad.setConstant(kWidestRotation_rad);
  prior.sigma.pivot_in_camera_m = view_from_station * problem_.scene.centre();
  return prior;
}

}  // namespace boresight
