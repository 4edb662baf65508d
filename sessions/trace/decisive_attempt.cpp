// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/decisive_attempt.h"

#include <algorithm>
#include <iterator>

namespace boresight::sessions {
namespace {

/// Whether an attempt that ends with `iteration` is repeated from its last pose by `repeated`.
bool isRepeatedBy(const IterationTrace& iteration, const IterationTrace& repeated) {
  return iteration.attempt != repeated.attempt && iteration.kind == repeated.kind &&
         iteration.level == repeated.level &&
         iteration.camera_from_station_before == repeated.camera_from_station_before;
}

}  // namespace

bool cameToPose(const IterationTrace& iteration) {
  return iteration.status == LocalizationStatus::kRunning ||
         iteration.status == LocalizationStatus::kConverged;
}

std::vector<std::shared_ptr<const IterationTrace>> decisiveAttempt(const LocalizationTrace& run) {
  if (run.iterations.empty()) return {};
  const auto attemptOf = [&run](std::int32_t attempt) {
    std::vector<std::shared_ptr<const IterationTrace>> found;
    std::ranges::copy_if(run.iterations, std::back_inserter(found),
                         [=](const auto& item) { return item->attempt == attempt; });
    return found;
  };
  const auto last = attemptOf(run.iterations.back()->attempt);
  if (run.hypotheses.empty()) return last;
  const auto original = std::find_if(
      run.iterations.rbegin(), run.iterations.rend(),
      [&](const auto& item) { return cameToPose(*item) && isRepeatedBy(*item, *last.front()); });
  return original == run.iterations.rend() ? last : attemptOf((*original)->attempt);
}

std::shared_ptr<const IterationTrace> lastMatching(const LocalizationTrace& run) {
  std::shared_ptr<const IterationTrace> found;
  for (const auto& item : decisiveAttempt(run))
    if (item->kind == IterationKind::kMatch && item->reached > Stage::kRender) found = item;
  return found;
}

}  // namespace boresight::sessions
