// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/view_outcome.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

bool isStatus(const std::string& text, LocalizationStatus status) {
  return text == localizationStatusText(status);
}

}  // namespace

std::string leftOutText(const std::string& status) {
  if (isStatus(status, LocalizationStatus::kTooFewEdges))
    return "too few of its edges are rendered or found";
  if (isStatus(status, LocalizationStatus::kTooFewTemplates)) return "too few templates";
  if (isStatus(status, LocalizationStatus::kTooFewMatches))
    return "too few of its templates meet edges of the image";
  if (isStatus(status, LocalizationStatus::kPnpFailed))
    return "too few of its matches or edges agree with the pose of the others";
  if (isStatus(status, LocalizationStatus::kNotSupported))
    return "its edge support is below the limit";
  return status;
}

std::string togetherText(const std::vector<ViewOutcome>& views, const std::string& own_case) {
  const auto tookPart = [](const ViewOutcome& one) {
    return isStatus(one.status, LocalizationStatus::kConverged);
  };
  const bool converged = std::any_of(views.begin(), views.end(), tookPart);
  std::vector<std::string> names;
  for (const ViewOutcome& one : views) {
    if (one.case_id == own_case) continue;
    const bool out = converged && !tookPart(one);
    names.push_back(one.case_id + (out ? " (left out: " + leftOutText(one.status) + ")" : ""));
  }
  std::string text = "together with ";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace boresight::sessions
