// SPDX-License-Identifier: Apache-2.0
#include "core/search/pose_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/search/pose_evidence_meter.h"

namespace boresight {
namespace {

/// One scale of the refinement: the object's size, and the search radius of each pass.
struct Level {
  double span_px = 0.0;
  int passes = 0;
  std::array<double, 3> radius_px{};
};
/// Scales grow by 1.8: the error after one scale is within the next one's radius.
constexpr std::array<Level, 4> kLevels = {{
    {ObjectSearch::kSpan_px, 1, {4.0, 0.0, 0.0}},
    {88.0, 3, {6.0, 4.0, 3.0}},
    {158.0, 2, {5.0, 3.0, 0.0}},
    {285.0, 2, {4.0, 3.0, 0.0}},
}};
constexpr int kFinest = static_cast<int>(kLevels.size()) - 1;

/// A round: poses refined at some levels and compared by their evidence.
struct Round {
  int first_level = 0;
  int last_level = 0;
  int at_first = 0;  ///< poses before the search is suspended
  int most = 0;      ///< poses
  int least = 0;     ///< poses that are kept regardless of their evidence
  double behind_nats =
      0.0;  ///< other poses whose evidence is lower than the best by more are left out
};
constexpr std::array<Round, 4> kSearchRounds = {{
    {0, 0, 12, CandidateList::kCapacity, CandidateList::kCapacity, 0.0},
    {1, 1, 4, 10, 8, 0.5},
    {2, kFinest, 1, PoseSearch::kMaxCandidates, 5, 0.7},
    {1, kFinest, 1, 1, 1, 0.0},  // of the seed alone
}};
constexpr int kLastRound = 2;
constexpr int kSeedRound = 3;
/// Poses that differ by less, in the view of their refinement, count as the same.
constexpr double kSame_px = 1.2;
/// Error after the last scale, px of its view.
constexpr double kRemaining_px = 1.5;

}  // namespace

Status PoseSearch::create(int channels, Arena& arena) {
  constexpr auto kPixels = static_cast<std::size_t>(kLongestView_px) * kLongestView_px;
  phase_ = Phase::kDone;
  left_ = 0;
  // The edges are complete when something is rendered.
  const std::size_t after_edges = view_edges_.create(kLongestView_px, channels, arena);
  const std::size_t end_of_view = arena.mark();
  arena.rewind(after_edges);
  render_ = createEdgeRender(kLongestView_px, kLongestView_px, kMaxEdgePixels, arena);
  // The search is over when the refinement begins.
  const std::size_t start = arena.mark();
  search_.create(arena);
  const std::size_t end = arena.mark();
  arena.rewind(start);
  if (refinement_.create(arena) != Status::kOk) return Status::kArenaTooSmall;
  // The poses of the search's view are measured one after the other.
  constexpr auto kSearched_px = static_cast<std::size_t>(SlideSums::kMaxView_px);
  meter_.create(std::max(kPixels, kEdgeDirections * kSearched_px * kSearched_px), arena);
  arena.rewind(std::max({end_of_view, end, arena.mark()}));
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

bool PoseSearch::begin(const SearchProblem& problem, EdgeRenderer& renderer) {
  problem_ = problem;
  renderer_ = &renderer;
  kept_.clear();
  left_ = 0;
  rendering_ = resumed_ = false;
  phase_ = Phase::kSearch;
  if (search_.begin(problem_, view_edges_, renderer, render_)) return true;
  phase_ = Phase::kDone;
  return false;
}

bool PoseSearch::beginAtSeed(const SearchProblem& problem, EdgeRenderer& renderer) {
  problem_ = problem;
  renderer_ = &renderer;
  PoseCandidate seed;
  seed.camera_from_station = problem.camera_from_station_seed;
  found_.clear();
  found_.add(seed);
  left_ = 0;
  resumed_ = false;
  return beginRounds(found_, kSeedRound);
}

bool PoseSearch::step() {
  switch (phase_) {
    case Phase::kSearch:
      if (!search_.step()) return false;
      takeFound();
      return !beginRounds(found_, 0);
    case Phase::kView:
      if (!view_edges_.step()) return false;
      meter_.begin(view_edges_.edges());
      view_from_station_ = view_edges_.inView(current_.camera_from_station);
      phase_ = Phase::kRender;
      rendering_ = false;
      return false;
    case Phase::kRender:
      return stepRender();
    case Phase::kRefine:
      return refine();
    case Phase::kDone:
      break;
  }
  return true;
}

/// The poses of the search, for the first round.
void PoseSearch::takeFound() {
  meter_.begin(view_edges_.edges());
  found_.clear();
  for (const SearchCandidate& found : search_.candidates()) {
    PoseCandidate candidate;
    candidate.found = found;
    candidate.camera_from_station = found.camera_from_station;
    found_.add(candidate);
  }
}

bool PoseSearch::resume() {
  if (!isSuspended()) return false;
  resumed_ = true;
  left_ = 0;
  return beginRounds(found_, 0);
}

/// Begins with these poses at a round; false when no pose of this or a later round can be refined.
bool PoseSearch::beginRounds(const PoseList& waiting, int round) {
  beginRound(waiting, round);
  return beginNext();
}

void PoseSearch::beginRound(const PoseList& waiting, int round) {
  waiting_ = waiting;  // first: `waiting` may be kept_
  kept_.clear();
  round_ = round;
  next_ = 0;
}

/// Poses of the round that are refined, unless their evidence is too low.
int PoseSearch::most() const {
  const Round& round = nth(kSearchRounds, round_);
  return std::min(waiting_.size(), resumed_ ? round.most : round.at_first);
}

/// Starts the next waiting pose; false when none is left and all rounds are over.
bool PoseSearch::beginNext() {
  for (;;) {
    const Round& round = nth(kSearchRounds, round_);
    while (next_ < most()) {
      current_ = waiting_[next_++];
      if (next_ > round.least && current_.rank_nats() < waiting_[0].rank_nats() - round.behind_nats)
        break;
      level_ = round.first_level;
      if (beginLevel()) return true;
    }
    left_ += waiting_.size() - most();
    if (round_ >= kLastRound) break;
    beginRound(kept_, round_ + 1);
  }
  phase_ = Phase::kDone;
  return false;
}

/// Inserts the refined pose by its evidence. Of equal poses the one with more evidence is kept.
bool PoseSearch::keep() {
  const bool is_last = round_ == kLastRound;
  int kept = 0;
  for (int i = 0; i < kept_.size(); ++i) {
    const PoseCandidate& kept_pose = kept_[i];
    const bool same =
        !is_last && isSame(kept_pose.camera_from_station, current_.camera_from_station);
    if (same && kept_pose.rank_nats() >= current_.rank_nats()) return !beginNext();
    if (!same) kept_[kept++] = kept_pose;
  }
  kept_.keepFirst(kept);
  int place = kept;
  while (place > 0 && kept_[place - 1].rank_nats() < current_.rank_nats()) --place;
  kept_.insert(place, current_);
  return !beginNext();
}

bool PoseSearch::isKept(const Pose& camera_from_station) const {
  const std::span<const PoseCandidate> kept = kept_.items();
  return std::any_of(kept.begin(), kept.end(), [&](const PoseCandidate& candidate) {
    return isSame(candidate.camera_from_station, camera_from_station);
  });
}

/// Whether two poses show the corners of the scene's box at about the same places.
bool PoseSearch::isSame(const Pose& first_pose, const Pose& second_pose) const {
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = problem_.scene.corner(i);
    Eigen::Vector2d first;
    Eigen::Vector2d second;
    if (!project(view_edges_.view().camera, view_edges_.inView(first_pose) * corner, first) ||
        !project(view_edges_.view().camera, view_edges_.inView(second_pose) * corner, second) ||
        !((first - second).squaredNorm() < kSame_px * kSame_px))
      return false;
  }
  return true;
}

bool PoseSearch::beginLevel() {
  pass_ = 0;
  rendering_ = false;
  if (level_ == 0 && resumed_ && next_ == 1) {
    phase_ = Phase::kView;
    return search_.beginView();
  }
  if (level_ == 0) {  // in the same view
    view_from_station_ = view_edges_.inView(current_.camera_from_station);
    phase_ = Phase::kRender;
    return true;
  }
  ViewSize size;
  size.span_px = nth(kLevels, level_).span_px;
  size.margin_px = kViewMargin * size.span_px;
  size.most_px = kLongestView_px;
  phase_ = Phase::kView;
  return view_edges_.begin(problem_, current_.camera_from_station, size);
}

bool PoseSearch::stepRender() {
  const Status status = view_edges_.render(*renderer_, view_from_station_, render_, rendering_);
  if (rendering_) return false;
  if (status != Status::kOk) return !beginNext();
  refinement_.takePlaces(problem_.mesh, render_);
  phase_ = Phase::kRefine;
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
  const Level& level = nth(kLevels, level_);
  const double radius_px = nth(level.radius_px, pass_);
  const bool moved =
      refinement_.refine(view_edges_.edges(), prior(), radius_px, view_from_station_);
  current_.camera_from_station = view_edges_.inCamera(view_from_station_);
  if (moved || level_ <= 1) current_.error_px = kRemaining_px / view_edges_.view().pixels_per_px;
  if (round_ < kLastRound && isKept(current_.camera_from_station)) return !beginNext();
  const bool measures = level_ == nth(kSearchRounds, round_).last_level;
  if (moved && ++pass_ < level.passes) {
    // The last pass renders again where its render is measured.
    if (measures && pass_ + 1 == level.passes) phase_ = Phase::kRender;
    return false;
  }
  // The last render is from close by.
  if (measures) return measure();
  ++level_;
  return beginLevel() ? false : !beginNext();
}

bool PoseSearch::measure() {
  takePlaces(render_, meter_);
  current_.evidence = meter_.measure(view_edges_.view().span_px);
  return keep();
}

}  // namespace boresight
