// SPDX-License-Identifier: Apache-2.0
// Methods beside WHS, on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The test matcher as a command, without quotes: runProgram's own surround it.
std::string matcherCommand(const std::string& what) {
  return std::string(BORESIGHT_TEST_MATCHER) + " " + what;
}

class WhsMethods : public testing::Test {
 protected:
  std::vector<nlohmann::json> evaluated(const Arguments& more) {
    Arguments arguments = {"evaluate",
                           "--dataset",
                           (exampleFolder() / "dataset.json").string(),
                           "--station",
                           "os",
                           "--out",
                           (folder_ / "r.sqlite").string(),
                           "--jsonl",
                           (folder_ / "r.jsonl").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_ = runWhs(arguments);
    std::istringstream stream(folder_.read("r.jsonl"));
    std::vector<nlohmann::json> made;
    for (std::string line; std::getline(stream, line);) made.push_back(nlohmann::json::parse(line));
    return made;
  }

  const TemporaryFolder folder_;
  ProgramRun run_;
};

TEST_F(WhsMethods, ResultNamesTheMethodAndItsOptions) {
  const ProgramRun run = runWhs(localizeArguments({{"--method", "ncc"},
                                                   {"--set", "ncc.kind=ccorr_normed"},
                                                   {"--out", (folder_ / "result.json").string()}}));
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 4) << run.err;
  const auto result = nlohmann::json::parse(folder_.read("result.json"));
  EXPECT_THAT(result.dump(),
              AllOf(HasSubstr("\"method\":\"ncc\""), HasSubstr("\"ncc.kind\":\"ccorr_normed\"")));
}

TEST_F(WhsMethods, APoseFoundWithoutASearch_IsJudgedByEdgeSupportAndReportedSo) {
  const ProgramRun run =
      runWhs(localizeArguments({{"--method", "ncc"}, {"--set", "support.min_support=1"}}));
  EXPECT_EQ(run.exit_code, 4) << run.out;
  EXPECT_THAT(run.out + run.err,
              AllOf(HasSubstr("edge support is"), Not(HasSubstr("probability"))));
}

TEST_F(WhsMethods, RefusesWhatDoesNotFit) {
  const ProgramRun unknown = runWhs(localizeArguments({{"--method", "sift"}}));
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("sift"), HasSubstr("whs, ncc, ssd, orb")));
  const ProgramRun alone = runWhs(localizeArguments({{"--method", "loftr-r"}}));
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--matcher"));
  const ProgramRun range =
      runWhs(localizeArguments({{"--method", "orb"}, {"--set", "orb.levels=99"}}));
  EXPECT_EQ(range.exit_code, 2);
  EXPECT_THAT(range.err, HasSubstr("orb.levels"));
  const ProgramRun record = runWhs(
      localizeArguments({{"--method", "orb"}, {"--record", (folder_ / "run.whsr").string()}}));
  EXPECT_EQ(record.exit_code, 2);
}

TEST_F(WhsMethods, OptionsListThoseOfTheMethods) {
  const ProgramRun run = runWhs({"options"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* name : {"ssd.masked", "ncc.kind", "orb.features", "external.timeout_s"})
    EXPECT_THAT(run.out, HasSubstr(name));
}

TEST_F(WhsMethods, AMatcherThatDiesIsOneSentence) {
  const ProgramRun run =
      runWhs(localizeArguments({{"--method", "external"}, {"--matcher", matcherCommand("die")}}));
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("ended with status 3"), HasSubstr("out of paper")));
}

TEST_F(WhsMethods, SeveralAreRunSideBySide) {
  const auto results = evaluated({"--method", "whs", "--method", "orb"});
  EXPECT_EQ(run_.exit_code, 0) << run_.err;
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["method"], "orb") << "by name, of the same case and seed";
  EXPECT_EQ(results[1]["method"], "whs");
  EXPECT_EQ(results[1]["success"], true);
}

TEST_F(WhsMethods, AMatcherThatFailsCostsItsCaseAndNotTheRun) {
  for (const char* what : {"die", "babble"}) {
    const auto results = evaluated({"--method", "external", "--method", "whs", "--reseed", "1",
                                    "--matcher", matcherCommand(what)});
    EXPECT_EQ(run_.exit_code, 0) << run_.err;
    ASSERT_EQ(results.size(), 4u);
    for (const auto& result : results) {
      const bool failed = result["method"] == "external";
      EXPECT_EQ(result["status"] == "method_error", failed) << result.dump();
      EXPECT_EQ(result["completed"], !failed);
      EXPECT_EQ(result["success"], !failed) << "a run that was lost is not left out of the share";
      if (failed) {
        EXPECT_THAT(std::string(result["message"]), HasSubstr("the matcher"));
      }
    }
    std::filesystem::remove(folder_ / "r.sqlite");
  }
}

}  // namespace
}  // namespace boresight::test
