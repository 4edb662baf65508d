// SPDX-License-Identifier: Apache-2.0
#include "core/search/pose_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/search/pose_evidence.h"

namespace boresight {
namespace {

/// One scale of the refinement: the object's size, and the search radius of each render.
struct Level {
  double span_px = 0.0;
  int passes = 0;
  std::array<double, 3> radius_px{};
};
/// Scales grow by 1.8: what one leaves is within the next one's radius.
constexpr std::array<Level, 3> kLevels = {{
    {88.0, 3, {6.0, 4.0, 3.0}},
    {158.0, 2, {5.0, 3.0, 0.0}},
    {285.0, 2, {4.0, 3.0, 0.0}},
}};
constexpr int kMeasuring = static_cast<int>(kLevels.size());
constexpr double kMargin = 0.1;  ///< around the object, of its size
/// Poses that differ by less in the search's view, after they were refined there, are the same.
constexpr double kSame_px = 1.2;
/// Candidates behind the best by more than this are not refined further.
constexpr double kBehind_nats = 0.35;
/// Error that the last scale leaves, px of its view.
constexpr double kRemaining_px = 1.5;
/// A candidate of so much evidence needs no other beside it.
constexpr double kConvincing_nats = 0.75;
constexpr double kConvincingWeakest_nats = 0.45;

}  // namespace

Status PoseSearch::create(Arena& arena) {
  constexpr auto kPixels = static_cast<std::size_t>(kLongestView_px) * kLongestView_px;
  view_edges_.create(kLongestView_px, arena);
  render_ = createEdgeRender(kLongestView_px, kLongestView_px, kMaxEdgePixels, arena);
  // The search is over when the refinement begins.
  const std::size_t start = arena.mark();
  search_.create(arena);
  const std::size_t end = arena.mark();
  arena.rewind(start);
  if (refinement_.create(arena) != Status::kOk) return Status::kArenaTooSmall;
  meter_.create(kPixels, arena);
  arena.rewind(std::max(end, arena.mark()));
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

bool PoseSearch::begin(const SearchProblem& problem, EdgeRenderer& renderer) {
  problem_ = problem;
  renderer_ = &renderer;
  count_ = tried_count_ = 0;
  next_ = 0;
  rendering_ = false;
  phase_ = Phase::kSearch;
  if (search_.begin(problem_, view_edges_, renderer, render_)) return true;
  phase_ = Phase::kDone;
  return false;
}

bool PoseSearch::step() {
  switch (phase_) {
    case Phase::kSearch:
      return search_.step() ? !beginTrial() : false;
    case Phase::kView:
      if (!view_edges_.step()) return false;
      view_from_station_ = view_edges_.inView(now_.camera_from_station);
      phase_ = Phase::kRender;
      rendering_ = false;
      return false;
    case Phase::kRender:
      return stepRender();
    case Phase::kRefine:
      return refine();
    case Phase::kMeasure:
      return measure();
    case Phase::kDone:
      break;
  }
  return true;
}

/// The next pose of the search, in the search's view. False when there is none left.
bool PoseSearch::beginTrial() {
  const std::span<const SearchCandidate> found = search_.candidates();
  if (next_ >= std::min<int>(static_cast<int>(found.size()), kMostTried)) {
    next_ = 0;
    return beginCandidate();
  }
  now_ = {};
  now_.found = found[static_cast<std::size_t>(next_++)];
  view_from_station_ = view_edges_.inView(now_.found.camera_from_station);
  level_ = 0;
  pass_ = 0;
  phase_ = Phase::kRender;
  return true;
}

bool PoseSearch::endTrial() {
  now_.camera_from_station = view_edges_.inCamera(view_from_station_);
  now_.error_px = kRemaining_px / view_edges_.view().pixels_per_px;
  // The last render is from close by.
  measureRender();
  int kept = 0;
  for (int i = 0; i < tried_count_; ++i) {
    const PoseCandidate& other = tried_[static_cast<std::size_t>(i)];
    const bool same = isSame(other.camera_from_station, now_.camera_from_station);
    if (same && other.rank_nats() >= now_.rank_nats()) return beginTrial();
    if (!same) tried_[static_cast<std::size_t>(kept++)] = other;
  }
  int place = kept;
  for (; place > 0 && tried_[static_cast<std::size_t>(place - 1)].rank_nats() < now_.rank_nats();
       --place)
    tried_[static_cast<std::size_t>(place)] = tried_[static_cast<std::size_t>(place - 1)];
  tried_[static_cast<std::size_t>(place)] = now_;
  tried_count_ = kept + 1;
  return beginTrial();
}

/// Whether two poses show the corners of the scene's box at about the same places.
bool PoseSearch::isSame(const Pose& one, const Pose& other) const {
  const BoundingBox& box = problem_.scene;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? box.maximum_m.x() : box.minimum_m.x(),
                                 (i & 2) != 0 ? box.maximum_m.y() : box.minimum_m.y(),
                                 (i & 4) != 0 ? box.maximum_m.z() : box.minimum_m.z());
    Eigen::Vector2d first;
    Eigen::Vector2d second;
    if (!project(view_edges_.view().camera, view_edges_.inView(one) * corner, first) ||
        !project(view_edges_.view().camera, view_edges_.inView(other) * corner, second) ||
        !((first - second).squaredNorm() < kSame_px * kSame_px))
      return false;
  }
  return true;
}

