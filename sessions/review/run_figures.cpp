// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/run_figures.h"

#include <algorithm>

namespace boresight::sessions {

std::int32_t lastInliers(const LocalizationTrace& run) {
  const auto found =
      std::find_if(run.iterations.rbegin(), run.iterations.rend(),
                   [](const auto& iteration) { return iteration->kind == IterationKind::kMatch; });
  return found == run.iterations.rend() ? 0 : (*found)->pnp.inlier_count;
}

int iterationToOpen(const LocalizationTrace& run) {
  const int last = static_cast<int>(run.iterations.size()) - 1;
  if (run.converged()) return last;
  for (int i = last; i >= 0; --i) {
    const LocalizationStatus status = run.iterations[static_cast<std::size_t>(i)]->status;
    if (status != LocalizationStatus::kRunning && status != LocalizationStatus::kConverged)
      return i;
  }
  return last;
}

}  // namespace boresight::sessions
