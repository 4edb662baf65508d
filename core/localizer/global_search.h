// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/digest.h"
#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/restart_grid.h"
#include "core/localizer/workspace.h"

namespace boresight {

/// Search policy for seeds far off: one match pass from each restart of a grid, then one at the
/// next level from the best of these (finalists). Attempts start from the finalists in the order of
/// their evidence. Off unless options.wide.isOn().
class GlobalSearch {
 public:
  GlobalSearch() = default;
  /// The two lists, of wide.max_restarts and wide.finalists entries, must outlive the search.
  GlobalSearch(const LocalizationProblem& problem, const RunContext& run,
               std::span<HypothesisSummary> restarts, std::span<HypothesisSummary> finalists);

  /// Whether passes are left to do.
  bool isSearching() const { return round_ != Round::kNone; }
  /// Whether no restart of the iteration was tried yet.
  bool atIterationStart() const { return place_ == 0; }
  /// The pass that tries the next restart.
  PassPlan plan(const RunContext& run) const;
  /// kPose: the search has ended and hasFinalist().
  Ruling take(const PassOutcome& outcome, const RunContext& run, std::span<Iteration, 2> records,
              DigestWriter& digest);

  /// Whether a finalist is left that no attempt has started from.
  bool hasFinalist() const { return bestFinalist() >= 0; }
  /// The attempt from the best finalist left.
  Attempt nextAttempt(int index, const LocalizerOptions& options);

 private:
  enum class Round : std::uint8_t { kNone = 0, kRestarts, kFinalists };

  int count() const { return round_ == Round::kRestarts ? grid_.count() : finalist_count_; }
  void note(const PassOutcome& outcome, std::span<Iteration, 2> records, DigestWriter& digest);
  Ruling finishRound(const RunContext& run, Iteration& chosen);
  void chooseRestarts(const RunContext& run);
  int bestFinalist() const;

  RestartGrid grid_;
  Round round_ = Round::kNone;
  std::span<HypothesisSummary> restarts_;
  std::span<HypothesisSummary> finalists_;
  int finalist_count_ = 0;
  std::uint32_t finalists_used_ = 0;  ///< bits
  int place_ = 0;                     ///< of the restart or finalist
  int record_ = 0;
  bool has_best_ = false;
  Stage reached_[2] = {};  ///< by each record
};

}  // namespace boresight
