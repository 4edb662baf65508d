// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/search/pose_search.h"

namespace boresight {

/// Search policy: attempts start from the candidates of the whole-object search, the most evidence
/// first, and the last one from the seed itself. A candidate that the search has resolved to within
/// the first search radius is refined on edges at once; of a larger object, templates are matched
/// around it first. Of the poses that converge the most probable one is the result: when the first
/// is not sure, candidates of about as much evidence are tried, too.
class CandidateTrials {
 public:
  /// What follows an attempt.
  enum class Next : std::uint8_t {
    kTry = 0,   ///< the attempt of next()
    kReturn,    ///< the attempt of best(): its last iteration again
    kConclude,  ///< the run ends: with the pose of the attempt, or as a failure
  };

  CandidateTrials() = default;
  /// The candidates must outlive this.
  CandidateTrials(std::span<const PoseCandidate> candidates, const Seed& seed)
      : candidates_(candidates), seed_(seed) {}

  /// The attempt of the next candidate, or of the seed.
  Attempt next(int attempt, const RunContext& run);
  /// An attempt has converged on a supported pose.
  Next takePose(const Attempt& attempt, const Pose& camera_from_station_before, double probability,
                const RunContext& run);
  /// Whether an attempt has converged on a supported pose.
  bool hasPose() const { return best_probability_ >= 0.0; }
  /// An attempt has failed, or its pose is not supported.
  Next takeFailure(int attempt, const RunContext& run);
  /// The attempt that repeats the last iteration of the best pose.
  Attempt best(int attempt, const LocalizerOptions& options);

 private:
  bool hasNext(int attempt, const RunContext& run) const;
  bool triesSeed(int attempt, const RunContext& run) const;
  bool nextIsWorthwhile(int attempt, const RunContext& run) const;

  std::span<const PoseCandidate> candidates_;
  Seed seed_;
  int next_ = 0;
  bool seed_tried_ = false;
  bool returns_ = false;
  double best_probability_ = -1.0;  ///< below 0: no pose has converged yet
  Attempt best_;
  Pose best_before_;  ///< where the last iteration of the best attempt started
};

/// How far the truth may be from a candidate whose templates are matched, about the scene's middle:
/// in rotation at most as far as from the seed; in translation by the object's size and depth.
SeedUncertainty uncertaintyAbout(const Pose& camera_from_station, const Seed& seed,
                                 const BoundingBox& scene);

}  // namespace boresight
