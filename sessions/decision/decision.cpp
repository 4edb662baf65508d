// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/decision.h"

#include <stdexcept>

#include "sessions/decision/check_limits.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr auto kVerdict = choiceOf<Verdict>("validated", "rejected", "reopened");
constexpr auto kState = choiceOf<CheckState>("passed", "failed", "not_applicable");
constexpr auto kSource = choiceOf<PoseSource>("run", "annotation");
constexpr auto kSide = choiceOf<LimitSide>("at_most", "at_least");
constexpr auto kMatrix =
    jsonCodec<Matrix6d>([](const JsonReader& json) { return json.matrix<6>(); });

std::map<std::string, std::string> readFingerprint(const JsonReader& json) {
  std::map<std::string, std::string> fingerprint;
  for (const auto& [name, sha256] : json.members()) fingerprint[name] = readSha256(sha256);
  return fingerprint;
}

}  // namespace

template <class Archive, ConstOr<PoseCovariance> Self>
void fields(Archive& archive, Self& covariance) {
  archive.field("picture", covariance.picture, kMatrix);
  archive.field("mesh_scale", covariance.mesh_scale, kMatrix);
  archive.field("calibration", covariance.calibration, kMatrix);
}

template <class Archive, ConstOr<JudgedPose> Self>
void fields(Archive& archive, Self& pose) {
  archive.field("source", pose.source, kSource);
  archive.field("camera_from_station", pose.camera_from_station, kExactPose);
  archive.object("covariance", pose.covariance);
}

template <class Archive, ConstOr<Approval> Self>
void fields(Archive& archive, Self& approval) {
  archive.field("by", approval.by, kNonEmptyText);
  archive.field("comment", approval.comment, kAnyText);
  archive.field("time", approval.time, kTime);
}

template <class Archive, ConstOr<JudgedCheck> Self>
void fields(Archive& archive, Self& judged) {
  auto& check = judged.check;
  archive.field("id", check.id, kNonEmptyText);
  archive.field("title", check.title, kAnyText);
  archive.field("state", check.state, kState);
  archive.optional("figure", check.figure, kNumber);
  archive.optional("limit", check.limit, kNumber);
  if (check.limit) archive.field("side", check.side, kSide);
  archive.optional("unit", check.unit, kAnyText);
  archive.field("sentence", check.sentence, kAnyText);
  archive.optional("waiver_reason", judged.waiver_reason, kAnyText);
}

template <class Archive, ConstOr<Decision> Self>
void fields(Archive& archive, Self& decision) {
  archive.field("case", decision.case_id, kAnyText);
  archive.field("verdict", decision.verdict, kVerdict);
  archive.field("by", decision.by, kNonEmptyText);
  archive.field("comment", decision.comment, kAnyText);
  archive.field("time", decision.time, kTime);
  archive.optional("run", decision.digest, kSha256);
  archive.object("pose", decision.pose);
  archive.optional("input_fingerprint", decision.input_fingerprint, plainCodec(&readFingerprint));
  archive.optionalList("checks", decision.checks);
  archive.optional("convergence_seeds", decision.convergence_seeds, integerIn(1, 1000));
  archive.object("approval", decision.approval);
}

ordered_json toJson(const PoseCovariance& covariance) { return fieldsJson(covariance); }
PoseCovariance readPoseCovariance(const JsonReader& json) {
  return readFields<PoseCovariance>(json);
}

ordered_json toJson(const JudgedCheck& judged) { return fieldsJson(judged); }
JudgedCheck readJudgedCheck(const JsonReader& json) { return readFields<JudgedCheck>(json); }

ordered_json toJson(const Decision& decision) { return fieldsJson(decision); }
Decision readDecision(const JsonReader& json) { return readFields<Decision>(json); }

ordered_json toJson(const ReviewSettings& settings) {
  return {{"preset", settings.preset},
          {"limits", toJson(settings.limits)},
          {"second_person", settings.second_person}};
}

ReviewSettings readReviewSettings(const JsonReader& json) {
  ReviewSettings settings{json.at("preset").text(), readOptions(json.at("limits")),
                          json.at("second_person").boolean()};
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
