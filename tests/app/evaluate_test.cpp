// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <gtest/gtest.h>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/sqlite.h"
#include "tests/app/ended_whs.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

class WhsEvaluate : public testing::Test {
 protected:
  Arguments evaluateArguments(const std::string& dataset, const Arguments& more) const {
    return with(
        {"evaluate", "--dataset", dataset, "--out", results_, "--jsonl", folder_ / "r.jsonl"},
        more);
  }
  std::vector<nlohmann::json> lines() const { return jsonLines(folder_.read("r.jsonl")); }

  const std::string dataset_ = exampleDataset();
  const TemporaryFolder folder_;
  const std::string results_ = folder_ / "r.sqlite";
};

TEST_F(WhsEvaluate, SumsUpTheExample) {
  const ProgramRun run = runWhs(evaluateArguments(dataset_, {"--jobs", "2"}), 0);
  EXPECT_EQ(run.err, "") << "progress belongs on a terminal only";
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("station"), HasSubstr("bc"), HasSubstr("os"), HasSubstr("100.0")));
  const auto results = lines();
  ASSERT_EQ(results.size(), 2u);
  for (const auto& result : results) EXPECT_EQ(result["success"], true) << result.dump();
  EXPECT_TRUE(std::filesystem::exists(results_));
}

TEST_F(WhsEvaluate, CountsEveryCompletedRunWithAWrongMeshAsFalse) {
  runWhs(evaluateArguments(dataset_, {"--mesh-of", "os"}), 0);
  const auto results = lines();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0]["success"], false);
  EXPECT_EQ(results[0]["gross_false_positive"], results[0]["completed"]);
}

TEST_F(WhsEvaluate, StateOfAPart_IsListedAndChanged) {
  const std::string file = copyOfExample(folder_);
  auto json = jsonOf(file);
  nlohmann::json& os = json["stations"]["os"];
  const nlohmann::json model = {{"mesh", os["mesh"]}, {"mesh_unit", "m"}};
  nlohmann::json gripper = model;
  gripper.update(
      {{"name", "gripper"}, {"frame", "CAMERA"}, {"role", "occludes"}, {"present", false}});
  os.erase("mesh");
  os.erase("mesh_unit");
  os["parts"] = {model, gripper};
  folder_.write("stations/dataset.json", json.dump());
  EXPECT_THAT(runWhs({"info", file}, 0).out,
              AllOf(HasSubstr("part model: matched, fixed to STATION\n"),
                    HasSubstr("part gripper: occludes, fixed to CAMERA, off")));

  const Arguments few = with({"--station", "os"}, kQuick);
  runWhs(evaluateArguments(file, few), 0);
  const std::string off = lines().at(0)["digest"];
  const Arguments on = with(few, {"--part", "gripper=on"});
  EXPECT_THAT(runWhs(evaluateArguments(file, on), 3).err, HasSubstr("belong to another dataset"))
      << "results of two states are not mixed";
  std::filesystem::remove(results_);
  runWhs(evaluateArguments(file, on), 0);
  EXPECT_NE(lines().at(0)["digest"], off);

  const std::string session = folder_ / "s.json";
  const auto make = [&](const std::string& part, int exit_code) {
    return runWhs({"new", "--dataset", file, "--case", kOsCase, "--part", part, "--out", session},
                  exit_code)
        .err;
  };
  EXPECT_THAT(make("lid=off", 3), HasSubstr("no station has a part 'lid'"));
  EXPECT_THAT(make("gripper=matched", 3), HasSubstr("cannot be matched"));
  EXPECT_THAT(make("gripper", 2), HasSubstr("is not NAME=STATE"));
  make("gripper=on", 0);
  EXPECT_THAT(runWhs({"info", session}, 0).out,
              HasSubstr("part: gripper: occludes, fixed to CAMERA\n"));
}

