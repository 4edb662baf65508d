// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_file.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "sessions/io/files/errors.h"
#include "tests/sessions/evaluation/sample_results.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::sampleDataset;
using test::sampleMethod;
using test::sampleRun;

/// The cells of a query, row by row, separated by '|'; NULL as "NULL". By SQLite itself.
std::string query(const std::filesystem::path& file, const char* sql) {
  sqlite3* raw = nullptr;
  EXPECT_EQ(sqlite3_open_v2(file.c_str(), &raw, SQLITE_OPEN_READWRITE, nullptr), SQLITE_OK);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(raw, sqlite3_close);
  std::string text;
  const auto add = [](void* out, int count, char** cells, char**) {
    for (int i = 0; i < count; ++i)
      *static_cast<std::string*>(out) += std::string(cells[i] != nullptr ? cells[i] : "NULL") + "|";
    return 0;
  };
  char* error = nullptr;
  EXPECT_EQ(sqlite3_exec(raw, sql, add, &text, &error), SQLITE_OK) << error;
  sqlite3_free(error);
  return text;
}

class ResultsFile : public testing::Test {
 protected:
  void write(const std::vector<RunResult>& runs, const std::string& method = "whs") const {
    write("r.sqlite", runs, sampleDataset(), sampleMethod(method));
  }
  void write(const std::string& name, const std::vector<RunResult>& runs,
             const DatasetFacts& dataset = sampleDataset(),
             const MethodFacts& method = sampleMethod("whs")) const {
    ResultsWriter writer(folder_ / name, dataset);
    writer.admit(method);
    BatchRun batch_run;
    batch_run.machine = name;
    writer.begin(batch_run);
    for (const RunResult& run : runs) writer.add(run);
    writer.end();
  }
  std::string refusal(const DatasetFacts& dataset, const MethodFacts& method) const {
    return folder_.message([&] {
      ResultsWriter writer(file_, dataset);
      writer.admit(method);
    });
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "r.sqlite";
};

TEST_F(ResultsFile, HoldsEveryRun) {
  RunResult blind;
  blind.case_id = "bc-2";
  blind.dataset_index = 1;
  blind.method = "whs";
  write({sampleRun(), blind});
  EXPECT_EQ(
      query(
          file_,
          "SELECT id, dataset_index, case_id, reseed, station, method, status, message, completed, "
          "success, matches, inliers, edge_support, lateral_mm, projection_px, "
          "requirement, s_matching, s_total, digest FROM run ORDER BY id"),
      "1|0|bc-1|2|bc|whs|converged|it's \"quoted\"|1|1|96|88|0.5|0.25|NULL|"
      "{\"normal_mm\":0.4}|1.5|1.5|abc|"
      "2|1|bc-2|0||whs|||0|NULL|0|0|0.0|NULL|NULL|NULL|0.0|0.0||");
  EXPECT_EQ(query(file_, "SELECT value FROM fact WHERE name = 'dataset_sha256'"), "d1|");
  EXPECT_EQ(query(file_, "SELECT tag, case_id FROM tag JOIN run ON run.id = run ORDER BY tag"),
            "far|bc-1|low_sun|bc-1|");
  EXPECT_EQ(query(file_, "PRAGMA integrity_check"), "ok|");
  EXPECT_EQ(folder_.fileCount(), 1u) << "neither journal nor lock stays";
}

TEST_F(ResultsFile, HoldsStepsAndWhatBecameOfTemplates) {
  RunResult run = sampleRun();
  RunStep step;
  step.kind = "match";
  step.status = "running";
  step.rms_px = 0.75;
  step.error = PoseError{};
  step.error->normal_mm = -0.5;
  step.details.resize(2);
  step.details[1].index = 1;
  step.details[1].found_px = {3.5, 4.0};
  step.details[1].second_score = std::numeric_limits<double>::quiet_NaN();
  run.steps = {step, step};
  run.steps[1].index = 1;
  run.steps[1].details.clear();
  write({run});
  EXPECT_EQ(query(file_, "SELECT run, step, kind, rms_px, normal_mm FROM iteration ORDER BY step"),
            "1|0|match|0.75|-0.5|1|1|match|0.75|-0.5|");
  EXPECT_EQ(query(file_,
                  "SELECT step, template, found_x_px, found_y_px, second_score FROM match "
                  "ORDER BY template"),
            "0|0|NULL|NULL|NULL|0|1|3.5|4.0|NULL|");
}

TEST_F(ResultsFile, ReadsBackWhatWasWritten) {
  RunResult run = sampleRun();
  run.camera_from_station.translation_m = {0.1, -0.2, 0.3};
  run.seed_error = PoseError{.normal_mm = -7.0, .projection_px = 12.0};
  run.probability = 0.875;
  run.evidence_nats = 0.75;
  run.weakest_quadrant_nats = 0.5;
  run.region_nats = -0.25;
  run.evidence_share = 0.625;
  run.expected_nats = 1.25;
  run.competing_poses = 2;
  run.least_margin_nats = -1.5;
  run.image_quality = ImageQuality{.noise_gray = 1.25, .edge_width_px = 3.5};
  const RunResult bare = sampleRun("bc-2", 1);
  write({run, bare});
  const Results results = readResults(file_);
  ASSERT_EQ(results.runs.size(), 2u);
  EXPECT_EQ(toJson(results.runs[0]), toJson(run));
  EXPECT_EQ(toJson(results.runs[1]), toJson(bare));
  EXPECT_EQ(results.runs[0].requirement, run.requirement);
  EXPECT_EQ(results.runs[1].evidence_nats, std::nullopt);
  ASSERT_EQ(results.facts.methods.size(), 1u);
  EXPECT_EQ(results.facts.methods.front().options, "{\"pnp.seed\":7}");
  ASSERT_EQ(results.facts.batch_runs.size(), 1u);
  EXPECT_EQ(results.facts.batch_runs.front().runs, 2);
  EXPECT_NE(results.facts.batch_runs.front().ended, "");
}

TEST_F(ResultsFile, OrdersRunsAsTheDatasetDoesWhateverCameFirst) {
  write({sampleRun("os-1", 5, 0), sampleRun("bc-1", 0, 1), sampleRun("bc-1", 0, 0)});
  write({sampleRun("bc-1", 0, 0, "ncc")}, "ncc");
  std::string order;
  forEachRun(file_, [&order](const RunResult& run) {
    order += run.case_id + "/" + std::to_string(run.reseed) + "/" + run.method + " ";
  });
  EXPECT_EQ(order, "bc-1/0/ncc bc-1/0/whs bc-1/1/whs os-1/0/whs ");
}

TEST_F(ResultsFile, GoesOnWithoutDoingAnythingTwice) {
  write({sampleRun("bc-1", 0, 0)});
  ResultsWriter writer(file_, sampleDataset());
  writer.admit(sampleMethod("whs"));
  writer.begin(BatchRun{});
  EXPECT_TRUE(writer.has("whs", "bc-1", 0));
  EXPECT_FALSE(writer.has("whs", "bc-1", 1));
  EXPECT_FALSE(writer.has("ncc", "bc-1", 0));
  writer.add(sampleRun("bc-1", 0, 0));
  writer.add(sampleRun("bc-1", 0, 1));
  EXPECT_EQ(query(file_, "SELECT reseed, batch_run FROM run ORDER BY id"), "0|1|1|2|");
}

TEST_F(ResultsFile, KeepsWhatWasAddedWhenTheWriterIsNeverEnded) {
  auto* abandoned = new ResultsWriter(file_, sampleDataset());
  abandoned->begin(BatchRun{});
  abandoned->add(sampleRun());
  EXPECT_EQ(readResults(file_).runs.size(), 1u) << "another process sees it at once";
  EXPECT_EQ(readResults(file_).facts.batch_runs.front().ended, "");
  delete abandoned;
}

TEST_F(ResultsFile, TriesRefusedInputsAgain) {
  RunResult bad = sampleRun("bc-1", 0, 0);
  bad.status = "input_error";
  write({bad});
  {
    const ResultsWriter writer(file_, sampleDataset());
    EXPECT_FALSE(writer.has("whs", "bc-1", 0));
  }
  write({sampleRun("bc-1", 0, 0)});
  EXPECT_EQ(query(file_, "SELECT status FROM run"), "converged|");
  EXPECT_EQ(query(file_, "SELECT count(*) FROM tag"), "2|");
}

TEST_F(ResultsFile, OtherDatasetOrOptions_AreRefused) {
  write({sampleRun()});
  DatasetFacts other = sampleDataset();
  other.dataset_sha256 = "d2";
  EXPECT_THAT(refusal(other, sampleMethod("whs")), HasSubstr("another dataset"));
  other = sampleDataset();
  other.version = "0.0.9";
  EXPECT_THAT(refusal(other, sampleMethod("whs")), HasSubstr("version 1.0, not 0.0.9"));
  MethodFacts method = sampleMethod("whs");
  method.options_sha256 = "o2";
  method.options = "{\"pnp.seed\":8}";
  EXPECT_EQ(refusal(sampleDataset(), method),
            "cannot write r.sqlite: its runs of whs have other options: pnp.seed 7, not 8; name "
            "another file");
  method = sampleMethod("whs");
  method.reseed_scale = 2.0;
  EXPECT_THAT(refusal(sampleDataset(), method), HasSubstr("1 times as far, not 2"));
  method = sampleMethod("ncc");
  method.options_sha256 = "o2";
  EXPECT_EQ(refusal(sampleDataset(), method), "(nothing)") << "a method has its own options";
}

TEST_F(ResultsFile, IsWrittenByOneAtATime) {
  const ResultsWriter writer(file_, sampleDataset());
  EXPECT_THAT(refusal(sampleDataset(), sampleMethod("whs")), HasSubstr("another run is writing"));
}

TEST_F(ResultsFile, LeavesOtherFilesAlone) {
  folder_.write("r.sqlite", "something else, long enough to be taken for a database's header");
  EXPECT_THAT(refusal(sampleDataset(), sampleMethod("whs")), HasSubstr("not a results file"));
  EXPECT_THAT(folder_.read("r.sqlite"), HasSubstr("something else"));
  EXPECT_THROW(readResults(file_), InputError);
  EXPECT_THROW(readResults(folder_ / "none.sqlite"), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.sqlite"));
  EXPECT_THROW(ResultsWriter(folder_ / "no/such/r.sqlite", sampleDataset()), OutputError);
}

TEST_F(ResultsFile, WithATriggerIsRefusedByReadersAndWriters) {
  write({sampleRun("bc-1", 0, 0)});
  query(file_, "CREATE TRIGGER stop BEFORE INSERT ON run BEGIN SELECT RAISE(IGNORE); END");
  const std::string reason =
      "r.sqlite: its trigger \"stop\" is not from whs evaluate; it was changed by another program: "
      "evaluate again into a new file";
  EXPECT_EQ(folder_.message([&] { (void)readResults(file_); }), reason);
  EXPECT_EQ(refusal(sampleDataset(), sampleMethod("whs")), "cannot write " + reason);
}

TEST_F(ResultsFile, WithAViewInPlaceOfATableIsRefusedWithoutReadingTheView) {
  write({sampleRun()});
  query(file_,
        "DROP TABLE tag; CREATE VIEW tag AS WITH RECURSIVE n(run) AS (SELECT 1 UNION ALL SELECT "
        "run FROM n) SELECT run, 'a' AS tag FROM n");
  EXPECT_THAT(folder_.message([&] { (void)readResults(file_); }), HasSubstr("its view \"tag\""));
  EXPECT_THAT(folder_.message([&] { (void)StepReader(file_); }), HasSubstr("view"));
  EXPECT_THAT(folder_.message([&] { forEachRun(file_, [](const RunResult&) {}); }),
              HasSubstr("its view \"tag\""));
}

TEST_F(ResultsFile, WithOtherColumnsOrWithoutATableIsRefused) {
  write({sampleRun()});
  query(file_, "ALTER TABLE fact ADD COLUMN more TEXT DEFAULT 'x'");
  EXPECT_THAT(folder_.message([&] { (void)readResults(file_); }), HasSubstr("table \"fact\""));
  query(file_, "ALTER TABLE fact DROP COLUMN more; DROP INDEX run_order");
  EXPECT_THAT(folder_.message([&] { (void)readResults(file_); }),
              HasSubstr("it lacks the index \"run_order\""));
}

TEST_F(ResultsFile, DisablesTriggersAndViewsOfTheConnection) {
  SqlDatabase database(file_, SqlAccess::kWrite);
  database.execute("CREATE TABLE a (x); CREATE VIEW b AS SELECT 1 AS x");
  database.execute("CREATE TRIGGER t AFTER INSERT ON a BEGIN DELETE FROM a; END");
  database.execute("INSERT INTO a VALUES (1)");
  EXPECT_EQ(integerOf(database.value("SELECT count(*) FROM a")), 1);
  EXPECT_THROW(database.value("SELECT x FROM b"), OutputError);
  EXPECT_THROW(database.execute("PRAGMA writable_schema = 1; DELETE FROM sqlite_master"),
               OutputError);
}

class MergeResults : public ResultsFile {
 protected:
  MergeCounts merge(const std::vector<std::string>& names) const {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(folder_ / name);
    return mergeResults(folder_ / "out", files);
  }
  std::string refusal(const std::vector<std::string>& names) const {
    return folder_.message([&] { (void)merge(names); });
  }
  /// "case/seed@machine" of every run.
  std::string merged() const {
    const Results results = readResults(folder_ / "out");
    std::string text;
    for (const RunResult& run : results.runs)
      text += run.case_id + "/" + std::to_string(run.reseed) + " ";
    return text;
  }
};

TEST_F(MergeResults, JoinsShards) {
  RunResult stepped = sampleRun("os-2", 1, 0);
  stepped.steps.resize(2);
  stepped.steps[1].index = 1;
  stepped.steps[0].details.resize(3);
  stepped.steps[0].details[1].index = 1;
  stepped.steps[0].details[2].index = 2;
  write("b", {stepped});
  write("a", {sampleRun("bc-1", 0, 0), sampleRun("bc-1", 0, 1), sampleRun("bc-3", 2, 0)});
  const MergeCounts counts = merge({"b", "a"});
  EXPECT_EQ(counts.runs, 4);
  EXPECT_EQ(counts.equal, 0);
  EXPECT_EQ(merged(), "bc-1/0 bc-1/1 os-2/0 bc-3/0 ");
  const Results results = readResults(folder_ / "out");
  EXPECT_EQ(results.runs[2].tags, stepped.tags);
  ASSERT_EQ(results.facts.batch_runs.size(), 2u);
  SqlDatabase database(folder_ / "out", SqlAccess::kRead);
  EXPECT_EQ(
      textOf(database.value("SELECT machine FROM run JOIN batch_run ON batch_run.id = batch_run "
                            "WHERE case_id = 'bc-3'")),
      "a");
  EXPECT_EQ(integerOf(database.value("SELECT count(*) FROM iteration JOIN run ON run.id = run "
                                     "WHERE case_id = 'os-2'")),
            2);
  EXPECT_EQ(integerOf(database.value("SELECT count(*) FROM match")), 3);
}

TEST_F(MergeResults, TakesEqualRunsOnceAndMayBeRepeated) {
  RunResult slower = sampleRun("bc-1", 0, 0);
  slower.seconds.matching = 9.0;
  write("a", {sampleRun("bc-1", 0, 0), sampleRun("bc-1", 0, 1)});
  write("b", {slower, sampleRun("os-2", 1, 0)});
  EXPECT_EQ(merge({"a", "b"}).equal, 1);
  EXPECT_EQ(merge({"a", "b"}).equal, 4);
  EXPECT_EQ(merged(), "bc-1/0 bc-1/1 os-2/0 ");
  EXPECT_EQ(readResults(folder_ / "out").facts.batch_runs.size(), 2u);
  EXPECT_EQ(folder_.fileCount(), 3u);
}

TEST_F(MergeResults, RunsWithDifferentResults_AreRefused) {
  RunResult other = sampleRun("bc-1", 0, 0);
  other.digest = "abd";
  write("a", {sampleRun("bc-1", 0, 0)});
  write("b", {other, sampleRun("os-2", 1, 0)});
  EXPECT_THAT(refusal({"a", "b"}),
              HasSubstr("b: run of bc-1: seed 0, method whs has another result"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(folder_.fileCount(), 2u);
}

TEST_F(MergeResults, ComparesPosesWhereAMethodHasNoDigest) {
  RunResult run_result = sampleRun("bc-1", 0, 0);
  run_result.digest.clear();
  RunResult other = run_result;
  write("a", {run_result});
  write("b", {other});
  EXPECT_EQ(merge({"a", "b"}).equal, 1);
  other.camera_from_station.translation_m.x() += 1e-6;
  write("c", {other});
  EXPECT_THAT(refusal({"a", "c"}), HasSubstr("has another result"));
}

TEST_F(MergeResults, RefusesOtherOptionsAndDatasets) {
  write("a", {sampleRun("bc-1", 0, 0)});
  MethodFacts method = sampleMethod("whs");
  method.options_sha256 = "o2";
  method.options = "{}";
  write("b", {sampleRun("os-2", 1, 0)}, sampleDataset(), method);
  EXPECT_EQ(refusal({"a", "b"}).substr(0, 78),
            "a: its runs of whs have other options: pnp.seed 7, not the profile's, as those");
  DatasetFacts dataset = sampleDataset();
  dataset.dataset_sha256 = "d2";
  write("c", {sampleRun("os-2", 1, 0)}, dataset);
  EXPECT_THAT(refusal({"a", "c"}), HasSubstr("another dataset"));
}

TEST_F(MergeResults, PrefersARunToARefusedInput) {
  RunResult bad = sampleRun("bc-1", 0, 0);
  bad.status = "input_error";
  bad.digest.clear();
  write("a", {bad});
  write("b", {sampleRun("bc-1", 0, 0)});
  EXPECT_EQ(merge({"a", "b"}).runs, 1);
  EXPECT_EQ(readResults(folder_ / "out").runs.front().status, "converged");
  EXPECT_EQ(merge({"a"}).runs, 1) << "nothing of what was merged before is lost";
  EXPECT_EQ(readResults(folder_ / "out").runs.front().status, "converged");
}

TEST_F(MergeResults, OtherFiles_AreReported) {
  folder_.write("a", "no");
  EXPECT_THAT(refusal({"a"}), HasSubstr("a: "));
  EXPECT_THAT(refusal({"none"}), HasSubstr("none: there is no such file"));
}

}  // namespace
}  // namespace boresight::sessions
