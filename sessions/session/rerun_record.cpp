// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rerun_record.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sessions/io/config_file.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

OptionList recorded(const LocalizerOptions& options) {
  OptionList list = changedOptions(options, defaultProfile());
  std::sort(list.begin(), list.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return list;
}

LocalizerOptions optionsOf(const OptionList& list, const std::filesystem::path& file) {
  Config config;
  config.file = file;
  config.options = list;
  LocalizerOptions options = defaultProfile();
  applyConfig(options, config);
  return options;
}

}  // namespace

RerunRecord rerunRecord(const std::string& from, const RunPlan& plan) {
  RerunRecord record;
  record.from = from;
  record.options = recorded(plan.options);
  for (const OptionChange& change : plan.changes)
    record.changes.push_back({change.iteration, recorded(change.options)});
  return record;
}

RunPlan planOf(const RerunRecord& record, const std::filesystem::path& file) {
  RunPlan plan(optionsOf(record.options, file));
  for (const RecordedChange& change : record.changes)
    plan.changes.push_back({change.iteration, optionsOf(change.options, file)});
  return plan;
}

ordered_json toJson(const RerunRecord& record) {
  ordered_json json;
  if (!record.from.empty()) json["from"] = record.from;
  json["options"] = toJson(record.options);
  json["changes"] = ordered_json::array();
  for (const RecordedChange& change : record.changes) {
    ordered_json made;
    made["iteration"] = change.iteration;
    made["options"] = toJson(change.options);
    json["changes"].push_back(std::move(made));
  }
  return json;
}

RerunRecord readRerun(const JsonReader& json) {
  RerunRecord record;
  if (const auto from = json.find("from")) record.from = from->nonEmptyText();
  record.options = readOptions(json.at("options"));
  for (const JsonReader& change : json.at("changes").elements())
    record.changes.push_back({static_cast<std::int32_t>(change.at("iteration").integer(1, 1000000)),
                              readOptions(change.at("options"))});
  const std::string problem = planProblem(planOf(record, json.file()));
  if (!problem.empty()) json.failMember("changes", problem);
  return record;
}

}  // namespace boresight::sessions
