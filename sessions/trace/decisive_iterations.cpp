// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/decisive_iterations.h"

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

std::vector<std::shared_ptr<const IterationTrace>> decisiveIterations(
    const LocalizationTrace& run) {
  const auto& all = run.iterations;
  if (all.empty()) return {};
  const auto isOf = [](std::int32_t attempt) {
    return [attempt](const auto& item) { return item->attempt == attempt; };
  };
  const auto last = std::ranges::find_if(all, isOf(all.back()->attempt));
  std::vector<std::shared_ptr<const IterationTrace>> decisive;
  const auto isOriginal = [&last](const auto& item) {
    return cameToPose(*item) && isRepeatedBy(*item, **last);
  };
  const auto found = std::find_if(std::reverse_iterator(last), all.rend(), isOriginal);
  if (!run.hypotheses.empty() && found != all.rend()) {
    const auto original = std::prev(found.base());
    std::copy_if(all.begin(), original, std::back_inserter(decisive), isOf((*original)->attempt));
  }
  decisive.insert(decisive.end(), last, all.end());
  return decisive;
}

std::shared_ptr<const IterationTrace> lastMatching(const LocalizationTrace& run) {
  std::shared_ptr<const IterationTrace> found;
  for (const auto& item : decisiveIterations(run))
    if (item->kind == IterationKind::kMatch && item->reached > Stage::kRender) found = item;
  return found;
}

}  // namespace boresight::sessions
