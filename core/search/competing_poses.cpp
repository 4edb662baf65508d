// SPDX-License-Identifier: Apache-2.0
#include "core/search/competing_poses.h"

#include <algorithm>
#include <cmath>

#include "core/edges/direction_distance.h"
#include "core/search/compass_search.h"
#include "core/search/pose_evidence.h"

namespace boresight {
namespace {

/// The object's size, and the search radius of each render.
struct Scale {
  double span_px = 0.0;
  int passes = 0;
  std::array<double, 3> radius_px{};
};
constexpr std::array<Scale, 3> kScales = {{
    {88.0, 3, {6.0, 4.0, 3.0}},
    {158.0, 2, {5.0, 3.0, 0.0}},
    {kEvidenceSpan_px, 2, {4.0, 3.0, 0.0}},
}};
constexpr int kLastScale = static_cast<int>(kScales.size()) - 1;
constexpr double kMargin = 0.1;  ///< around the object, of its size

/// Competing poses whose evidence is lower by more than this are not refined; not refined further.
constexpr double kBehind_nats = 0.6;
constexpr double kBehindRefined_nats = 0.25;
/// A place counts as common when the other pose has a place within this distance, kDistanceUnit_px.
constexpr int kSamePlace = 30;
/// Two renders differ visibly when each has at least this share of places without a counterpart.
constexpr double kVisible = 0.1;
constexpr double kAlong = 8.0;  ///< edge pixels that go together

/// Slides shorter than this, of the view's pixels, are refined to the pose found.
constexpr int kShortestSlide_px = 4;
/// A pose counts as slid when the object's centre is farther from that of the pose found, as a
/// share of the object's size.
constexpr double kSlid = 0.05;
/// Slides whose mean distance of the outline from the render's edges is larger are left out.
constexpr double kAlike_px = 2.0;
/// Slides of a view, px to either side.
constexpr int kLongestSlide_px = 36;

/// Largest motion of a pose by the refinement, as shares of the object's size.
constexpr double kLateral = 0.1;
constexpr double kDepth = 0.2;
constexpr double kRotation_rad = 0.3;

constexpr int kSweeps = 12;  ///< of Jacobi's rotations: convergence is quadratic

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

/// Makes the element (p, q) of a symmetric matrix 0 (Jacobi 1846).
void rotateToDiagonal(int p, int q, Eigen::Matrix3d& matrix, Eigen::Matrix3d& axes) {
  if (matrix(p, q) == 0.0) return;
  const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * matrix(p, q));
  const double sign = theta < 0.0 ? -1.0 : 1.0;
  const double tangent = sign / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(p, p) = turn(q, q) = cosine;
  turn(p, q) = tangent * cosine;
  turn(q, p) = -tangent * cosine;
  matrix = (turn.transpose() * matrix * turn).eval();
  matrix(p, q) = matrix(q, p) = 0.0;
  axes = (axes * turn).eval();
}

}  // namespace

SurfaceAxes surfaceAxesOf(const MeshView& mesh) {
  const auto vertexOf = [&](const Face& face, std::size_t corner) {
    const auto index = static_cast<std::size_t>(face.vertex[corner]);
    return Eigen::Vector3d(mesh.vertices_in_station_m[index].cast<double>());
  };
  const auto forMatched = [&](auto&& take) {
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      if (!mesh.parts[mesh.part_of_face[i]].match) continue;
      const Face& face = mesh.faces[i];
      const std::array<Eigen::Vector3d, 3> corners = {vertexOf(face, 0), vertexOf(face, 1),
                                                      vertexOf(face, 2)};
      take(corners, (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm());
    }
  };
  using Corners = std::array<Eigen::Vector3d, 3>;
  SurfaceAxes surface_axes;
  double area = 0.0;
  forMatched([&](const Corners& corners, double weight) {
    surface_axes.middle_m += weight / 3.0 * (corners[0] + corners[1] + corners[2]);
    area += weight;
  });
  if (!(area > 0.0)) return surface_axes;
  surface_axes.middle_m /= area;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  // The second moment of a triangle about a point is area / 12 times this.
  forMatched([&](const Corners& corners, double weight) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners) {
      const Eigen::Vector3d from = corner - surface_axes.middle_m;
      spread += weight / area * from * from.transpose();
      sum += from;
    }
    spread += weight / area * sum * sum.transpose();
  });
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotateToDiagonal(0, 1, spread, surface_axes.axes);
    rotateToDiagonal(0, 2, spread, surface_axes.axes);
    rotateToDiagonal(1, 2, spread, surface_axes.axes);
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return spread(a, a) < spread(b, b) || (spread(a, a) == spread(b, b) && a < b);
  });
  const Eigen::Matrix3d axes = surface_axes.axes;
  for (int i = 0; i < 3; ++i)
    surface_axes.axes.col(i) = axes.col(order[static_cast<std::size_t>(i)]);
  return surface_axes;
}

