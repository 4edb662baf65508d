// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_plan.h"

#include <stdexcept>

namespace boresight::sessions {

RunPlan continuedPlan(const RunPlan& plan, std::int32_t iteration,
                      const LocalizerOptions& options) {
  if (iteration < 1) return options;
  RunPlan continued = plan;
  std::erase_if(continued.changes, [iteration](const OptionChange& option_change) {
    return option_change.iteration >= iteration;
  });
  if (!sameOptions(continued.last(), options)) continued.changes.push_back({iteration, options});
  return continued;
}

std::string planProblem(const RunPlan& plan) {
  const auto outOfRange = [](const char* name) {
    return std::string(name) + " is out of its range";
  };
  if (const char* name = firstInvalidOption(plan.options)) return outOfRange(name);
  const LocalizerOptions* before = &plan.options;
  std::int32_t earliest = 1;
  for (const OptionChange& change : plan.changes) {
    if (change.iteration < earliest)
      return "the options change at iteration " + std::to_string(change.iteration) +
             ", but that must be " + std::to_string(earliest) + " or later";
    if (const char* name = firstInvalidOption(change.options)) return outOfRange(name);
    if (const char* name = firstFixedOption(*before, change.options))
      return std::string(name) +
             " cannot change during a run: run again from the start, or restore its value";
    before = &change.options;
    earliest = change.iteration + 1;
  }
  return "";
}

bool PlannedChanges::takeUp(Localizer& localizer, std::size_t complete) {
  if (next_ >= changes_.size() || !localizer.isBetweenIterations()) return false;
  const OptionChange& due = changes_[next_];
  if (static_cast<std::size_t>(due.iteration) != complete) return false;
  ++next_;
  if (!localizer.changeOptions(due.options)) throw std::logic_error("a plan that was not checked");
  return true;
}

}  // namespace boresight::sessions
