// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sessions/evaluation/results_file.h"
#include "sessions/io/errors.h"
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

/// Runs whs and kills it as soon as its results hold `runs` runs; how many they hold then.
int killAfter(const Arguments& arguments, const std::filesystem::path& results, int runs) {
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> words = {const_cast<char*>(BORESIGHT_WHS)};
    for (const std::string& argument : arguments)
      words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execv(BORESIGHT_WHS, words.data());
    _exit(127);
  }
  const auto held = [&results] {
    try {
      return static_cast<int>(sessions::readResults(results).runs.size());
    } catch (const sessions::FileError&) {
      return 0;  // not there yet
    }
  };
  int status = 0;
  while (held() < runs && waitpid(child, &status, WNOHANG) == 0) usleep(2000);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return held();
}

TEST_F(WhsEvaluate, GoesOnAfterItWasKilledWithoutRedoingOrLosingARun) {
  const Arguments options = {"--reseed", "5", "--jobs", "2", "--set", "loop.max_iterations=1"};
  const Arguments arguments = evaluateArguments(dataset_, options);
  int held = 0;
  int kills = 0;
  for (int at = 2; at <= 8; at += 3, ++kills) {
    const int after = killAfter(arguments, folder_ / "r.sqlite", at);
    EXPECT_GE(after, held) << "nothing that was there is lost";
    held = after;
  }
  ASSERT_GE(held, 1);
  const ProgramRun last = runWhs(arguments);
  EXPECT_EQ(last.exit_code, 0) << last.err;
  EXPECT_THAT(last.err, HasSubstr("going on, " + std::to_string(held) + " of 12 runs are there"));
  const sessions::Results results = sessions::readResults(folder_ / "r.sqlite");
  ASSERT_EQ(results.runs.size(), 12u);
  std::int64_t done = 0;
  for (const sessions::Sitting& sitting : results.facts.sittings) done += sitting.runs;
  EXPECT_EQ(done, 12) << "none was done twice";
  const auto resumed = lines();

  std::filesystem::remove(folder_ / "r.sqlite");
  EXPECT_EQ(runWhs(arguments).exit_code, 0);
  const auto undisturbed = lines();
  ASSERT_EQ(resumed.size(), undisturbed.size());
  for (std::size_t i = 0; i < resumed.size(); ++i) {
    EXPECT_EQ(resumed[i]["id"], undisturbed[i]["id"]);
    EXPECT_EQ(resumed[i]["reseed"], undisturbed[i]["reseed"]);
    EXPECT_EQ(resumed[i]["digest"], undisturbed[i]["digest"]);
  }
}

TEST_F(WhsEvaluate, RefusesToGoOnWithOtherOptions) {
  const Arguments quick = {"--set", "loop.max_iterations=1"};
  ASSERT_EQ(runWhs(evaluateArguments(dataset_, quick)).exit_code, 0);
  const std::string before = folder_.read("r.sqlite");
  const ProgramRun other = runWhs(evaluateArguments(dataset_, {"--set", "loop.max_iterations=2"}));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_EQ(other.errorLines(), 1) << other.err;
  EXPECT_THAT(other.err, HasSubstr("loop.max_iterations 1, not 2; name another file"));
  EXPECT_EQ(folder_.read("r.sqlite"), before);
  const ProgramRun again = runWhs(evaluateArguments(dataset_, quick));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("2 of 2 runs are there already"));
}

TEST_F(WhsEvaluate, MergesShardsToWhatOneRunGives) {
  const Arguments quick = {"--reseed", "1", "--set", "loop.max_iterations=1"};
  ASSERT_EQ(runWhs(evaluateArguments(dataset_, quick)).exit_code, 0);
  Arguments merge = {"merge", (folder_ / "merged.sqlite").string()};
  for (const std::string shard : {"2/2", "1/2"}) {
    Arguments arguments = {"evaluate", "--dataset", dataset_.string(), "--shard", shard, "--out"};
    arguments.push_back((folder_ / ("shard" + shard.substr(0, 1) + ".sqlite")).string());
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    ASSERT_EQ(runWhs(arguments).exit_code, 0);
    merge.push_back(arguments[6]);
  }
  const ProgramRun merged = runWhs(merge);
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("4 runs"));
  const auto one = sessions::readResults(folder_ / "r.sqlite").runs;
  const auto joined = sessions::readResults(folder_ / "merged.sqlite").runs;
  ASSERT_EQ(one.size(), joined.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].case_id, joined[i].case_id);
    EXPECT_EQ(one[i].digest, joined[i].digest);
  }
  EXPECT_EQ(runWhs({"evaluate", "--dataset", dataset_.string(), "--shard", "3/2", "--out",
                    (folder_ / "x").string()})
                .exit_code,
            2);
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
