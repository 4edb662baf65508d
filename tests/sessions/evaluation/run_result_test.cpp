// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_result.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace boresight::sessions {
namespace {

RunResult completedWith(double normal_mm) {
  RunResult result;
  result.case_id = "bc-1";
  result.status = "converged";
  result.completed = true;
  result.error = PoseError{};
  result.error->normal_mm = normal_mm;
  result.requirement = Requirement{};
  result.requirement->normal_mm = 0.4;
  return result;
}

TEST(Judge, CallsACompletedRunWithinTheRequirementASuccess) {
  RunResult result = completedWith(-0.39);
  judge(false, result);
  EXPECT_EQ(result.success, true);
  EXPECT_FALSE(result.false_positive);
  EXPECT_FALSE(result.gross_false_positive);
}

TEST(Judge, CallsACompletedRunBeyondItAFalsePositive) {
  RunResult near = completedWith(0.41);
  judge(false, near);
  EXPECT_EQ(near.success, false);
  EXPECT_TRUE(near.false_positive);
  EXPECT_FALSE(near.gross_false_positive);
  RunResult gross = completedWith(1.21);
  judge(false, gross);
  EXPECT_TRUE(gross.false_positive);
  EXPECT_TRUE(gross.gross_false_positive);
}

TEST(Judge, DoesNotBlameARunThatDidNotComplete) {
  RunResult result = completedWith(50.0);
  result.completed = false;
  judge(false, result);
  EXPECT_EQ(result.success, false);
  EXPECT_FALSE(result.false_positive);
}

TEST(Judge, LeavesOpenWhatHasNoTruthOrRequirement) {
  RunResult result = completedWith(0.0);
  result.error.reset();
  judge(false, result);
  EXPECT_FALSE(result.success.has_value());
}

TEST(Judge, CountsEveryCompletedRunWithAWrongMeshAsGross) {
  RunResult result = completedWith(0.0);
  judge(true, result);
  EXPECT_EQ(result.success, false);
  EXPECT_TRUE(result.gross_false_positive);
  RunResult failed = completedWith(0.0);
  failed.completed = false;
  judge(true, failed);
  EXPECT_FALSE(failed.false_positive);
}

TEST(RunResultJson, HasTheFieldsOfALine) {
  RunResult result = completedWith(0.01);
  result.error->projection_px = 0.3;
  judge(false, result);
  const auto json = toJson(result);
  for (const char* key :
       {"id", "method", "status", "completed", "success", "false_positive", "iterations",
        "camera_from_station", "matches", "inliers", "edge_support", "error", "seconds"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["error"]["normal_mm"], 0.01);
  EXPECT_EQ(json["error"]["projection_px"], 0.3);
  EXPECT_EQ(json.dump().find('\n'), std::string::npos);
}

TEST(RunResultJson, WritesNullForASuccessThatCannotBeJudged) {
  RunResult result;
  EXPECT_TRUE(toJson(result)["success"].is_null());
}

}  // namespace
}  // namespace boresight::sessions
