// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/accept/contour_evidence.h"
#include "core/base/arena.h"
#include "core/base/fixed_list.h"
#include "core/refine/outline_refinement.h"
#include "core/render/edge_render.h"
#include "core/search/object_search.h"
#include "core/search/view_edges.h"

namespace boresight {

/// A candidate of the search, refined.
struct PoseCandidate {
  SearchCandidate found;     ///< as the search found it
  Pose camera_from_station;  ///< refined
  ContourEvidence evidence;  ///< of the refined pose
  double error_px = 0.0;     ///< possible error after the refinement, px of the real image

  /// Sort key of the candidates.
  double rank_nats() const { return evidence.strongest_nats() + 0.5 * evidence.weakest_nats(); }
};

/// Finds candidate poses of the whole object: searches the seed's uncertainty (ObjectSearch),
/// refines the poses on directed edges (OutlineRefinement), first at the search's scale, and
/// measures their evidence. Each round refines fewer poses, those with most evidence, at finer
/// scales. At first few poses are refined, and one at the finest scale; resume() refines all that
/// may be correct, for a caller that rejects the first candidate.
class PoseSearch {
 public:
  static constexpr int kMaxCandidates = 6;      ///< that are refined at the finest scale
  static constexpr int kLongestView_px = 352;   ///< of views
  static constexpr int kMaxEdgePixels = 20000;  ///< of renders

  /// Takes the memory from `arena`, for images of up to `channels` channels.
  Status create(int channels, Arena& arena);
  /// The data of the problem and the renderer (for images of kLongestView_px) must
  /// outlive the steps. False when the scene is outside the image at the seed.
  [[nodiscard]] bool begin(const SearchProblem& problem, EdgeRenderer& renderer);
  /// Refines the seed alone as the only candidate; for a seed near the true pose.
  [[nodiscard]] bool beginAtSeed(const SearchProblem& problem, EdgeRenderer& renderer);
  /// One bounded slice; true when candidates() is complete.
  [[nodiscard]] bool step();
  /// Whether the search is over but has left poses to resume().
  bool isSuspended() const { return phase_ == Phase::kDone && !resumed_ && left_ > 0; }
  /// Refines the poses that were left; false when there is none.
  [[nodiscard]] bool resume();

  /// The candidates by descending evidence; empty until complete.
  std::span<const PoseCandidate> candidates() const {
    return phase_ == Phase::kDone ? kept_.items() : std::span<const PoseCandidate>();
  }
  /// The search on the grid.
  const ObjectSearch& search() const { return search_; }

 private:
  enum class Phase : std::uint8_t { kSearch = 0, kView, kRender, kRefine, kDone };
  using PoseList = FixedList<PoseCandidate, CandidateList::kCapacity>;

  void takeFound();
  bool beginNext();
  void beginRound(const PoseList& waiting, int round);
  bool beginRounds(const PoseList& waiting, int round);
  int most() const;
  bool keep();
  bool beginLevel();
  bool stepRender();
  bool refine();
  bool measure();
  bool isSame(const Pose& first, const Pose& second) const;
  bool isKept(const Pose& camera_from_station) const;
  PosePrior prior() const;

  SearchProblem problem_;
  EdgeRenderer* renderer_ = nullptr;
  ViewEdges view_edges_;
  EdgeRender render_;
  ObjectSearch search_;
  OutlineRefinement refinement_;
  ContourEvidenceMeter meter_;
  /// Poses of the previous round and of the current round, by descending evidence.
  PoseList waiting_, kept_;
  /// Poses of the first round: those of the search, with which resume() begins again, or the seed.
  PoseList found_;
  int left_ = 0;  ///< to resume()

  Phase phase_ = Phase::kDone;
  int round_ = 0;
  int next_ = 0;   ///< index of the next waiting pose
  int level_ = 0;  ///< of the refinement: 0 the search's
  int pass_ = 0;   ///< of the level
  bool rendering_ = false;
  bool resumed_ = false;
  PoseCandidate current_;
  Pose view_from_station_;
};

}  // namespace boresight
