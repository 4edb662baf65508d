// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/sqlite.h"
#include "tests/app/ended_whs.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class WhsEvaluate : public testing::Test {
 protected:
  Arguments evaluateArguments(const std::filesystem::path& dataset, const Arguments& more) const {
    Arguments arguments = {"evaluate",           "--dataset", dataset.string(),   "--out",
                           folder_ / "r.sqlite", "--jsonl",   folder_ / "r.jsonl"};
    return with(arguments, more);
  }
  std::vector<nlohmann::json> lines() const { return jsonLines(folder_.read("r.jsonl")); }

  const std::filesystem::path dataset_ = exampleFolder() / "dataset.json";
  const TemporaryFolder folder_;
};

TEST_F(WhsEvaluate, SumsUpTheExample) {
  const ProgramRun run = runWhs(evaluateArguments(dataset_, {"--jobs", "2"}), 0);
  EXPECT_EQ(run.err, "") << "progress belongs on a terminal only";
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("station"), HasSubstr("bc"), HasSubstr("os"), HasSubstr("100.0")));
  const auto results = lines();
  ASSERT_EQ(results.size(), 2u);
  for (const auto& result : results) EXPECT_EQ(result["success"], true) << result.dump();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r.sqlite"));
}

TEST_F(WhsEvaluate, DrawsFurtherSeeds) {
  runWhs(evaluateArguments(dataset_, with({"--station", "os", "--reseed", "2"}, kQuick)), 0);
  const auto results = lines();
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[2]["reseed"], 2);
  EXPECT_NE(results[1]["camera_from_station_seed"], results[2]["camera_from_station_seed"]);
}

TEST_F(WhsEvaluate, CountsEveryCompletedRunWithAWrongMeshAsFalse) {
  runWhs(evaluateArguments(dataset_, {"--mesh-of", "os"}), 0);
  const auto results = lines();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0]["success"], false);
  EXPECT_EQ(results[0]["gross_false_positive"], results[0]["completed"]);
}

TEST_F(WhsEvaluate, StateOfAPart_IsListedAndChanged) {
  std::filesystem::copy(exampleFolder(), folder_ / "data",
                        std::filesystem::copy_options::recursive);
  auto json = nlohmann::json::parse(folder_.read("data/dataset.json"));
  nlohmann::json& os = json["stations"]["os"];
  const nlohmann::json model = {{"mesh", os["mesh"]}, {"mesh_unit", "m"}};
  nlohmann::json gripper = model;
  gripper.update(
      {{"name", "gripper"}, {"frame", "CAMERA"}, {"role", "occludes"}, {"present", false}});
  os.erase("mesh");
  os.erase("mesh_unit");
  os["parts"] = {model, gripper};
  const std::string file = folder_.write("data/dataset.json", json.dump());
  EXPECT_THAT(runWhs({"info", file}, 0).out,
              AllOf(HasSubstr("part model: matched, fixed to STATION\n"),
                    HasSubstr("part gripper: occludes, fixed to CAMERA, off")));

  const Arguments few = with({"--station", "os"}, kQuick);
  runWhs(evaluateArguments(file, few), 0);
  const std::string off = lines().at(0)["digest"];
  const Arguments on = with(few, {"--part", "gripper=on"});
  EXPECT_THAT(runWhs(evaluateArguments(file, on), 3).err, HasSubstr("belong to another dataset"))
      << "results of two states are not mixed";
  std::filesystem::remove(folder_ / "r.sqlite");
  runWhs(evaluateArguments(file, on), 0);
  EXPECT_NE(lines().at(0)["digest"], off);

  const std::string session = folder_ / "s.json";
  runWhs({"new", "--dataset", file, "--case", kOsCase, "--part", "gripper=on", "--out", session},
         0);
  EXPECT_THAT(runWhs({"info", session}, 0).out,
              HasSubstr("part: gripper: occludes, fixed to CAMERA\n"));
  const auto refused = [&](const std::string& part, int exit_code) {
    return runWhs({"new", "--dataset", file, "--part", part, "--out", folder_ / "t.json"},
                  exit_code)
        .err;
  };
  EXPECT_THAT(refused("lid=off", 3), HasSubstr("no station has a part 'lid'"));
  EXPECT_THAT(refused("gripper=matched", 3), HasSubstr("cannot be matched"));
  EXPECT_THAT(refused("gripper", 2), HasSubstr("is not NAME=STATE"));
}

