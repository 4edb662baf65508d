// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/decision.h"

#include <gtest/gtest.h>

#include <functional>

#include <nlohmann/json.hpp>

#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;
using nlohmann::ordered_json;

/// The value that `read` gives for a document.
template <class Value>
Value readBack(const ordered_json& json, Value (*read)(const JsonReader&)) {
  const JsonDocument document("session.json", json.dump());
  return document.root().whole(read);
}

/// Message of the refusal of a document; "" when it is read.
template <class Value>
std::string refusal(const ordered_json& json, Value (*read)(const JsonReader&)) {
  try {
    (void)readBack(json, read);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Decision wholeDecision(Random& random) {
  Decision decision = randomDecision(random, "a");
  decision.digest = randomSha256(random);
  decision.checks = {{randomCheck(random), "a reason"}};
  decision.checks[0].check.limit = 0.25;
  decision.pose.emplace().source = PoseSource::kAnnotation;
  decision.pose->covariance.calibration.setIdentity();
  decision.approval = Approval{"Bob", "yes", "2026-01-31T23:59:59Z"};
  decision.input_fingerprint = {{"truth", randomSha256(random)}};
  decision.convergence_seeds = 20;
  return decision;
}

TEST(DecisionJson, AnyDecision_IsReadAsItWasWritten) {
  Random random = randomFor("DecisionJson");
  for (int i = 0; i < 100; ++i) {
    const Decision decision = i % 4 == 0 ? wholeDecision(random) : randomDecision(random, "a");
    EXPECT_EQ(readBack(toJson(decision), &readDecision), decision);
    const JudgedCheck judged{randomCheck(random), coin(random) ? "a reason" : ""};
    EXPECT_EQ(readBack(toJson(judged), &readJudgedCheck), judged);
  }
}

/// Files of other versions are read by these texts.
TEST(DecisionJson, Choices_HaveTheirNamesInFiles) {
  Decision decision;
  decision.by = "Ada";
  decision.time = "2026-01-31T23:59:59Z";
  decision.checks = {{measuredCheck({"a", "A"}, "mm", 1.0, 2.0, LimitSide::kAtMost, "", ""), ""},
                     {measuredCheck({"b", "B"}, "", 1.0, 2.0, LimitSide::kAtLeast, "", ""), "so"},
                     {notAskedCheck({"c", "C"}, ""), ""}};
  decision.pose.emplace();
  decision.verdict = Verdict::kValidated;
  const ordered_json json = toJson(decision);
  EXPECT_EQ(json["verdict"], "validated");
  EXPECT_EQ(json["pose"]["source"], "run");
  const ordered_json& checks = json["checks"];
  EXPECT_EQ(checks[0]["state"], "passed");
  EXPECT_EQ(checks[0]["side"], "at_most");
  EXPECT_EQ(checks[1]["state"], "failed");
  EXPECT_EQ(checks[1]["side"], "at_least");
  EXPECT_EQ(checks[2]["state"], "not_applicable");
  for (const char* member : {"figure", "limit", "side", "unit", "waiver_reason"})
    EXPECT_FALSE(checks[2].contains(member)) << member;
  for (const char* member : {"run", "input_fingerprint", "convergence_seeds", "approval"})
    EXPECT_FALSE(json.contains(member)) << member;
  decision.verdict = Verdict::kRejected;
  decision.pose->source = PoseSource::kAnnotation;
  EXPECT_EQ(toJson(decision)["verdict"], "rejected");
  EXPECT_EQ(toJson(decision)["pose"]["source"], "annotation");
  decision.verdict = Verdict::kReopened;
  EXPECT_EQ(toJson(decision)["verdict"], "reopened");
}

TEST(DecisionJson, InvalidMember_IsRefusedWithItsPlace) {
  Random random = randomFor("DecisionJson.Invalid");
  const ordered_json good = toJson(wholeDecision(random));
  ASSERT_EQ(refusal(good, &readDecision), "");
  const std::pair<const char*, std::function<void(ordered_json&)>> edits[] = {
      {"verdict", [](auto& json) { json["verdict"] = "accepted"; }},
      {"by", [](auto& json) { json["by"] = ""; }},
      {"by", [](auto& json) { json.erase("by"); }},
      {"time", [](auto& json) { json["time"] = "yesterday"; }},
      {"run", [](auto& json) { json["run"] = "abc"; }},
      {"input_fingerprint.truth", [](auto& json) { json["input_fingerprint"]["truth"] = "1"; }},
      {"convergence_seeds", [](auto& json) { json["convergence_seeds"] = 0; }},
      {"convergence_seeds", [](auto& json) { json["convergence_seeds"] = 1001; }},
      {"pose.covariance.mesh_scale",
       [](auto& json) { json["pose"]["covariance"]["mesh_scale"].erase(5); }},
      {"checks[0].id", [](auto& json) { json["checks"][0]["id"] = ""; }},
      {"checks[0].side", [](auto& json) { json["checks"][0].erase("side"); }},
      {"approval.by", [](auto& json) { json["approval"]["by"] = ""; }},
      {"more", [](auto& json) { json["more"] = 1; }}};
  for (const auto& [place, edit] : edits) {
    ordered_json json = good;
    edit(json);
    EXPECT_THAT(refusal(json, &readDecision), HasSubstr(place)) << json.dump();
  }
  for (const int seeds : {1, 1000}) {
    ordered_json json = good;
    json["convergence_seeds"] = seeds;
    EXPECT_EQ(readBack(json, &readDecision).convergence_seeds, seeds);
  }
}

TEST(ReviewSettingsJson, AreReadAsWrittenAndRefusedWithTheirMember) {
  const ReviewSettings settings{"photographs", {{"check.sigmas", 2.5}}, true};
  const ordered_json good = toJson(settings);
  EXPECT_EQ(readBack(good, &readReviewSettings), settings);
  const auto refused = [&good](const char* member, const ordered_json& value) {
    ordered_json json = good;
    json[member] = value;
    return refusal(json, &readReviewSettings);
  };
  EXPECT_THAT(refused("preset", "none"), AllOf(HasSubstr("preset"), HasSubstr("'none'")));
  EXPECT_THAT(refused("limits", {{"check.sigma", 1.0}}), HasSubstr("limits"));
  EXPECT_THAT(refused("limits", {{"check.sigmas", 1e9}}), HasSubstr("check.sigmas"));
  EXPECT_THAT(refused("second_person", 1), HasSubstr("second_person"));
}

/// The picture alone tells whether a covariance is known; the causes add up.
TEST(PoseCovarianceTest, Total_IsTheSumOfItsCausesWhereThePictureIsKnown) {
  PoseCovariance covariance;
  covariance.mesh_scale = 2.0 * Matrix6d::Identity();
  covariance.calibration = 3.0 * Matrix6d::Identity();
  EXPECT_FALSE(covariance.known());
  EXPECT_TRUE(covariance.total().isZero());
  covariance.picture(0, 0) = 1.0;
  EXPECT_TRUE(covariance.known());
  EXPECT_EQ(covariance.total().diagonal().sum(), 31.0);
  EXPECT_EQ(readBack(toJson(covariance), &readPoseCovariance), covariance);
  covariance.picture(5, 5) = NAN;
  EXPECT_FALSE(covariance.known());
}

}  // namespace
}  // namespace boresight::test
