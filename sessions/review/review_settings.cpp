// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/review_settings.h"

#include <algorithm>

namespace boresight::sessions {

ReviewSettings withPreset(const ReviewSettings& settings, const std::string& preset) {
  (void)checkLimits(preset, {});  // it exists
  return {preset, {}, settings.second_person};
}

ReviewSettings withLimits(const ReviewSettings& settings, const CheckLimits& limits) {
  ReviewSettings next = settings;
  next.limits = changedOptions(limits, checkLimits(settings.preset, {}));
  std::sort(next.limits.begin(), next.limits.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return next;
}

}  // namespace boresight::sessions