TEST_F(WhsEvaluate, ReportsABadCaseAndGoesOn) {
  const std::string file = copyOfExample(folder_);
  std::filesystem::remove(folder_ / "stations/bc/image.png");
  EXPECT_THAT(refusal(evaluateArguments(file, with({"--reseed", "1"}, kQuick))),
              HasSubstr("bc/image.png"));
  const auto results = lines();
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0]["status"], "input_error");
  EXPECT_EQ(results[2]["status"], "iteration_limit");
}

TEST_F(WhsEvaluate, MeshThatChangedUnderItsName_IsNotMixedWithRunsOfTheFormerOne) {
  const std::string file = copyOfExample(folder_);
  const Arguments arguments = evaluateArguments(file, with({"--station", "os"}, kQuick));
  runWhs(arguments, 0);
  EXPECT_THAT(runWhs(arguments, 0).err, HasSubstr("resumed, 1 of 1 runs are done"));
  std::string mesh;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "stations/os"))
    if (entry.path().extension() == ".ply") mesh = entry.path();
  std::filesystem::copy_file(folder_ / "stations/bc/model.ply", mesh,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(
      runWhs(arguments, 3).err,
      HasSubstr("r.sqlite: run of os-000038: the image, mask, mesh, camera, frames, seed or truth "
                "of its case has changed since"));
  EXPECT_THAT(runWhs({"new", "--results", results_, "--out", folder_ / "q.boresight.json"}, 3).err,
              HasSubstr("has changed since"));
}

TEST_F(WhsEvaluate, KilledEvaluation_ContinuesWithoutLossOrRepetition) {
  const Arguments arguments =
      evaluateArguments(dataset_, with({"--reseed", "5", "--jobs", "2"}, kQuick));
  int held = 0;
  for (const int at : {2, 5, 8}) {
    const int after = endWhsAfter(arguments, SIGKILL, results_, at).held;
    EXPECT_GE(after, held) << "nothing that was there is lost";
    held = after;
  }
  ASSERT_GE(held, 1);
  EXPECT_THAT(runWhs(arguments, 0).err,
              HasSubstr("resumed, " + std::to_string(held) + " of 12 runs are done"));
  const sessions::Results results = sessions::readResults(results_);
  ASSERT_EQ(results.runs.size(), 12u);
  std::int64_t done = 0;
  for (const sessions::BatchRun& batch_run : results.facts.batch_runs) done += batch_run.runs;
  EXPECT_EQ(done, 12) << "none was done twice";
  const auto resumed = lines();

  std::filesystem::remove(results_);
  runWhs(arguments, 0);
  const auto undisturbed = lines();
  ASSERT_EQ(resumed.size(), undisturbed.size());
  for (std::size_t i = 0; i < resumed.size(); ++i)
    for (const char* member : {"id", "reseed", "digest"})
      EXPECT_EQ(resumed[i][member], undisturbed[i][member]);
}

TEST_F(WhsEvaluate, Signal_EndsItWithAllThatIsDoneWritten) {
  const Arguments arguments =
      evaluateArguments(dataset_, with({"--reseed", "50", "--jobs", "2"}, kQuick));
  for (const int signal : {SIGTERM, SIGPIPE}) {
    std::filesystem::remove(results_);
    const EndedWhs ended = endWhsAfter(arguments, signal, results_, 2);
    ASSERT_TRUE(WIFEXITED(ended.status)) << signal;
    EXPECT_EQ(WEXITSTATUS(ended.status), 128 + signal);
    EXPECT_GE(ended.held, 2);
    EXPECT_LT(ended.held, 102);
    EXPECT_EQ(lines().size(), static_cast<std::size_t>(ended.held));
    EXPECT_FALSE(std::filesystem::exists(results_ + ".lock"));
  }
}

