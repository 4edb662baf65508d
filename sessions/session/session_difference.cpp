// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_difference.h"

#include <utility>

namespace boresight::sessions {
namespace {

template <class List>
void addOf(const List& before, const List& after, std::set<std::string>& ids) {
  const auto left = [&](std::size_t i) { ids.insert(CaseIdOf()(before[i])); };
  const auto entered = [&](std::size_t, const auto& element) { ids.insert(CaseIdOf()(element)); };
  const auto replaced = [&](std::size_t i, const auto& element) {
    left(i);
    entered(i, element);
  };
  List::forEachDifference(before, after, replaced, left, entered);
}

template <class Map>
void addKeysOf(const Map& before, const Map& after, std::set<std::string>& ids) {
  Map::forEachDifference(before, after, [&ids](const auto* from, const auto* to) {
    ids.insert(from ? (*from)->first : (*to)->first);
  });
}

bool sameIds(const Session& before, const Session& after) {
  bool same = true;
  const auto moved = [&same](auto&&...) { same = false; };
  const auto replaced = [&](std::size_t i, const auto& session_case) {
    same = same && before.cases[i]->id == session_case->id;
  };
  decltype(before.cases)::forEachDifference(before.cases, after.cases, replaced, moved, moved);
  return same;
}

}  // namespace

SessionDifference differenceOf(const Session& before, const Session& after) {
  SessionDifference difference;
  difference.list = !sameIds(before, after);
  difference.options = before.profile != after.profile || !(before.options == after.options);
  difference.review = !(before.review == after.review);
  difference.robust = before.robust_annotations != after.robust_annotations;
  addOf(before.cases, after.cases, difference.cases);
  addOf(before.decisions, after.decisions, difference.cases);
  addOf(before.runs, after.runs, difference.cases);
  addKeysOf(before.annotations, after.annotations, difference.cases);
  addKeysOf(before.rounds, after.rounds, difference.cases);
  return difference;
}

std::set<std::string> withCasesOfRigs(std::set<std::string> ids, const Session& before,
                                      const Session& after) {
  std::set<std::string> rigs;
  for (const Session* session : {&before, &after})
    for (const std::string& id : ids)
      if (const SessionCase* found = session->findCase(id); found && found->rig)
        rigs.insert(found->rig->id);
  for (const std::string& rig : rigs)
    for (const auto* session_case : after.cases.findGroup(rig)) ids.insert((*session_case)->id);
  return ids;
}

}  // namespace boresight::sessions
