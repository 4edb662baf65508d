// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_change.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/annotation/annotations_file.h"
#include "sessions/decision/decision.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/session_file.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

template <class List, class Write>
void addListChange(const char* key, const List& before, const List& after, const Write& write,
                   ordered_json& change) {
  ordered_json json;
  List::forEachDifference(
      before, after,
      [&](std::size_t i, const auto& value) {
        json["replace"].push_back(ordered_json::array({i, write(value)}));
      },
      [&](std::size_t i) { json["erase"].push_back(i); },
      [&](std::size_t i, const auto& value) {
        json["insert"].push_back(ordered_json::array({i, write(value)}));
      });
  if (!json.empty()) change[key] = std::move(json);
}

template <class Map>
void addMapChange(const char* key, const Map& before, const Map& after, ordered_json& change) {
  ordered_json json = ordered_json::object();
  auto& members = json.get_ref<ordered_json::object_t&>();  // by name, all would be compared
  Map::forEachDifference(before, after, [&members](const auto* from, const auto* to) {
    members.emplace_back(to ? (*to)->first : (*from)->first,
                         to ? toJson(*(*to)->second) : ordered_json());
  });
  if (!json.empty()) change[key] = std::move(json);
}

std::size_t indexBelow(std::size_t count, const JsonReader& json) {
  if (count == 0) json.fail("the list is empty");
  return static_cast<std::size_t>(json.integer(0, static_cast<std::int64_t>(count) - 1));
}

template <class List, class Read>
void readListChange(const JsonReader& change, const char* key, const Read& read, List& list) {
  const auto found = change.find(key);
  if (!found) return;
  if (const auto replaced = found->find("replace"))
    for (const JsonReader& item : replaced->elements()) {
      const auto pair = item.elements(2);
      list.replace(indexBelow(list.size(), pair[0]), read(pair[1]));
    }
  if (const auto erased = found->find("erase")) {
    const std::vector<JsonReader> items = erased->elements();
    for (auto item = items.rbegin(); item != items.rend(); ++item)
      list.erase(indexBelow(list.size(), *item));
  }
  if (const auto inserted = found->find("insert"))
    for (const JsonReader& item : inserted->elements()) {
      const auto pair = item.elements(2);
      list.insert(indexBelow(list.size() + 1, pair[0]), read(pair[1]));
    }
}

template <class Map, class Read>
void readMapChange(const JsonReader& change, const char* key, const Read& read, Map& map) {
  const auto found = change.find(key);
  if (!found) return;
  for (const auto& [id, value] : found->members())
    if (value.value().is_null())
      map.erase(id);
    else
      map.insert_or_assign(id, read(value));
}

/// What readSession requires of a whole session, of what has changed alone.
class ChangeCheck {
 public:
  ChangeCheck(const Session& before, const Session& after, const JsonReader& change)
      : before_(before), after_(after), change_(change) {}

  void requireValid() const {
    requireCases();
    requireCasesOf("decisions", before_.decisions, after_.decisions);
    requireCasesOf("runs", before_.runs, after_.runs);
    requireCasesOf(before_.annotations, after_.annotations, "annotations");
    requireCasesOf(before_.rounds, after_.rounds, "rounds");
    if (!after_.view.case_id.empty()) requireCase(after_.view.case_id, "view");
  }

 private:
  void requireCase(const std::string& id, const char* member) const {
    if (after_.findCase(id) == nullptr) change_.failMember(member, "there is no case '" + id + "'");
  }
  void requireCases() const {
    const auto entered = [this](const SharedValue<SessionCase>& session_case) {
      if (after_.cases.findAll(session_case->id).size() > 1)
        change_.failMember("cases", "'" + session_case->id + "' is given twice");
    };
    const auto left = [this](std::size_t i) { requireUnused(before_.cases[i]->id); };
    decltype(after_.cases)::forEachDifference(
        before_.cases, after_.cases,
        [&](std::size_t i, const auto& session_case) {
          left(i);
          entered(session_case);
        },
        left, [&](std::size_t, const auto& session_case) { entered(session_case); });
  }
  /// Refuses data of a case that no longer exists.
  void requireUnused(const std::string& id) const {
    if (after_.annotations.contains(id)) requireCase(id, "annotations");
    if (after_.rounds.contains(id)) requireCase(id, "rounds");
    if (after_.decisions.find(id) != nullptr) requireCase(id, "decisions");
    if (after_.runs.find(id) != nullptr) requireCase(id, "runs");
  }
  template <class List>
  void requireCasesOf(const char* member, const List& before, const List& after) const {
    const auto entered = [&](std::size_t, const auto& element) {
      requireCase(element.case_id, member);
    };
    List::forEachDifference(
        before, after, entered, [](std::size_t) {}, entered);
  }
  template <class Map>
  void requireCasesOf(const Map& before, const Map& after, const char* member) const {
    Map::forEachDifference(before, after, [&](const auto* /*from*/, const auto* to) {
      if (to != nullptr) requireCase((*to)->first, member);
    });
  }

  const Session& before_;
  const Session& after_;
  const JsonReader& change_;
};

Session readChange(const Session& before, const JsonReader& change) {
  Session after = before;
  if (const auto profile = change.find("profile")) after.profile = profile->nonEmptyText();
  if (const auto options = change.find("options")) after.options = readOptions(*options);
  if (change.has("profile") || change.has("options"))
    (void)sessionOptions(after, change.file());  // throws when one does not exist or fit
  readListChange(change, "cases", readSessionCase, after.cases);
  readMapChange(
      change, "annotations", [](const JsonReader& json) { return readAnnotations(json); },
      after.annotations);
  readMapChange(change, "rounds", readRounds, after.rounds);
  if (const auto robust = change.find("robust_annotations"))
    after.robust_annotations = robust->boolean();
  if (const auto review = change.find("review")) after.review = readReviewSettings(*review);
  readListChange(change, "decisions", readDecision, after.decisions);
  readListChange(change, "runs", readRunRecord, after.runs);
  if (const auto view = change.find("view")) after.view = readView(*view);
  ChangeCheck(before, after, change).requireValid();
  return after;
}

}  // namespace

ordered_json sessionChange(const Session& before, const Session& after,
                           const std::filesystem::path& file) {
  const PathWriter path(file);
  ordered_json change = ordered_json::object();
  if (after.profile != before.profile) change["profile"] = after.profile;
  if (after.options != before.options) change["options"] = toJson(after.options);
  addListChange(
      "cases", before.cases, after.cases,
      [&path](const auto& session_case) { return toJson(*session_case, path); }, change);
  addMapChange("annotations", before.annotations, after.annotations, change);
  addMapChange("rounds", before.rounds, after.rounds, change);
  if (after.robust_annotations != before.robust_annotations)
    change["robust_annotations"] = after.robust_annotations;
  if (after.review != before.review) change["review"] = toJson(after.review);
  addListChange(
      "decisions", before.decisions, after.decisions,
      [](const Decision& decision) { return toJson(decision); }, change);
  addListChange(
      "runs", before.runs, after.runs, [&path](const RunRecord& run) { return toJson(run, path); },
      change);
  if (after.view != before.view) change["view"] = toJson(after.view);
  return change;
}

Session withChange(const Session& before, const JsonReader& change) {
  return change.whole([&before](const JsonReader& json) { return readChange(before, json); });
}

}  // namespace boresight::sessions
