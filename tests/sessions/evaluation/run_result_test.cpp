// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_result.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

RunResult completedWith(double normal_mm) {
  RunResult result;
  result.case_id = "bc-1";
  result.status = "converged";
  result.completed = true;
  result.error.emplace().normal_mm = normal_mm;
  result.requirement.emplace().normal_mm = 0.4;
  return result;
}

TEST(Judge, DecidesByTruthRequirementAndMesh) {
  const struct {
    const char* name;
    double normal_mm;  ///< 0.4 is required
    bool completed, has_truth, wrong_mesh;
    std::optional<bool> success;
    bool false_positive, gross;
  } runs[] = {{"within the requirement", -0.39, true, true, false, true, false, false},
              {"beyond the requirement", 0.41, true, true, false, false, true, false},
              {"beyond three times the requirement", 1.21, true, true, false, false, true, true},
              {"did not complete", 50.0, false, true, false, false, false, false},
              {"without truth", 0.0, true, false, false, {}, false, false},
              {"completed with a wrong mesh", 0.0, true, true, true, false, true, true},
              {"did not complete with a wrong mesh", 0.0, false, true, true, false, false, false}};
  for (const auto& run : runs) {
    SCOPED_TRACE(run.name);
    RunResult result = completedWith(run.normal_mm);
    result.completed = run.completed;
    if (!run.has_truth) result.error.reset();
    judge(run.wrong_mesh, result);
    EXPECT_EQ(result.success, run.success);
    EXPECT_EQ(result.false_positive, run.false_positive);
    EXPECT_EQ(result.gross_false_positive, run.gross);
  }
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
  EXPECT_TRUE(toJson(RunResult())["success"].is_null()) << "it cannot be judged";
}

TEST(NoteTrace, TakesTheProbabilityAndTheLeastMarginFromTheRun) {
  const LocalizationTrace& run = test::exampleTrace();
  ASSERT_GT(run.evidence.finest().places, 0);
  RunResult result;
  noteTrace(run, result);
  EXPECT_EQ(result.probability, run.probability);
  EXPECT_EQ(result.evidence_nats, run.evidence.strongest_nats());
  EXPECT_EQ(result.weakest_quadrant_nats, run.evidence.weakest_nats());
  EXPECT_EQ(toJson(result)["probability"], run.probability);
  LocalizationTrace competing;
  for (const double margin_nats : {7.5, -2.5, 4.0})
    competing.competing_poses.push_back({Pose(), 0.9, margin_nats});
  RunResult of_competing;
  noteTrace(competing, of_competing);
  EXPECT_EQ(of_competing.competing_poses, 3);
  EXPECT_EQ(of_competing.least_margin_nats, -2.5);
  EXPECT_EQ(of_competing.probability, std::nullopt) << "the run measured no evidence";
}

}  // namespace
}  // namespace boresight::sessions
