// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_file.h"

#include <algorithm>
#include <utility>

#include "sessions/annotation/annotations_file.h"
#include "sessions/decision/decision.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/files/link_target.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

fs::path companionFile(const fs::path& session_file, const std::string& kind) {
  fs::path name = session_file;
  if (name.extension() == ".json") return name.replace_extension("." + kind);
  name += "-" + kind;  // a session NAME.json next to it has NAME.KIND
  return name;
}

/// Options by their difference from the default profile.
constexpr auto kRunOptions =
    Codec{[](const LocalizerOptions& options) {
            OptionList list = changedOptions(options, defaultProfile());
            std::sort(list.begin(), list.end());
            return toJson(list);
          },
          [](const JsonReader& json) {
            LocalizerOptions options = defaultProfile();
            applyConfig(options, {json.file(), "default", readOptions(json)});
            return options;
          }};

constexpr auto kVector =
    jsonCodec<Eigen::Vector3d>([](const JsonReader& json) { return json.vector3(); });

/// InputError unless the session has this case.
void requireCase(const Session& session, const std::string& id, const JsonReader& at) {
  if (session.findCase(id) == nullptr) at.fail("there is no case '" + id + "'");
}

/// Annotations by case.
void readAnnotationsOf(const JsonReader& json, Session& session) {
  for (const auto& [id, annotation] : json.at("annotations").members()) {
    requireCase(session, id, annotation);
    session.annotations.insert_or_assign(id, readAnnotations(annotation));
  }
  const auto rounds = json.find("rounds");
  if (!rounds) return;
  for (const auto& [id, list] : rounds->members()) {
    requireCase(session, id, list);
    session.rounds.insert_or_assign(id, readRounds(list));
  }
}

/// An object with a member for each element of a map. As a member is added by its name, all others
/// are compared with it.
template <class Map>
ordered_json objectOf(const Map& map) {
  ordered_json json = ordered_json::object();
  auto& members = json.get_ref<ordered_json::object_t&>();
  members.reserve(map.size());
  for (const auto& [name, value] : map) members.emplace_back(name, toJson(*value));
  return json;
}

/// The first text that is not UTF-8, behind its place: ".cases[0].image.file: 'caf\xE9.png'"; ""
/// where all are.
std::string foreignText(const ordered_json& json) {
  if (json.is_string()) {
    const auto text = json.get<std::string>();
    return isUtf8(text) ? "" : ": '" + utf8Text(text) + "'";
  }
  if (!json.is_structured()) return "";
  for (const auto& item : json.items()) {
    if (!isUtf8(item.key())) return ": '" + utf8Text(item.key()) + "'";
    const std::string found = foreignText(item.value());
    if (!found.empty())
      return (json.is_array() ? "[" + item.key() + "]" : "." + item.key()) + found;
  }
  return "";
}

}  // namespace

template <class Archive, ConstOr<OptionChange> Self>
void fields(Archive& archive, Self& change) {
  archive.field("iteration", change.iteration, integerIn(1, 1000000));
  archive.field("options", change.options, kRunOptions);
}

template <class Archive, ConstOr<RerunRecord> Self>
void fields(Archive& archive, Self& record) {
  archive.optional("from", record.from, kSha256);
  archive.field("options", record.options, kRunOptions);
  archive.list("changes", record.changes);
  if constexpr (Archive::kReads) {
    const std::string problem = planProblem(record);
    if (!problem.empty()) archive.json().failMember("changes", problem);
  }
}

template <class Archive, ConstOr<ViewOutcome> Self>
void fields(Archive& archive, Self& view) {
  archive.field("case", view.case_id, kNonEmptyText);
  archive.field("status", view.status, plainCodec(&readRunStatus));
}

template <class Archive, ConstOr<TogetherRecord> Self>
void fields(Archive& archive, Self& record) {
  archive.list("views", record.views);
  if constexpr (Archive::kReads)
    if (record.views.size() < 2) archive.json().failMember("views", "has fewer than two");
  archive.field("inputs_sha256", record.inputs_sha256, kSha256);
}

template <class Archive, ConstOr<RunRecord> Self>
void fields(Archive& archive, Self& run) {
  archive.field("case", run.case_id, kAnyText);
  archive.field("digest", run.digest, kSha256);
  archive.path("file", run.file, FileUse::kRun);
  archive.field("status", run.status, plainCodec(&readRunStatus));
  archive.field("version", run.version, kNonEmptyText);
  archive.field("time", run.time, kTime);
  archive.field("inputs_sha256", run.inputs_sha256, kSha256);
  archive.field("options_sha256", run.options_sha256, kSha256);
  archive.object("rerun", run.rerun);
  archive.optional("end_effector_in_camera_m", run.end_effector_in_camera_m, kVector);
  archive.object("together", run.together);
}

template <class Archive, ConstOr<DocumentView> Self>
void fields(Archive& archive, Self& view) {
  archive.optional("case", view.case_id, kAnyText);
  archive.optional("run", view.digest, kSha256);
  std::optional<int> iteration;
  if (view.iteration >= 0) iteration = view.iteration;
  archive.optional("iteration", iteration, integerIn(0, 1000000));
  if constexpr (Archive::kReads) view.iteration = iteration.value_or(-1);
}