/// The next of those tried. False when there is none left.
bool PoseSearch::beginCandidate() {
  while (next_ < std::min(tried_count_, kMaxCandidates)) {
    now_ = tried_[static_cast<std::size_t>(next_++)];
    if (now_.rank_nats() < tried_[0].rank_nats() - kBehind_nats) break;
    level_ = 1;
    if (beginLevel()) return true;
  }
  phase_ = Phase::kDone;
  return false;
}

bool PoseSearch::beginLevel() {
  ViewSize size = evidenceViewSize();
  if (level_ < kMeasuring) {
    size.span_px = kLevels[static_cast<std::size_t>(level_)].span_px;
    size.margin_px = kMargin * size.span_px;
    size.most_px = kLongestView_px;
  }
  pass_ = 0;
  phase_ = Phase::kView;
  return view_edges_.begin(problem_, now_.camera_from_station, size);
}

bool PoseSearch::stepRender() {
  bool complete = false;
  Status status = Status::kOk;
  if (!rendering_)
    status = renderer_->begin(view_edges_.rays(), view_from_station_, render_);
  else
    status = renderer_->stepWhole(complete);
  rendering_ = status == Status::kOk && !complete;
  if (rendering_) return false;
  if (status != Status::kOk) return level_ == 0 ? !beginTrial() : !beginCandidate();
  phase_ = level_ == kMeasuring ? Phase::kMeasure : Phase::kRefine;
  return false;
}

/// The seed with its uncertainty as a Gaussian, in the view.
PosePrior PoseSearch::prior() const {
  const SeedUncertainty& seed = problem_.uncertainty;
  const Eigen::Matrix3d turn = view_edges_.view().view_from_camera.matrix();
  const Eigen::Matrix3d squared = turn.cwiseProduct(turn);
  const auto turned = [&](const Eigen::Vector3d& box) {
    return Eigen::Vector3d(kUniformSigma * (squared * box.cwiseProduct(box)).cwiseSqrt());
  };
  PosePrior prior;
  prior.camera_from_station = view_edges_.inView(problem_.camera_from_station_seed);
  prior.sigma = {turned(seed.translation_m), turned(seed.rotation_rad),
                 turn * seed.pivot_in_camera_m};
  return prior;
}

bool PoseSearch::refine() {
  const Level& level = kLevels[static_cast<std::size_t>(level_)];
  const double radius_px = level.radius_px[static_cast<std::size_t>(pass_)];
  const bool moved = refinement_.refine(view_edges_.edges(), problem_.mesh, render_, prior(),
                                        radius_px, view_from_station_);
  phase_ = Phase::kRender;
  if (moved && ++pass_ < level.passes) return false;
  if (level_ == 0) return !endTrial();
  now_.camera_from_station = view_edges_.inCamera(view_from_station_);
  if (moved) now_.error_px = kRemaining_px / view_edges_.view().pixels_per_px;
  ++level_;
  return beginLevel() ? false : !beginCandidate();
}

void PoseSearch::measureRender() {
  meter_.clear();
  addPlaces(render_, meter_);
  now_.evidence = meter_.measure(view_edges_.edges(), view_edges_.view().span_px);
}

bool PoseSearch::measure() {
  measureRender();
  int place = count_++;
  for (;
       place > 0 && candidates_[static_cast<std::size_t>(place - 1)].rank_nats() < now_.rank_nats();
       --place)
    candidates_[static_cast<std::size_t>(place)] = candidates_[static_cast<std::size_t>(place - 1)];
  candidates_[static_cast<std::size_t>(place)] = now_;
  if (!isConvincing(candidates_[0])) return !beginCandidate();
  phase_ = Phase::kDone;
  return true;
}

bool PoseSearch::isConvincing(const PoseCandidate& candidate) const {
  return candidate.evidence.strongest_nats() > kConvincing_nats &&
         candidate.evidence.weakest_nats() > kConvincingWeakest_nats;
}

}  // namespace boresight