TEST_F(WhsEvaluate, MergesShards) {
  const Arguments evaluate = with({"evaluate", "--dataset", dataset_}, kQuick);
  Arguments merge = {"merge", folder_ / "merged.sqlite"};
  for (const std::string shard : {"2/2", "1/2"}) {
    merge.push_back(folder_ / ("shard" + shard.substr(0, 1) + ".sqlite"));
    runWhs(with(evaluate, {"--shard", shard, "--out", merge.back()}), 0);
  }
  EXPECT_THAT(runWhs(merge, 0).out, HasSubstr("2 runs"));
  runWhs(evaluateArguments(dataset_, {"--shard", "3/2"}), 2);
}

TEST_F(WhsEvaluate, RefusesWhatItCannotRun) {
  runWhs(evaluateArguments("/no/such/dataset.json", {}), 3);
  runWhs(evaluateArguments(dataset_, {"--case", "bc-999"}), 3);
  runWhs(evaluateArguments(dataset_, {"--jobs", "0"}), 2);
  runWhs(evaluateArguments(dataset_, {"--mirror", "w"}), 2);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(WhsEvaluate, AMatcherThatFailsCostsItsCaseAndNotTheRun) {
  runWhs(evaluateArguments(
             dataset_, {"--station", "os", "--method", "external", "--method", "whs", "--reseed",
                        "1", "--set", kNoSearch, "--matcher", BORESIGHT_TEST_MATCHER " die"}),
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
}

/// Results of the example, evaluated once: converged runs, and runs that end early.
class WhsTables : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    const Arguments evaluate = {"evaluate", "--dataset", exampleDataset(), "--out"};
    runWhs(with(evaluate, {*made_ / "good.sqlite", "--set", kNoSearch}), 0);
    runWhs(with(with(evaluate, {*made_ / "bad.sqlite"}), kQuick), 0);
  }
  static void TearDownTestSuite() { made_.reset(); }
  WhsTables() { std::filesystem::copy(made_->path(), folder_.path()); }

  std::string file(const std::string& name) const { return folder_ / name; }
  /// What `whs tables` prints of the good results.
  std::string tables(const Arguments& more, int exit_code = 0) const {
    return runWhs(with({"tables", file("good.sqlite")}, more), exit_code).out;
  }
  static std::unique_ptr<TemporaryFolder> made_;
  const TemporaryFolder folder_;
};
std::unique_ptr<TemporaryFolder> WhsTables::made_;

TEST_F(WhsTables, MakesTablesAndFigures) {
  EXPECT_THAT(
      tables({"--paper", "--figures", file("figures"), "--figure-format", "pdf", "png", "svg"}),
      AllOf(HasSubstr("Errors per station and method"), HasSubstr("seed"), HasSubstr("whs (paper)"),
            HasSubstr("Time per run and step"), HasSubstr("profile default")));
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "figures"))
    figures += std::filesystem::file_size(entry.path()) > 2000 ? 1 : 0;
  EXPECT_EQ(figures, 15u) << "five figures in three formats";
  EXPECT_EQ(
      tables({"--table", "errors", "--station", "os", "--format", "csv", "--out", file("t.csv")}),
      "");
  EXPECT_THAT(folder_.read("t.csv"),
              AllOf(HasSubstr("normal mm mean,normal mm std"), HasSubstr("os,near,whs,1,1,100,"),
                    HasSubstr("iterations mean,"), Not(HasSubstr("bc"))));
  EXPECT_THAT(tables({"--table", "errors", "--demonstrate", "95"}),
              AllOf(HasSubstr("at least"), HasSubstr("Success rate that the runs demonstrate"),
                    HasSubstr("images missing")));
  folder_.write("counts.json",
                R"({"format": "boresight-instructions", "version": 1, "runs": [{"method": "whs",
                "station": "bc", "case": "bc-1", "initialization": 0, "search": 0, "rendering": 0,
                "matching": 12e9, "pose": 0, "refinement": 0}]})");
  EXPECT_THAT(tables({"--table", "errors", "--paper", "--instructions", file("counts.json")}),
              AllOf(HasSubstr("Minutes at 200 MHz"), HasSubstr("1.000"), HasSubstr("21.330")));
  EXPECT_THAT(tables({"--format", "latex"}), HasSubstr("\\begin{tabular}"));
  EXPECT_THAT(runWhs({"tables", file("good.sqlite"), "--figures", file("t.csv")}, 3).err,
              HasSubstr("t.csv: it is no folder"));
}

