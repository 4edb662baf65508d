// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/changed_cases.h"

namespace boresight::sessions {
namespace {

template <class Value>
bool sameOf(const std::string& id, const std::map<std::string, Value>& a,
            const std::map<std::string, Value>& b) {
  const auto in_a = a.find(id);
  const auto in_b = b.find(id);
  if (in_a == a.end() || in_b == b.end()) return (in_a == a.end()) == (in_b == b.end());
  return in_a->second == in_b->second;
}

bool sameDecision(const std::string& id, const Session& a, const Session& b) {
  const Decision* in_a = a.decisionOn(id);
  const Decision* in_b = b.decisionOn(id);
  return in_a && in_b ? *in_a == *in_b : in_a == in_b;
}

}  // namespace

std::vector<std::string> changedCases(const Session& before, const Session& after) {
  std::vector<std::string> changed;
  for (const auto& one : after.cases) {
    const SessionCase* former = before.findCase(one->id);
    const bool same =
        former && *former == *one && sameOf(one->id, before.annotations, after.annotations) &&
        sameOf(one->id, before.passes, after.passes) && sameDecision(one->id, before, after);
    if (!same) changed.push_back(one->id);
  }
  return changed;
}

}  // namespace boresight::sessions
