// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/fixed_list.h"
#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/pose_hypothesis.h"
#include "core/localizer/problem.h"
#include "core/refine/edge_places.h"
#include "core/search/pose_search.h"

namespace boresight {

/// Search policy. For a near seed it takes the refinement of the seed if convinces() holds.
/// Otherwise it refines several poses of a run, measures the evidence of each, and takes the one
/// with the best score. Hypotheses come from the candidates of the whole-object search, refined on
/// edges; from templates matched around the first candidate, where the object is too large for the
/// search; and from the seed, where no pose is probable. Restarts of the best pose along its two
/// weakest directions, to both sides, add more: a refinement may have stopped at neighbouring
/// edges. An attempt that reaches a known hypothesis ends there. The run ends with the last
/// iteration of the best hypothesis repeated, so that the records show it.
class PoseComparison {
 public:
  /// Next action after an attempt.
  enum class Next : std::uint8_t {
    kTry = 0,   ///< the attempt of next()
    kReturn,    ///< the attempt of best() repeats its last iteration
    kSearch,    ///< the whole object is searched, and a new comparison begins with its candidates
    kConclude,  ///< the run ends: with the pose of best(), or as a failure
  };
  static constexpr int kRestarts = 4;         ///< along two directions, to both sides
  static constexpr int kMostCandidates = 10;  ///< of all views
  /// Candidates, two attempts with templates, restarts.
  static constexpr int kMostHypotheses = kMostCandidates + 2 + kRestarts;

  PoseComparison() = default;
  /// The candidates must outlive this.
  PoseComparison(std::span<const PoseCandidate> candidates, const Seed& seed)
      : candidates_(candidates.first(std::min<std::size_t>(candidates.size(), kMostCandidates))),
        seed_(seed) {}
  /// The comparison of a near seed: takes the refinement of the only candidate, or of the seed
  /// without one, if it convinces. Otherwise the whole object is searched.
  static PoseComparison ofNearSeed(std::span<const PoseCandidate> candidates, const Seed& seed) {
    PoseComparison comparison(candidates, seed);
    comparison.source_ = Source::kNearSeed;
    comparison.returns_ = comparison.searches_on_ = true;
    return comparison;
  }
  /// The comparison of the candidates of a suspended search, which continues if they do not
  /// convince.
  static PoseComparison ofFirst(std::span<const PoseCandidate> candidates, const Seed& seed) {
    PoseComparison comparison(candidates, seed);
    comparison.searches_on_ = true;
    return comparison;
  }

  /// The attempt of the next start.
  Attempt next(int attempt, const RunContext& run);
  /// Whether a pose of an attempt, refined at a level, is a known hypothesis.
  bool isKnown(const Pose& camera_from_station, int level, const RunContext& run) const;
  /// A refinement under this plan ends at known hypotheses.
  void endAtKnown(PassPlan& plan) const;
  /// Evidence of the best hypothesis if the pose is nearly the same, else nullptr.
  const PoseEvidence* evidenceFor(const Pose& camera_from_station, const RunContext& run) const;
  /// Takes the pose of a converged attempt; `measured` has its evidence, score and probability,
  /// `edges` places of its refined edges.
  Next takePose(const Attempt& attempt, const Pose& camera_from_station_before,
                const PoseHypothesis& measured, const WeakDirections& weak, const EdgePlaces& edges,
                const RunContext& run);
  /// Takes an attempt that failed, left the seed's uncertainty, reached a known hypothesis, or does
  /// not convince.
  Next takeFailure(const RunContext& run);
  /// Whether the final pose needs no further search: always after a whole one, else if
  /// `probability` is at least kUndoubted and the pose lies within the stated uncertainty.
  bool convinces(const Pose& camera_from_station, double probability) const;
  /// Whether there is a hypothesis.
  bool hasPose() const { return hypotheses_.size() > 0; }
  /// Whether the attempt under way is the last one: that of best(), or of the seed itself.
  bool returns() const { return returns_; }
  /// The attempt that repeats the last iteration of the best hypothesis.
  Attempt best(int attempt, const LocalizerOptions& options);

  /// All hypotheses in order of discovery.
  std::span<const PoseHypothesis> hypotheses() const { return hypotheses_.items(); }
  /// Index of the best hypothesis; -1: none.
  int bestIndex() const { return best_index_; }
  /// Index of the best hypothesis that is distinct from the best one; -1: none.
  int competitorIndex(const RunContext& run) const;
  /// Score of the best hypothesis minus that of the competitor; 0 without one.
  double gap(const RunContext& run) const;
  /// Writes the hypotheses so far, with best, competitor and gap, to the workspace.
  void writeTo(const RunContext& run, Workspace& workspace) const;

 private:
  enum class Source : std::uint8_t {
    kNearSeed = 0,
    kTemplates,
    kCandidates,
    kSeed,
    kRestarts,
    kNone
  };

  int firstCandidateFrom(int index) const;
  bool findNext(const RunContext& run);
  bool bestConvinces() const;
  bool offers(Source source, const RunContext& run) const;
  Attempt start(int attempt, const RunContext& run);
  Attempt restart(int attempt, const RunContext& run);

  std::span<const PoseCandidate> candidates_;
  Seed seed_;
  Source source_ = Source::kTemplates;
  int next_ = 0;            ///< of the source
  PoseHypothesis current_;  ///< origin and number of the attempt under way
  bool returns_ = false;
  bool searches_on_ = false;  ///< where no pose convinces

  FixedList<PoseHypothesis, kMostHypotheses> hypotheses_;
  int best_index_ = -1;
  Attempt best_;
  Pose best_before_;          ///< start pose of the best attempt's last iteration
  WeakDirections weak_;       ///< of the best hypothesis
  EdgePlaces edges_;          ///< of the best hypothesis
  WeakDirections restarted_;  ///< of the hypothesis that restarts begin from
  Pose restarted_from_;
};

/// Whether the stated uncertainty moves the scene in the image by little compared with its size
/// there: a refinement of the seed then probably reaches the correct pose.
bool isNear(const Seed& seed, const RunContext& run);

/// Uncertainty of a candidate whose templates are matched, about the scene's centre: in rotation at
/// most the seed's; in translation by the object's size and depth.
SeedUncertainty uncertaintyAbout(const Pose& camera_from_station, const Seed& seed,
                                 const BoundingBox& scene);

}  // namespace boresight