namespace {

void requireVersion(const JsonReader& json) {
  if (!json.value().is_object()) json.fail("not a JSON object");
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

Session readMembers(const JsonReader& json) {
  requireVersion(json);
  Session session;
  session.profile = json.at("profile").nonEmptyText();
  session.options = readOptions(json.at("options"));
  (void)sessionOptions(session, json.file());  // throws when one does not exist or fit
  for (const JsonReader& case_json : json.at("cases").elements()) {
    SessionCase session_case = readSessionCase(case_json);
    if (session.findCase(session_case.id) != nullptr)
      case_json.failMember("id", "'" + session_case.id + "' is given twice");
    session.cases.push_back(std::move(session_case));
  }
  readAnnotationsOf(json, session);
  if (const auto robust = json.find("robust_annotations"))
    session.robust_annotations = robust->boolean();
  if (const auto review = json.find("review")) session.review = readReviewSettings(*review);
  for (const JsonReader& item : json.at("decisions").elements()) {
    Decision decision = readDecision(item);
    requireCase(session, decision.case_id, item.at("case"));
    session.decisions.push_back(std::move(decision));
  }
  for (const JsonReader& item : json.at("runs").elements()) {
    RunRecord run = readRunRecord(item);
    requireCase(session, run.case_id, item.at("case"));
    session.runs.push_back(std::move(run));
  }
  session.view = readView(json.at("view"));
  if (const auto chosen = json.at("view").find("case"))
    requireCase(session, session.view.case_id, *chosen);
  return session;
}

}  // namespace

fs::path journalFileOf(const fs::path& session_file) {
  return companionFile(session_file, "journal");
}
fs::path lockFileOf(const fs::path& session_file) { return companionFile(session_file, "lock"); }
fs::path runsFolderOf(const fs::path& session_file) { return companionFile(session_file, "runs"); }

fs::path runFileOf(const fs::path& session_file, const std::string& digest) {
  return runsFolderOf(session_file) / (digest + ".trace");
}

SavedSession readSessionFile(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxSessionBytes, FileUse::kSession);
  if (asText(bytes).starts_with("PK\x03\x04"))
    throw InputError(file, "an archive of whs pack: unpack it, then open its session");
  const JsonDocument document(linkTarget(file), asText(bytes));  // its inputs are relative to that
  return {readSession(document.root()), sha256Text(bytes), bytes.size()};
}

std::string sessionFileText(const Session& session, const fs::path& file) {
  std::string text = sessionText(session, file);
  if (text.size() > kMaxSessionBytes)
    throw OutputError(file, "the session is larger than the limit of " +
                                std::to_string(kMaxSessionBytes / kMegabyte) + " MB");
  return text;
}

std::string writeSessionFile(const fs::path& file, const Session& session) {
  const std::string text = sessionFileText(session, file);
  writeFileAtomically(file, text, FileUse::kSession);
  return sha256Text(text);
}

ordered_json toJson(const RunRecord& run, const PathWriter& path) { return fieldsJson(run, &path); }
RunRecord readRunRecord(const JsonReader& json) { return readFields<RunRecord>(json); }

ordered_json toJson(const AnnotationRounds& rounds) {
  ordered_json json = ordered_json::array();
  for (const AnnotationRound& round : rounds) {
    ordered_json value = {{"by", round.by}, {"time", round.time}};
    value.update(toJson(round.annotations));
    json.push_back(std::move(value));
  }
  return json;
}

AnnotationRounds readRounds(const JsonReader& json) {
  AnnotationRounds all;
  for (const JsonReader& round : json.elements())
    all.push_back(
        {round.at("by").nonEmptyText(), readTime(round.at("time")), readAnnotations(round)});
  if (all.empty()) json.fail("there is none: leave the case out");
  return all;
}

ordered_json toJson(const DocumentView& view) { return fieldsJson(view); }
DocumentView readView(const JsonReader& json) { return readFields<DocumentView>(json); }

ordered_json toJson(const Session& session, const fs::path& file) {
  const PathWriter path(file);
  ordered_json json;
  json["format"] = kSessionFormat;
  json["version"] = kSessionVersion;
  json["profile"] = session.profile;
  json["options"] = toJson(session.options);
  json["cases"] = ordered_json::array();
  for (const auto& session_case : session.cases)
    json["cases"].push_back(toJson(*session_case, path));
  json["annotations"] = objectOf(session.annotations);
  if (!session.rounds.empty()) json["rounds"] = objectOf(session.rounds);
  if (session.robust_annotations) json["robust_annotations"] = true;
  if (session.review != ReviewSettings()) json["review"] = toJson(session.review);
  json["decisions"] = ordered_json::array();
  for (const Decision& decision : session.decisions) json["decisions"].push_back(toJson(decision));
  json["runs"] = ordered_json::array();
  for (const RunRecord& run : session.runs) json["runs"].push_back(toJson(run, path));
  json["view"] = toJson(session.view);
  return json;
}

std::string sessionText(const Session& session, const fs::path& file) {
  const ordered_json json = toJson(session, file);
  try {
    (void)json.dump();  // strict: text that is not UTF-8 would be written as something else
  } catch (const nlohmann::json::exception&) {
    throw OutputError(file,
                      foreignText(json).substr(1) + " is not UTF-8 text: rename or retype it");
  }
  return prettyJson(json);
}

Session readSession(const JsonReader& json) { return json.whole(readMembers); }

}  // namespace boresight::sessions
