// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_json.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/annotation/marks_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/config_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/mesh_container.h"
#include "sessions/session/case_json.h"
#include "sessions/session/decision_json.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// ---- writing

template <class List, class Convert>
ordered_json listJson(const List& list, Convert&& convert) {
  ordered_json json = ordered_json::array();
  for (const auto& element : list) json.push_back(convert(element));
  return json;
}

ordered_json passJson(const AnnotationPass& pass) {
  ordered_json json;
  json["by"] = pass.by;
  json["time"] = pass.time;
  json.update(toJson(pass.marks));
  return json;
}

ordered_json runJson(const RunRecord& run, const PathWriter& path) {
  ordered_json json;
  json["case"] = run.case_id;
  json["digest"] = run.digest;
  json["file"] = path(run.file);
  json["status"] = run.status;
  json["version"] = run.version;
  json["time"] = run.time;
  json["inputs_sha256"] = run.inputs_sha256;
  json["options_sha256"] = run.options_sha256;
  if (run.rerun) json["rerun"] = toJson(*run.rerun);
  if (run.together) json["together"] = toJson(*run.together);
  return json;
}

ordered_json viewJson(const DocumentView& view) {
  ordered_json json = ordered_json::object();
  if (!view.case_id.empty()) json["case"] = view.case_id;
  if (!view.digest.empty()) json["run"] = view.digest;
  if (view.iteration >= 0) json["iteration"] = view.iteration;
  return json;
}

// ---- reading

/// A member that names one of the session's cases.
std::string readCaseReference(const JsonReader& json, const Session& session) {
  std::string id = json.text();
  if (session.findCase(id) == nullptr) json.fail("there is no case '" + id + "'");
  return id;
}

AnnotationPass readPass(const JsonReader& json) {
  return {json.at("by").nonEmptyText(), readTime(json.at("time")), readMarks(json)};
}

/// What people marked, by case.
void readMarksOf(const JsonReader& json, Session& session) {
  const auto requireCase = [&session](const std::string& id, const JsonReader& at) {
    if (session.findCase(id) == nullptr) at.fail("there is no case '" + id + "'");
  };
  for (const auto& [id, annotation] : json.at("annotations").members()) {
    requireCase(id, annotation);
    session.annotations.insert_or_assign(id, readMarks(annotation));
  }
  const auto passes = json.find("passes");
  if (!passes) return;
  for (const auto& [id, list] : passes->members()) {
    requireCase(id, list);
    AnnotationPasses all;
    for (const JsonReader& pass : list.elements()) all.push_back(readPass(pass));
    if (all.empty()) list.fail("there is none: leave the case out");
    session.passes.insert_or_assign(id, std::move(all));
  }
}

RunRecord readRun(const JsonReader& json, const Session& session) {
  RunRecord run;
  run.case_id = readCaseReference(json.at("case"), session);
  run.digest = readSha256(json.at("digest"));
  run.file = readPath(json.at("file"), FileUse::kRun);
  run.status = readRunStatus(json.at("status"));
  run.version = json.at("version").nonEmptyText();
  run.time = readTime(json.at("time"));
  run.inputs_sha256 = readSha256(json.at("inputs_sha256"));
  run.options_sha256 = readSha256(json.at("options_sha256"));
  if (const auto rerun = json.find("rerun")) {
    if (const auto from = rerun->find("from")) (void)readSha256(*from);
    run.rerun = readRerun(*rerun);
  }
  if (const auto together = json.find("together")) run.together = readTogether(*together);
  return run;
}

DocumentView readView(const JsonReader& json, const Session& session) {
  DocumentView view;
  if (const auto one = json.find("case")) view.case_id = readCaseReference(*one, session);
  if (const auto run = json.find("run")) view.digest = readSha256(*run);
  if (const auto iteration = json.find("iteration"))
    view.iteration = static_cast<std::int32_t>(iteration->integer(0, 1000000));
  return view;
}

void requireVersion(const JsonReader& json) {
  if (!json.isObject()) json.fail("not a JSON object");
  const std::string format = json.at("format").text();
  if (format != kSessionFormat)
    json.failMember("format", "is '" + format + "', not '" + kSessionFormat + "'");
  const std::int64_t version = json.at("version").integer();
  if (version > kSessionVersion)
    json.failMember("version", "version " + std::to_string(version) +
                                   " was written by a newer program; this one (" +
                                   std::string(kVersion) + ") reads version " +
                                   std::to_string(kSessionVersion));
  if (version != kSessionVersion)
    json.failMember("version", "there is no version " + std::to_string(version));
}

void readOptionsOf(const JsonReader& json, Session& session) {
  session.profile = json.at("profile").nonEmptyText();
  session.options = readOptions(json.at("options"));
  (void)sessionOptions(session, json.file());  // throws when one does not exist or fit
}

Session readMembers(const JsonReader& json) {
  requireVersion(json);
  Session session;
  readOptionsOf(json, session);
  for (const JsonReader& json_of_one : json.at("cases").elements()) {
    SessionCase one = readSessionCase(json_of_one);
    if (session.findCase(one.id) != nullptr)
      json_of_one.failMember("id", "'" + one.id + "' is given twice");
    session.cases.push_back(std::move(one));
  }
  readMarksOf(json, session);
  if (const auto review = json.find("review")) session.review = readReviewSettings(*review);
  for (const JsonReader& decision : json.at("decisions").elements()) {
    session.decisions.push_back(readDecision(decision));
    (void)readCaseReference(decision.at("case"), session);
  }
  for (const JsonReader& run : json.at("runs").elements())
    session.runs.push_back(readRun(run, session));
  session.view = readView(json.at("view"), session);
  return session;
}

}  // namespace

ordered_json toJson(const Session& session, const fs::path& file) {
  const PathWriter path(file);
  ordered_json json;
  json["format"] = kSessionFormat;
  json["version"] = kSessionVersion;
  json["profile"] = session.profile;
  json["options"] = toJson(session.options);
  json["cases"] = listJson(session.cases, [&](const auto& one) { return toJson(*one, path); });
  json["annotations"] = ordered_json::object();
  for (const auto& [id, annotation] : session.annotations)
    json["annotations"][id] = toJson(*annotation);
  for (const auto& [id, passes] : session.passes) json["passes"][id] = listJson(*passes, passJson);
  if (session.review != ReviewSettings()) json["review"] = toJson(session.review);
  json["decisions"] = listJson(session.decisions, [](const Decision& one) { return toJson(one); });
  json["runs"] = listJson(session.runs, [&](const RunRecord& run) { return runJson(run, path); });
  json["view"] = viewJson(session.view);
  return json;
}

std::string sessionText(const Session& session, const fs::path& file) {
  const ordered_json json = toJson(session, file);
  try {
    (void)json.dump();  // strict: text that is not UTF-8 would be written as something else
  } catch (const nlohmann::json::exception&) {
    throw OutputError(file, "a name or comment in the session is not UTF-8 text");
  }
  return prettyJson(json);
}

Session readSession(const JsonReader& json) { return json.whole(readMembers); }

}  // namespace boresight::sessions
