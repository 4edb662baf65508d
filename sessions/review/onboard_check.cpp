// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/onboard_check.h"

#include <string>

#include "sessions/review/check_making.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kOnboard{"agreement_onboard", "Agreement with the onboard record"};
constexpr const char* kRemedy =
    "Compare both runs step by step: what ran onboard is not what is checked here.";

std::string differenceText(const RecordComparison& compared) {
  std::string text;
  if (compared.first) text = compared.first->text;
  for (const std::string& beyond : compared.beyond) text += (text.empty() ? "" : " ") + beyond;
  return text;
}

}  // namespace

void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks) {
  if (!subject.onboard) {
    checks.push_back(notAskedCheck(kOnboard, "The case has no onboard record, or was not run."));
    return;
  }
  const std::string difference = differenceText(*subject.onboard);
  switch (subject.onboard->verdict) {
    case RunVerdict::kEqual:
      checks.push_back(statedCheck(kOnboard, true, "The run is the onboard one, to the bit.", ""));
      return;
    case RunVerdict::kWithinLimits:
      checks.push_back(statedCheck(
          kOnboard, true, "The run agrees with the onboard one within limits. " + difference, ""));
      return;
    case RunVerdict::kDifferent:
      break;
  }
  checks.push_back(
      statedCheck(kOnboard, false, "The run is not the onboard one. " + difference, kRemedy));
}

}  // namespace boresight::sessions