TEST_F(WhsEvaluate, ReportsABadCaseAndGoesOn) {
  std::filesystem::copy(exampleFolder(), folder_ / "data",
                        std::filesystem::copy_options::recursive);
  std::filesystem::remove(folder_ / "data/bc/image.png");
  const ProgramRun run =
      runWhs(evaluateArguments(folder_ / "data/dataset.json", with({"--reseed", "1"}, kQuick)), 3);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("bc/image.png"));
  const auto results = lines();
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0]["status"], "input_error");
  EXPECT_EQ(results[2]["status"], "iteration_limit");
}

TEST_F(WhsEvaluate, KilledEvaluation_ContinuesWithoutLossOrRepetition) {
  const Arguments arguments =
      evaluateArguments(dataset_, with({"--reseed", "5", "--jobs", "2"}, kQuick));
  int held = 0;
  int kills = 0;
  for (int at = 2; at <= 8; at += 3, ++kills) {
    const int after = endWhsAfter(arguments, SIGKILL, folder_ / "r.sqlite", at).held;
    EXPECT_GE(after, held) << "nothing that was there is lost";
    held = after;
  }
  ASSERT_GE(held, 1);
  EXPECT_THAT(runWhs(arguments, 0).err,
              HasSubstr("resumed, " + std::to_string(held) + " of 12 runs are done"));
  const sessions::Results results = sessions::readResults(folder_ / "r.sqlite");
  ASSERT_EQ(results.runs.size(), 12u);
  std::int64_t done = 0;
  for (const sessions::BatchRun& batch_run : results.facts.batch_runs) done += batch_run.runs;
  EXPECT_EQ(done, 12) << "none was done twice";
  const auto resumed = lines();

  std::filesystem::remove(folder_ / "r.sqlite");
  runWhs(arguments, 0);
  const auto undisturbed = lines();
  ASSERT_EQ(resumed.size(), undisturbed.size());
  for (std::size_t i = 0; i < resumed.size(); ++i) {
    EXPECT_EQ(resumed[i]["id"], undisturbed[i]["id"]);
    EXPECT_EQ(resumed[i]["reseed"], undisturbed[i]["reseed"]);
    EXPECT_EQ(resumed[i]["digest"], undisturbed[i]["digest"]);
  }
}

TEST_F(WhsEvaluate, RefusesToGoOnWithOtherOptions) {
  runWhs(evaluateArguments(dataset_, kQuick), 0);
  const std::string before = folder_.read("r.sqlite");
  const ProgramRun other =
      runWhs(evaluateArguments(dataset_, with(kQuick, {"loop.max_iterations=2"})), 3);
  EXPECT_EQ(other.errorLines(), 1) << other.err;
  EXPECT_THAT(other.err, HasSubstr("loop.max_iterations 1, not 2; name another file"));
  EXPECT_EQ(folder_.read("r.sqlite"), before);
  EXPECT_THAT(runWhs(evaluateArguments(dataset_, kQuick), 0).err,
              HasSubstr("2 of 2 runs are done"));
}

TEST_F(WhsEvaluate, MergesShardsToWhatOneRunGives) {
  const Arguments quick = with({"--reseed", "1"}, kQuick);
  runWhs(evaluateArguments(dataset_, quick), 0);
  Arguments merge = {"merge", folder_ / "merged.sqlite"};
  for (const std::string shard : {"2/2", "1/2"}) {
    merge.push_back((folder_ / ("shard" + shard.substr(0, 1) + ".sqlite")).string());
    runWhs(
        with({"evaluate", "--dataset", dataset_, "--shard", shard, "--out", merge.back()}, quick),
        0);
  }
  const ProgramRun merged = runWhs(merge, 0);
  EXPECT_THAT(merged.out, HasSubstr("4 runs"));
  const auto value = sessions::readResults(folder_ / "r.sqlite").runs;
  const auto joined = sessions::readResults(folder_ / "merged.sqlite").runs;
  ASSERT_EQ(value.size(), joined.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    EXPECT_EQ(value[i].case_id, joined[i].case_id);
    EXPECT_EQ(value[i].digest, joined[i].digest);
  }
  runWhs({"evaluate", "--dataset", dataset_.string(), "--shard", "3/2", "--out", folder_ / "x"}, 2);
}

