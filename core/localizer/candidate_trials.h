// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/search/pose_search.h"

namespace boresight {

/// Search policy: attempts start from the candidates of the whole-object search in descending order
/// of evidence, and at last from the seed: loop.max_attempts starts. A candidate resolved to within
/// the first search radius is refined on edges directly; for a larger object, templates are matched
/// around the candidate first. When that fails or its pose is uncertain, the candidate is refined
/// directly, too: templates of repeated print or of straight edges may move a good pose away. The
/// most probable pose that converges is the result. When the first pose is uncertain, candidates of
/// about equal evidence are tried, too.
class CandidateTrials {
 public:
  /// Next action after an attempt.
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
  Next takeFailure(const RunContext& run);
  /// The attempt that repeats the last iteration of the best pose.
  Attempt best(int attempt, const LocalizerOptions& options);

 private:
  bool hasNext(const RunContext& run) const;
  bool triesSeed(const RunContext& run) const;
  bool nextIsWorthwhile(const RunContext& run) const;

  std::span<const PoseCandidate> candidates_;
  Seed seed_;
  int next_ = 0;
  int matched_ = -1;  ///< candidate whose templates were matched, and that was not refined directly
  bool seed_tried_ = false;
  bool returns_ = false;
  double best_probability_ = -1.0;  ///< below 0: no pose has converged yet
  Attempt best_;
  Pose best_before_;  ///< start pose of the best attempt's last iteration
};

/// Uncertainty of a candidate whose templates are matched, about the scene's centre: in rotation at
/// most the seed's; in translation by the object's size and depth.
SeedUncertainty uncertaintyAbout(const Pose& camera_from_station, const Seed& seed,
                                 const BoundingBox& scene);

}  // namespace boresight
