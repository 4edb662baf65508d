// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/review_settings.h"

#include <algorithm>

#include "sessions/io/errors.h"

namespace boresight::sessions {

ReviewSettings withPreset(const ReviewSettings& settings, const std::string& preset) {
  (void)checkLimits(preset, {});  // it exists
  return {preset, {}, settings.second_person};
}

Requirement requirementOf(const Session& session, const SessionCase& one) {
  if (one.requirement) return *one.requirement;
  const CheckPreset* preset = findCheckPreset(session.review.preset);
  if (preset == nullptr)
    throw InputError("session", "review.preset",
                     "there is no preset '" + session.review.preset + "'");
  return preset->requirement;
}

ReviewSettings withLimits(const ReviewSettings& settings, const CheckLimits& limits) {
  ReviewSettings next = settings;
  next.limits = changedOptions(limits, checkLimits(settings.preset, {}));
  std::sort(next.limits.begin(), next.limits.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return next;
}

}  // namespace boresight::sessions
