// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/localizer/localizer.h"

namespace boresight::sessions {

/// Options that a run changes to between two iterations.
struct OptionChange {
  std::int32_t iteration = 0;  ///< the first one with them, as the trace counts: from 0
  LocalizerOptions options;
};

/// The options of a whole run: those that it starts with, and those that it changes to later. The
/// same plan on the same inputs gives the same digest on every machine.
struct RunPlan {
  LocalizerOptions options;
  std::vector<OptionChange> changes;  ///< by increasing iteration, each at least 1

  RunPlan() = default;
  // A run without changes; the usual case.
  RunPlan(const LocalizerOptions& from_start) : options(from_start) {}
  RunPlan(const LocalizerOptions& from_start, std::vector<OptionChange> later)
      : options(from_start), changes(std::move(later)) {}

  /// The options in force at the end.
  const LocalizerOptions& last() const {
    return changes.empty() ? options : changes.back().options;
  }
};

/// The plan of a run that follows `plan` before `iteration` and has `options` from there on.
/// Options already in force there are no change, so that the digest stays the same; from iteration
/// 0 on it is a new run.
RunPlan continuedPlan(const RunPlan& plan, std::int32_t iteration, const LocalizerOptions& options);

/// Why a plan cannot be run (an option out of its range, one that holds for a whole run, changes
/// out of order), as a sentence; empty when it can.
std::string planProblem(const RunPlan& plan);

/// Applies a plan's changes to a localizer when they are due.
class PlannedChanges {
 public:
  explicit PlannedChanges(std::vector<OptionChange> changes) : changes_(std::move(changes)) {}

  /// Call before every step, with the number of complete iterations. True when the localizer has
  /// other options now.
  bool takeUp(Localizer& localizer, std::size_t complete);

 private:
  std::vector<OptionChange> changes_;
  std::size_t next_ = 0;
};

}  // namespace boresight::sessions