TEST_F(WhsEvaluate, RefusesWhatItCannotRun) {
  runWhs(evaluateArguments("/no/such/dataset.json", {}), 3);
  runWhs(evaluateArguments(dataset_, {"--case", "bc-999"}), 3);
  runWhs(evaluateArguments(dataset_, {"--jobs", "0"}), 2);
  runWhs(evaluateArguments(dataset_, {"--mirror", "w"}), 2);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(WhsEvaluate, SeveralMethodsAreRunSideBySide) {
  runWhs(evaluateArguments(dataset_, {"--station", "os", "--method", "whs", "--method", "orb",
                                      "--set", kNoSearch}),
         0);
  const auto results = lines();
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["method"], "orb") << "by name, of the same case and seed";
  EXPECT_EQ(results[1]["method"], "whs");
  EXPECT_EQ(results[1]["success"], true);
}

TEST_F(WhsEvaluate, AMatcherThatFailsCostsItsCaseAndNotTheRun) {
  for (const char* what : {"die", "babble"}) {
    runWhs(evaluateArguments(dataset_, {"--station", "os", "--method", "external", "--method",
                                        "whs", "--reseed", "1", "--set", kNoSearch, "--matcher",
                                        std::string(BORESIGHT_TEST_MATCHER " ") + what}),
           0);
    const auto results = lines();
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

/// Results of the example, evaluated once: converged runs, and runs that end early.
class WhsTables : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    const Arguments evaluate = {"evaluate", "--dataset", exampleFolder() / "dataset.json", "--out"};
    runWhs(with(evaluate, {*made_ / "good.sqlite", "--set", kNoSearch}), 0);
    runWhs(with(with(evaluate, {*made_ / "bad.sqlite"}), kQuick), 0);
  }
  static void TearDownTestSuite() { made_.reset(); }
  WhsTables() { std::filesystem::copy(made_->path(), folder_.path()); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static std::unique_ptr<TemporaryFolder> made_;
  const TemporaryFolder folder_;
};
std::unique_ptr<TemporaryFolder> WhsTables::made_;

TEST_F(WhsTables, MakesTablesAndFigures) {
  EXPECT_THAT(
      runWhs({"tables", file("good.sqlite"), "--paper", "--figures", file("figures"),
              "--figure-format", "pdf", "png", "svg"},
             0)
          .out,
      AllOf(HasSubstr("Errors per station and method"), HasSubstr("seed"), HasSubstr("whs (paper)"),
            HasSubstr("Time per run and step"), HasSubstr("profile default")));
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "figures"))
    figures += std::filesystem::file_size(entry.path()) > 2000 ? 1 : 0;
  EXPECT_EQ(figures, 15u) << "five figures in three formats";
  const ProgramRun csv = runWhs({"tables", file("good.sqlite"), "--table", "errors", "--station",
                                 "os", "--format", "csv", "--out", file("t.csv")},
                                0);
  EXPECT_EQ(csv.out, "");
  EXPECT_THAT(folder_.read("t.csv"),
              AllOf(HasSubstr("normal mm mean,normal mm std"), HasSubstr("os,near,whs,1,1,100,"),
                    HasSubstr("iterations mean,"), Not(HasSubstr("bc"))));
  EXPECT_THAT(
      runWhs({"tables", file("good.sqlite"), "--table", "errors", "--demonstrate", "95"}, 0).out,
      AllOf(HasSubstr("at least"), HasSubstr("Success rate that the runs demonstrate"),
            HasSubstr("runs missing")));
  folder_.write("counts.json",
                R"({"format": "boresight-instructions", "version": 1, "runs": [{"method": "whs",
                "station": "bc", "case": "bc-1", "initialization": 0, "search": 0, "rendering": 0,
                "matching": 12e9, "pose": 0, "refinement": 0}]})");
  EXPECT_THAT(runWhs({"tables", file("good.sqlite"), "--table", "errors", "--paper",
                      "--instructions", file("counts.json")},
                     0)
                  .out,
              AllOf(HasSubstr("Minutes at 200 MHz"), HasSubstr("1.000"), HasSubstr("21.330")));
  EXPECT_THAT(runWhs({"tables", file("good.sqlite"), "--format", "latex"}).out,
              HasSubstr("\\begin{tabular}"));
}

