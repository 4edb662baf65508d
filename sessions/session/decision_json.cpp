// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/decision_json.h"

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "sessions/io/config_file.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/pose_file.h"
#include "sessions/session/case_json.h"
#include "sessions/session/check_limits.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

using nlohmann::ordered_json;

namespace {

constexpr const char* kVerdictNames[] = {"validated", "rejected", "reopened"};
constexpr const char* kStateNames[] = {"passed", "failed", "not_applicable"};
constexpr const char* kSourceNames[] = {"run", "annotation"};
constexpr const char* kSideNames[] = {"at_most", "at_least"};

template <class Enum, std::size_t N>
const char* nameOf(const char* const (&names)[N], Enum value) {
  return names[static_cast<std::size_t>(value)];
}

template <class Enum, std::size_t N>
Enum valueOf(const char* const (&names)[N], const std::string& name) {
  std::size_t i = 0;
  while (i + 1 < N && name != names[i]) ++i;
  return static_cast<Enum>(i);
}

ordered_json approvalJson(const Approval& approval) {
  return {{"by", approval.by}, {"comment", approval.comment}, {"time", approval.time}};
}

Approval readApproval(const JsonReader& json) {
  return {json.at("by").nonEmptyText(), json.at("comment").text(), readTime(json.at("time"))};
}

}  // namespace

ordered_json toJson(const PoseCovariance& covariance) {
  return {{"picture", toJson(covariance.picture)},
          {"mesh_scale", toJson(covariance.mesh_scale)},
          {"calibration", toJson(covariance.calibration)}};
}

PoseCovariance readPoseCovariance(const JsonReader& json) {
  return {readMatrix6(json.at("picture")), readMatrix6(json.at("mesh_scale")),
          readMatrix6(json.at("calibration"))};
}

namespace {

ordered_json judgedPoseJson(const JudgedPose& pose) {
  ordered_json json;
  json["source"] = nameOf(kSourceNames, pose.source);
  json["camera_from_station"] = exactPoseJson(pose.camera_from_station);
  json["covariance"] = toJson(pose.covariance);
  return json;
}

JudgedPose readJudgedPose(const JsonReader& json) {
  JudgedPose pose;
  pose.source = valueOf<PoseSource>(kSourceNames, json.at("source").choice({"run", "annotation"}));
  pose.camera_from_station = readExactPose(json.at("camera_from_station"));
  pose.covariance = readPoseCovariance(json.at("covariance"));
  return pose;
}

}  // namespace

std::string readTime(const JsonReader& json) {
  std::string text = json.text();
  if (!isUtcText(text)) json.fail("not a time like 2026-01-31T23:59:59Z");
  return text;
}

ordered_json toJson(const JudgedCheck& judged) {
  const Check& check = judged.check;
  ordered_json json;
  json["id"] = check.id;
  json["title"] = check.title;
  json["state"] = nameOf(kStateNames, check.state);
  if (check.figure) json["figure"] = *check.figure;
  if (check.limit) {
    json["limit"] = *check.limit;
    json["side"] = nameOf(kSideNames, check.side);
  }
  if (!check.unit.empty()) json["unit"] = check.unit;
  json["sentence"] = check.sentence;
  if (!judged.override_reason.empty()) json["override_reason"] = judged.override_reason;
  return json;
}

JudgedCheck readJudgedCheck(const JsonReader& json) {
  JudgedCheck judged;
  Check& check = judged.check;
  check.id = json.at("id").nonEmptyText();
  check.title = json.at("title").text();
  check.state = valueOf<CheckState>(
      kStateNames, json.at("state").choice({"passed", "failed", "not_applicable"}));
  if (const auto figure = json.find("figure")) check.figure = figure->number();
  if (const auto limit = json.find("limit")) {
    check.limit = limit->number();
    check.side = valueOf<LimitSide>(kSideNames, json.at("side").choice({"at_most", "at_least"}));
  }
  if (const auto unit = json.find("unit")) check.unit = unit->text();
  check.sentence = json.at("sentence").text();
  if (const auto reason = json.find("override_reason")) judged.override_reason = reason->text();
  return judged;
}

ordered_json toJson(const Decision& decision) {
  ordered_json json;
  json["case"] = decision.case_id;
  json["verdict"] = nameOf(kVerdictNames, decision.verdict);
  json["by"] = decision.by;
  json["comment"] = decision.comment;
  json["time"] = decision.time;
  if (!decision.digest.empty()) json["run"] = decision.digest;
  if (decision.pose) json["pose"] = judgedPoseJson(*decision.pose);
  if (!decision.grounds.empty()) json["grounds"] = decision.grounds;
  for (const JudgedCheck& judged : decision.checks) json["checks"].push_back(toJson(judged));
  if (decision.basin_seeds > 0) json["basin_seeds"] = decision.basin_seeds;
  if (decision.approval) json["approval"] = approvalJson(*decision.approval);
  return json;
}

Decision readDecision(const JsonReader& json) {
  Decision decision;
  decision.case_id = json.at("case").text();
  decision.verdict = valueOf<Verdict>(
      kVerdictNames, json.at("verdict").choice({"validated", "rejected", "reopened"}));
  decision.by = json.at("by").nonEmptyText();
  decision.comment = json.at("comment").text();
  decision.time = readTime(json.at("time"));
  if (const auto run = json.find("run")) decision.digest = readSha256(*run);
  if (const auto pose = json.find("pose")) decision.pose = readJudgedPose(*pose);
  if (const auto grounds = json.find("grounds"))
    for (const auto& [name, sha256] : grounds->members())
      decision.grounds[name] = readSha256(sha256);
  if (const auto checks = json.find("checks"))
    for (const JsonReader& check : checks->elements())
      decision.checks.push_back(readJudgedCheck(check));
  if (const auto seeds = json.find("basin_seeds"))
    decision.basin_seeds = static_cast<int>(seeds->integer(1, 1000));
  if (const auto approval = json.find("approval")) decision.approval = readApproval(*approval);
  return decision;
}

ordered_json toJson(const ReviewSettings& settings) {
  ordered_json json;
  json["preset"] = settings.preset;
  json["limits"] = toJson(settings.limits);
  json["second_person"] = settings.second_person;
  return json;
}

ReviewSettings readReviewSettings(const JsonReader& json) {
  ReviewSettings settings;
  settings.preset = json.at("preset").text();
  settings.limits = readOptions(json.at("limits"));
  settings.second_person = json.at("second_person").boolean();
  try {
    (void)checkLimits(settings.preset, settings.limits);
  } catch (const OptionError& error) {
    json.failMember("limits", error.what());
  } catch (const std::invalid_argument& error) {
    json.failMember("preset", error.what());
  }
  return settings;
}

}  // namespace boresight::sessions
