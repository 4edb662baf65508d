// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class WhsEvaluate : public testing::Test {
 protected:
  Arguments evaluateArguments(const std::filesystem::path& dataset, const Arguments& more) const {
    Arguments arguments = {"evaluate",
                           "--dataset",
                           dataset.string(),
                           "--out",
                           (folder_ / "r.sqlite").string(),
                           "--jsonl",
                           (folder_ / "r.jsonl").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::vector<nlohmann::json> lines() const {
    std::istringstream stream(folder_.read("r.jsonl"));
    std::vector<nlohmann::json> made;
    for (std::string line; std::getline(stream, line);) made.push_back(nlohmann::json::parse(line));
    return made;
  }

  const std::filesystem::path dataset_ = exampleFolder() / "dataset.json";
  const TemporaryFolder folder_;
};

TEST_F(WhsEvaluate, SumsUpTheExample) {
  const ProgramRun run = runWhs(evaluateArguments(dataset_, {"--jobs", "2"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "progress belongs on a terminal only";
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("station"), HasSubstr("bc"), HasSubstr("os"), HasSubstr("100.0")));
  const auto results = lines();
  ASSERT_EQ(results.size(), 2u);
  for (const auto& result : results) EXPECT_EQ(result["success"], true) << result.dump();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r.sqlite"));
}

TEST_F(WhsEvaluate, DrawsFurtherSeeds) {
  const ProgramRun run = runWhs(evaluateArguments(
      dataset_, {"--station", "os", "--reseed", "2", "--set", "loop.max_iterations=1"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto results = lines();
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[2]["reseed"], 2);
  EXPECT_NE(results[1]["camera_from_station_seed"], results[2]["camera_from_station_seed"]);
}

TEST_F(WhsEvaluate, CountsEveryCompletedRunWithAWrongMeshAsFalse) {
  const ProgramRun run = runWhs(evaluateArguments(dataset_, {"--mesh-of", "os"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto results = lines();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0]["success"], false);
  EXPECT_EQ(results[0]["gross_false_positive"], results[0]["completed"]);
}

TEST_F(WhsEvaluate, ReportsABadCaseAndGoesOn) {
  std::filesystem::copy(exampleFolder(), folder_ / "data",
                        std::filesystem::copy_options::recursive);
  std::filesystem::remove(folder_ / "data/bc/image.png");
  const ProgramRun run = runWhs(evaluateArguments(
      folder_ / "data/dataset.json", {"--reseed", "1", "--set", "loop.max_iterations=1"}));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("bc/image.png"));
  const auto results = lines();
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0]["status"], "input_error");
  EXPECT_EQ(results[2]["status"], "iteration_limit");
}

TEST_F(WhsEvaluate, RefusesWhatItCannotRun) {
  EXPECT_EQ(runWhs(evaluateArguments("/no/such/dataset.json", {})).exit_code, 3);
  EXPECT_EQ(runWhs(evaluateArguments(dataset_, {"--case", "bc-999"})).exit_code, 3);
  EXPECT_EQ(runWhs(evaluateArguments(dataset_, {"--jobs", "0"})).exit_code, 2);
  EXPECT_EQ(runWhs(evaluateArguments(dataset_, {"--mirror", "w"})).exit_code, 2);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

}  // namespace
}  // namespace boresight::test