TEST_F(WhsTables, ComparesTwoResultsRunByRun) {
  const ProgramRun worse =
      runWhs({"tables", file("good.sqlite"), "--against", file("bad.sqlite")}, 6);
  EXPECT_THAT(worse.out, HasSubstr("2 runs in both: 0 better, 2 worse"));
  const ProgramRun same =
      runWhs({"tables", file("good.sqlite"), "--against", file("good.sqlite")}, 0);
  EXPECT_THAT(same.out, HasSubstr("2 the same (2 bit for bit)"));
}

TEST_F(WhsTables, AreOfRunsThatASessionRepeatsAndItsQueueLists) {
  EXPECT_THAT(
      runWhs({"new", "--results", file("bad.sqlite"), "--out", file("q.boresight.json")}, 0).out,
      HasSubstr("2 cases"));
  EXPECT_THAT(folder_.read("q.boresight.json"), HasSubstr("loop.max_iterations"));
  EXPECT_THAT(runWhs({"queue", file("q.boresight.json")}).out,
              HasSubstr("not run in this session; in the results: iteration_limit"));
}

TEST_F(WhsTables, WithATriggerOrAViewAreRefusedByEveryCommand) {
  const std::string dataset = (exampleFolder() / "dataset.json").string();
  for (const char* object :
       {"CREATE TRIGGER stop BEFORE INSERT ON run BEGIN SELECT RAISE(IGNORE); END",
        "DROP TABLE tag; CREATE VIEW tag AS WITH RECURSIVE n(run) AS (SELECT 1 UNION ALL SELECT "
        "run FROM n) SELECT run, 'a' AS tag FROM n"}) {
    std::filesystem::copy(file("bad.sqlite"), file("r.sqlite"),
                          std::filesystem::copy_options::overwrite_existing);
    sessions::SqlDatabase(file("r.sqlite"), sessions::SqlAccess::kWrite).execute(object);
    for (const Arguments& arguments :
         {Arguments{"tables", file("r.sqlite")},
          Arguments{"tables", file("bad.sqlite"), "--against", file("r.sqlite")},
          Arguments{"merge", file("m.sqlite"), file("bad.sqlite"), file("r.sqlite")},
          Arguments{"merge", file("r.sqlite"), file("bad.sqlite")},
          Arguments{"new", "--results", file("r.sqlite"), "--out", file("q.boresight.json")},
          with({"evaluate", "--dataset", dataset, "--out", file("r.sqlite")}, kQuick)}) {
      const ProgramRun run = runWhs(arguments);
      EXPECT_EQ(run.exit_code, 3) << arguments[0] << run.out;
      EXPECT_EQ(run.errorLines(), 1) << run.err;
      EXPECT_THAT(run.err,
                  AllOf(HasSubstr("r.sqlite: its "), HasSubstr("is not from whs evaluate")));
      EXPECT_EQ(run.out, "");
    }
    EXPECT_FALSE(std::filesystem::exists(file("m.sqlite")));
  }
}

TEST_F(WhsTables, RefusesWhatIsNoResults) {
  folder_.write("no.sqlite", "no");
  runWhs({"tables", file("no.sqlite")}, 3);
  runWhs({"tables", file("none.sqlite")}, 3);
  runWhs({"tables"}, 2);
  runWhs({"tables", file("no.sqlite"), "--format", "word"}, 2);
}

}  // namespace
}  // namespace boresight::test