Status CompetingPoseTest::create(int channels, Arena& arena) {
  constexpr auto kPixels = static_cast<std::size_t>(kLongestView_px) * kLongestView_px;
  (void)view_edges_.create(kLongestView_px, channels, arena);  // its memory is not shared
  render_ = createEdgeRender(kLongestView_px, kLongestView_px, kMaxEdgePixels, arena);
  own_.marks.direction = arena.allocate<std::uint8_t>(kPixels);
  other_.marks.direction = arena.allocate<std::uint8_t>(kPixels);
  // A render is measured before places are compared.
  const std::size_t start = arena.mark();
  if (refinement_.create(arena) != Status::kOk) return Status::kArenaTooSmall;
  meter_.create(kPixels, arena);
  const std::size_t measured = arena.mark();
  arena.rewind(start);
  sums_.create(arena);  // used before
  const std::size_t end = std::max(measured, arena.mark());
  arena.rewind(start);
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
  count_ = promising_.count = competitor_ = 0;
  scale_ = 0;
  beginView(kScales[0].span_px, Purpose::kFound);
  return phase_ != Phase::kDone;
}

bool CompetingPoseTest::step() {
  switch (phase_) {
    case Phase::kView:
      if (view_edges_.step()) {
        const bool finds = purpose_ == Purpose::kFound || purpose_ == Purpose::kFoundAgain;
        if (!finds)
          current_ = view_edges_.inView(promising_.poses[static_cast<std::size_t>(competitor_)]);
        beginRender(finds ? view_edges_.inView(found_) : current_, purpose_);
      }
      break;
    case Phase::kMaps:
      stepMaps();
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
  size.margin_px = kMargin * span_px + (slides ? kLongestSlide_px : 0);
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
  bool complete = false;
  const Status status = rendering_ ? renderer_->stepWhole(complete)
                                   : renderer_->begin(view_edges_.rays(), current_, render_);
  rendering_ = status == Status::kOk && !complete;
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
        promising_.add(view_edges_.inCamera(current_));
        return nextHypothesis();
      }
      pass_ = 0;
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

/// Lists the turned hypotheses; the maps for the slid ones follow.
void CompetingPoseTest::takeFound() {
  found_rank_nats_ = rankOfRender();
  markRender(own_.marks);
  const SurfaceAxes surface = surfaceAxesOf(problem_.mesh);
  const Eigen::Vector3d middle_m = current_ * surface.middle_m;
  const Eigen::Matrix3d axes = current_.matrix() * surface.axes;
  poses_.count = 0;
  for (int i = 0; i < 3; ++i) poses_.add(turnedAbout(middle_m, halfTurn(axes.col(i)), current_));
  const Eigen::Matrix3d about_sight = halfTurn(middle_m.normalized());
  const Eigen::Vector3d normal = about_sight * axes.col(0);
  poses_.add(turnedAbout(middle_m, halfTurn(normal) * about_sight, current_));
  const Camera& camera = view_edges_.view().camera;
  sums_.begin(camera.width, camera.height, kLongestSlide_px, kLongestSlide_px);
  direction_ = 0;
  phase_ = Phase::kMaps;
}

void CompetingPoseTest::stepMaps() {
  sums_.takeMap(own_.marks, direction_);
  if (++direction_ < kEdgeDirections) return;
  takeSlides();
  hypothesis_ = -1;
  nextHypothesis();
}

/// Slides the outline of the pose found over its own render, and takes the slides with the least
/// distance that are apart from each other.
void CompetingPoseTest::takeSlides() {
  const Camera& camera = view_edges_.view().camera;
  std::array<SlideSums::Place, SlideSums::kMaxPlaces> places;
  std::size_t count = 0;
  takeEvenly(render_, [&](const EdgePixel& pixel) {
    places[count++] = {static_cast<std::int16_t>(pixel.x - camera.width / 2),
                       static_cast<std::int16_t>(pixel.y - camera.height / 2),
                       static_cast<std::uint8_t>(edgeDirectionOf(pixel.normal_x, pixel.normal_y))};
  });
  sums_.add(std::span(places).first(count));
  const int middle_x = sums_.columns() / 2;
  const int middle_y = sums_.rows() / 2;
  const double most = kAlike_px / SlideSums::kStep_px * static_cast<double>(count);
  std::array<Eigen::Vector2i, kMostSlides + 1> taken = {Eigen::Vector2i(middle_x, middle_y)};
  const double depth_m = (current_ * problem_.scene.centre()).z();
  for (int slides = 1; slides <= kMostSlides; ++slides) {
    Eigen::Vector2i& best = taken[static_cast<std::size_t>(slides)];
    if (!bestSlide(std::span(taken).first(static_cast<std::size_t>(slides)), most, best)) break;
    Pose slid = current_;
    slid.translation_m.x() += (best.x() - middle_x) * depth_m / camera.fx;
    slid.translation_m.y() += (best.y() - middle_y) * depth_m / camera.fy;
    poses_.add(slid);
  }
}

/// The peak with the least sum that is apart from those taken; false where none is within `most`.
bool CompetingPoseTest::bestSlide(std::span<const Eigen::Vector2i> taken, double most,
                                  Eigen::Vector2i& best) const {
  double least = most;
  bool found = false;
  for (int row = 0; row < sums_.rows(); ++row) {
    for (int column = 0; column < sums_.columns(); ++column) {
      if (sums_.sum(column, row) > least || !sums_.isPeak(column, row)) continue;
      const Eigen::Vector2i slide(column, row);
      const bool is_apart = std::all_of(taken.begin(), taken.end(), [&](const auto& other) {
        return (slide - other).squaredNorm() >= kShortestSlide_px * kShortestSlide_px;
      });
      if (!is_apart || (found && sums_.sum(column, row) >= least)) continue;
      best = slide;
      least = sums_.sum(column, row);
      found = true;
    }
  }
  return found;
}

/// Moves the hypothesis towards the image's edges, from its render.
void CompetingPoseTest::refine() {
  const Scale& scale = kScales[static_cast<std::size_t>(scale_)];
  Pose moved = current_;
  const bool met =
      refinement_.refine(view_edges_.edges(), problem_.mesh, render_, priorOf(current_),
                         scale.radius_px[static_cast<std::size_t>(pass_)], moved);
  if (!met) return scale_ == 0 ? nextHypothesis() : nextPromising();
  current_ = moved;
  if (++pass_ < scale.passes) return beginRender(current_, Purpose::kRefine);
  if (scale_ == 0) {
    refined_ = true;
    return beginRender(current_, Purpose::kScreen);
  }
  promising_.poses[static_cast<std::size_t>(competitor_)] = view_edges_.inCamera(current_);
  if (scale_ == kLastScale) return beginRender(current_, Purpose::kCompeting);
  pass_ = 0;
  ++scale_;
  beginView(kScales[static_cast<std::size_t>(scale_)].span_px, Purpose::kRefine);
}

void CompetingPoseTest::nextHypothesis() {
  if (++hypothesis_ < poses_.count) {
    refined_ = false;
    return beginRender(poses_.poses[static_cast<std::size_t>(hypothesis_)], Purpose::kScreen);
  }
  competitor_ = -1;
  nextPromising();
}

void CompetingPoseTest::nextPromising() {
  phase_ = Phase::kDone;
  if (++competitor_ >= promising_.count) return;
  scale_ = 1;
  pass_ = 0;
  beginView(kScales[1].span_px, Purpose::kRefine);
}

double CompetingPoseTest::rankOfRender() {
  meter_.clear();
  addPlaces(render_, meter_);
  const ContourEvidence evidence = meter_.measure(view_edges_.edges(), view_edges_.view().span_px);
  return evidence.strongest_nats() + 0.5 * evidence.weakest_nats();
}

void CompetingPoseTest::markRender(DirectedEdges& marks) const {
  marks.width = render_.edges.width;
  marks.height = render_.edges.height;
  const auto pixels = static_cast<std::ptrdiff_t>(marks.width) * marks.height;
  std::fill(marks.direction.begin(), marks.direction.begin() + pixels, DirectedEdges::kNone);
  for (std::int32_t i = 0; i < render_.pixel_count; ++i) {
    const EdgePixel& pixel = render_.pixels[static_cast<std::size_t>(i)];
    marks.direction[static_cast<std::size_t>(pixel.y * marks.width + pixel.x)] =
        static_cast<std::uint8_t>(edgeDirectionOf(pixel.normal_x, pixel.normal_y));
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
      if (apart_[static_cast<std::size_t>(y * places.width + x)] <= kSamePlace) continue;
      ++prediction.alone;
      const EvidencePlace place{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                                static_cast<std::uint8_t>(direction_)};
      prediction.nats += evidenceOfPlace_nats(place, image, distance_, window_px);
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
  // A slid pose competes even when it shows the same edges: the object's ends are out of view.
  if (least >= kVisible || slid_px() >= kSlid * view_edges_.view().span_px) {
    CompetingPose& pose = competing_[static_cast<std::size_t>(count_++)];
    pose.camera_from_station = promising_.poses[static_cast<std::size_t>(competitor_)];
    pose.similarity = 1.0 - 0.5 * (own_.share() + other_.share());
    pose.margin_nats = (own_.nats - other_.nats) / kAlong;
  }
  nextPromising();
}

/// Distance of the object's centre from that of the pose found, px of the view.
double CompetingPoseTest::slid_px() const {
  const Pose& camera_from_station = promising_.poses[static_cast<std::size_t>(competitor_)];
  const Eigen::Vector3d found_m = view_edges_.inView(found_) * problem_.scene.centre();
  const Eigen::Vector3d other_m = view_edges_.inView(camera_from_station) * problem_.scene.centre();
  return view_edges_.view().camera.fx *
         (found_m.head<2>() / found_m.z() - other_m.head<2>() / other_m.z()).norm();
}

PosePrior CompetingPoseTest::priorOf(const Pose& view_from_station) const {
  const double size_m = problem_.scene.diagonal();
  PosePrior prior;
  prior.camera_from_station = view_from_station;
  prior.sigma.translation_m = size_m * Eigen::Vector3d(kLateral, kLateral, kDepth);
  prior.sigma.rotation_rad.setConstant(kRotation_rad);
  prior.sigma.pivot_in_camera_m = view_from_station * problem_.scene.centre();
  return prior;
}

}  // namespace boresight
