// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_edit.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

template <class Value>
void takeChanged(const Value& before, const Value& after, Value& now) {
  if (!(before == after)) now = after;
}

template <class Map>
void takeChangedOf(const Map& before, const Map& after, Map& now) {
  for (const auto& [id, value] : before)
    if (!after.contains(id)) now.erase(id);
  for (const auto& [id, value] : after) {
    const auto found = before.find(id);
    if (found == before.end() || !(found->second == value)) now.insert_or_assign(id, value);
  }
}

/// Removes what was removed, and appends what is new.
template <class List>
void takeMembers(const List& before, const List& after, List& now) {
  const auto [was, is] = std::mismatch(before.begin(), before.end(), after.begin(), after.end());
  const auto among = [](const auto& value, auto first, auto last) {
    return std::find(first, last, value) != last;
  };
  if (was != before.end())
    now.eraseIf([&, was = was, is = is](const auto& value) {
      return among(value, was, before.end()) && !among(value, is, after.end());
    });
  for (auto value = is; value != after.end(); ++value)
    if (!among(*value, was, before.end())) now.push_back(*value);
}

Session performed(const Session& before, const Session& after, const Session& now) {
  if (now == before) return after;
  Session next = now;
  for (const auto& session_case : before.cases)
    if (after.findCase(session_case->id) == nullptr) next = withoutCase(next, session_case->id);
  for (const auto& session_case : after.cases) {
    const SharedValue<SessionCase>* former = before.cases.find(session_case->id);
    if (former == nullptr || !(*former == session_case)) next = withCase(next, *session_case);
  }
  takeChanged(before.profile, after.profile, next.profile);
  takeChanged(before.options, after.options, next.options);
  takeChanged(before.robust_annotations, after.robust_annotations, next.robust_annotations);
  takeChanged(before.review, after.review, next.review);
  takeChanged(before.view, after.view, next.view);
  takeChangedOf(before.annotations, after.annotations, next.annotations);
  takeChangedOf(before.rounds, after.rounds, next.rounds);
  takeMembers(before.decisions, after.decisions, next.decisions);
  takeMembers(before.runs, after.runs, next.runs);
  return next;
}

}  // namespace

SessionEdit editBetween(const Session& before, const Session& after) {
  return [before, after](const Session& now) { return performed(before, after, now); };
}

}  // namespace boresight::sessions