TEST_F(WhsTables, FolderThatNothingWasWrittenTo_IsNotLeft) {
  const Arguments figures = {"tables",    file("good.sqlite"), "--figures",
                             file("a/b"), "--failures",        file("c") + "/"};
  EXPECT_EQ(runProgram("trap '' XFSZ; ulimit -f 0; " BORESIGHT_WHS, figures).exit_code, 3);
  EXPECT_EQ(runWhs(with(figures, {"--station", "nosuch"})).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  EXPECT_FALSE(std::filesystem::exists(file("c")));
}

TEST_F(WhsTables, Signal_KeepsTheTablesAndTheSheetsThatAreDrawn) {
  runWhs(with({"evaluate", "--dataset", exampleDataset(), "--station", "os", "--reseed", "30",
               "--out", file("many.sqlite")},
              kQuick),
         0);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(file("t.txt"));
    const EndedWhs ended = endWhsWhen(
        {"tables", file("many.sqlite"), "--out", file("t.txt"), "--failures", file("sheets")},
        signal, [this] { return std::filesystem::exists(file("t.txt")) ? 1 : 0; }, 1);
    ASSERT_TRUE(WIFEXITED(ended.status)) << signal;
    EXPECT_EQ(WEXITSTATUS(ended.status), 128 + signal);
    EXPECT_THAT(folder_.read("t.txt"), HasSubstr("Errors per station"));
  }
}

TEST_F(WhsTables, ComparesTwoResultsRunByRun) {
  EXPECT_THAT(tables({"--against", file("bad.sqlite")}, 6),
              HasSubstr("2 runs in both: 0 better, 2 worse"));
  EXPECT_THAT(tables({"--against", file("good.sqlite")}), HasSubstr("2 the same (2 bit for bit)"));
  EXPECT_THAT(tables({"--against", file("good.sqlite"), "--station", "nosuch"}, 6),
              HasSubstr("0 runs in both"));
  tables({"--against", file("good.sqlite"), "--figures", file("figures")}, 2);
}

TEST_F(WhsTables, AreOfRunsThatASessionRepeatsAndItsQueueLists) {
  EXPECT_THAT(
      runWhs({"new", "--results", file("bad.sqlite"), "--out", file("q.boresight.json")}, 0).out,
      HasSubstr("2 cases"));
  EXPECT_THAT(folder_.read("q.boresight.json"), HasSubstr("loop.max_iterations"));
  EXPECT_THAT(runWhs({"queue", file("q.boresight.json")}).out,
              HasSubstr("not run in this session; in the results: iteration_limit"));
}

TEST_F(WhsTables, WithATriggerAreRefusedByEveryCommand) {
  std::filesystem::copy(file("bad.sqlite"), file("r.sqlite"));
  sessions::SqlDatabase(file("r.sqlite"), sessions::SqlAccess::kWrite)
      .execute("CREATE TRIGGER stop BEFORE INSERT ON run BEGIN SELECT RAISE(IGNORE); END");
  {
    for (const Arguments& arguments :
         {Arguments{"tables", file("r.sqlite")},
          Arguments{"tables", file("bad.sqlite"), "--against", file("r.sqlite")},
          Arguments{"merge", file("m.sqlite"), file("bad.sqlite"), file("r.sqlite")},
          Arguments{"merge", file("r.sqlite"), file("bad.sqlite")},
          Arguments{"new", "--results", file("r.sqlite"), "--out", file("q.boresight.json")},
          with({"evaluate", "--dataset", exampleDataset(), "--out", file("r.sqlite")}, kQuick)}) {
      const ProgramRun run = runWhs(arguments, 3);
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
