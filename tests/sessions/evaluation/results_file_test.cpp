// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <limits>
#include <memory>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "sessions/io/files/errors.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

DatasetFacts sampleDataset() { return {"/data/dataset.json", "d1", 3, "1.0"}; }

MethodFacts sampleMethod(const std::string& method) {
  MethodFacts facts;
  facts.method = method;
  facts.profile = "default";
  facts.options = "{\"pnp.seed\":7}";
  facts.options_sha256 = "o1";
  return facts;
}

RunResult sampleRun(const std::string& case_id = "bc-1", std::int64_t dataset_index = 0,
                    std::int32_t reseed = 2, const std::string& method = "whs") {
  RunResult run;
  run.case_id = case_id;
  run.dataset_index = dataset_index;
  run.reseed = reseed;
  run.station = case_id.substr(0, 2);
  run.method = method;
  run.status = "converged";
  run.message = "it's \"quoted\"";
  run.tags = {"far", "low_sun"};
  run.completed = true;
  run.success = true;
  run.matches = 96;
  run.inliers = 88;
  run.edge_support = 0.5;
  run.error.emplace().lateral_mm = 0.25;
  run.requirement.emplace().normal_mm = 0.4;
  run.seconds.matching = 1.5;
  run.digest = "abc";
  run.inputs_sha256 = "i1";
  return run;
}

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
  void write(const std::vector<RunResult>& runs, const std::string& name = "r.sqlite",
             const MethodFacts& method = sampleMethod("whs"),
             const DatasetFacts& dataset = sampleDataset()) const {
    ResultsWriter writer(folder_ / name, dataset);
    writer.admit(method);
    BatchRun batch_run;
    batch_run.machine = name;
    writer.begin(batch_run);
    for (const RunResult& run : runs) writer.add(run);
    writer.end();
  }
  std::string refusal(const MethodFacts& method = sampleMethod("whs"),
                      const DatasetFacts& dataset = sampleDataset()) const {
    return folder_.message([&] {
      ResultsWriter writer(file_, dataset);
      writer.admit(method);
    });
  }
  std::string readRefusal() const {
    return folder_.message([this] { (void)readResults(file_); });
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
  EXPECT_EQ(query(file_,
                  "SELECT value FROM fact WHERE name = 'dataset_sha256'; PRAGMA integrity_check; "
                  "SELECT tag, case_id FROM tag JOIN run ON run.id = run ORDER BY tag"),
            "d1|ok|far|bc-1|low_sun|bc-1|");
  EXPECT_EQ(folder_.fileCount(), 1u) << "neither journal nor lock stays";
}

TEST_F(ResultsFile, HoldsStepsAndWhatBecameOfTemplates) {
  RunResult run = sampleRun();
  run.steps.resize(1);
  run.steps[0].kind = "match";
  run.steps[0].status = "running";
  run.steps[0].rms_px = 0.75;
  run.steps[0].error.emplace().normal_mm = -0.5;
  run.steps.push_back(run.steps[0]);
  run.steps[1].index = 1;
  run.steps[0].details.resize(2);
  run.steps[0].details[1].index = 1;
  run.steps[0].details[1].found_px = {3.5, 4.0};
  run.steps[0].details[1].second_score = std::numeric_limits<double>::quiet_NaN();
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
  write({sampleRun("bc-1", 0, 0, "ncc")}, "r.sqlite", sampleMethod("ncc"));
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
  EXPECT_EQ(writer.inputsOf("whs", "bc-1", 0), "i1");
  EXPECT_FALSE(writer.inputsOf("whs", "bc-1", 1));
  EXPECT_FALSE(writer.inputsOf("ncc", "bc-1", 0));
  writer.add(sampleRun("bc-1", 0, 0));
  writer.add(sampleRun("bc-1", 0, 1));
  EXPECT_EQ(query(file_, "SELECT reseed, batch_run FROM run ORDER BY id"), "0|1|1|2|");
}

TEST_F(ResultsFile, KeepsWhatWasAddedWhenTheWriterIsNeverEnded) {
  ResultsWriter abandoned(file_, sampleDataset());
  abandoned.begin(BatchRun{});
  abandoned.add(sampleRun());
  EXPECT_EQ(readResults(file_).runs.size(), 1u) << "another process sees it at once";
  EXPECT_EQ(readResults(file_).facts.batch_runs.front().ended, "");
}

TEST_F(ResultsFile, TriesRefusedInputsAgain) {
  RunResult bad = sampleRun("bc-1", 0, 0);
  bad.status = "input_error";
  write({bad});
  EXPECT_FALSE(ResultsWriter(file_, sampleDataset()).inputsOf("whs", "bc-1", 0));
  write({sampleRun("bc-1", 0, 0)});
  EXPECT_EQ(query(file_, "SELECT status FROM run; SELECT count(*) FROM tag"), "converged|2|");
}

TEST_F(ResultsFile, OtherDatasetOrOptions_AreRefused) {
  write({sampleRun()});
  const MethodFacts whs = sampleMethod("whs");
  DatasetFacts other = sampleDataset();
  other.dataset_sha256 = "d2";
  EXPECT_THAT(refusal(whs, other), HasSubstr("another dataset"));
  other = sampleDataset();
  other.version = "0.0.9";
  EXPECT_THAT(refusal(whs, other), HasSubstr("version 1.0, not 0.0.9"));
  MethodFacts method = whs;
  method.options_sha256 = "o2";
  method.options = "{\"pnp.seed\":8}";
  EXPECT_EQ(refusal(method),
            "cannot write r.sqlite: its runs of whs have other options: pnp.seed 7, not 8; name "
            "another file");
  method.method = "ncc";
  EXPECT_EQ(refusal(method), "(nothing)") << "a method has its own options";
  method = whs;
  method.reseed_scale = 2.0;
  EXPECT_THAT(refusal(method), HasSubstr("1 times as far, not 2"));
}

TEST_F(ResultsFile, LeavesOtherFilesAndThoseOfAnotherRunAlone) {
  {
    const ResultsWriter writer(file_, sampleDataset());
    EXPECT_THAT(refusal(), HasSubstr("another run is writing"));
  }
  folder_.write("r.sqlite", "something else, long enough to be taken for a database's header");
  EXPECT_THAT(refusal(), HasSubstr("not a results file"));
  EXPECT_THAT(folder_.read("r.sqlite"), HasSubstr("something else"));
  EXPECT_THROW(readResults(file_), InputError);
  EXPECT_THROW(readResults(folder_ / "none.sqlite"), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.sqlite"));
  EXPECT_THROW(ResultsWriter(folder_ / "no/such/r.sqlite", sampleDataset()), OutputError);
}

/// SQLite would take the first for an address, and the second for no file.
TEST(ResultsLock, FileByTwoNames_HasOneLock) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("r.sqlite", folder / "link.sqlite");
  const auto lock = lockResults(folder / "link.sqlite");
  EXPECT_THROW(lockResults(folder / "r.sqlite"), OutputError);
}

TEST_F(ResultsFile, NameWithAColon_IsThatOfAFile) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  for (const char* name : {"file:q.sqlite", ":memory:"}) {
    {
      ResultsWriter writer(name, sampleDataset());
      writer.admit(sampleMethod("whs"));
      writer.begin(BatchRun{});
      writer.add(sampleRun());
      writer.end();
    }
    EXPECT_EQ(readResults(name).runs.size(), 1u) << name;
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
  std::filesystem::current_path(before);
}

TEST_F(ResultsFile, ChangedByAnotherProgram_IsRefusedByReadersAndWriters) {
  const auto change = [this](const char* sql) {
    std::filesystem::remove(file_);
    write({sampleRun()});
    query(file_, sql);
  };
  change("CREATE TRIGGER stop BEFORE INSERT ON run BEGIN SELECT RAISE(IGNORE); END");
  const std::string reason =
      "r.sqlite: its trigger \"stop\" is not from whs evaluate; it was changed by another program: "
      "evaluate again into a new file";
  EXPECT_EQ(readRefusal(), reason);
  EXPECT_EQ(refusal(), "cannot write " + reason);
  // The view is not read: it has no end.
  change(
      "DROP TABLE tag; CREATE VIEW tag AS WITH RECURSIVE n(run) AS (SELECT 1 UNION ALL SELECT "
      "run FROM n) SELECT run, 'a' AS tag FROM n");
  EXPECT_THAT(readRefusal(), HasSubstr("its view \"tag\""));
  EXPECT_THAT(folder_.message([&] { readSteps(file_, {}); }), HasSubstr("view"));
  EXPECT_THAT(folder_.message([&] { forEachRun(file_, [](const RunResult&) {}); }),
              HasSubstr("its view \"tag\""));
  change("ALTER TABLE fact ADD COLUMN more TEXT DEFAULT 'x'");
  EXPECT_THAT(readRefusal(), HasSubstr("table \"fact\""));
  change("DROP INDEX run_order");
  EXPECT_THAT(readRefusal(), HasSubstr("it lacks the index \"run_order\""));
}

/// Makes a results file one of version 5.
void makeVersion5(const std::filesystem::path& file) {
  query(file,
        "ALTER TABLE run DROP COLUMN inputs_sha256; ALTER TABLE iteration DROP COLUMN "
        "projection_px; PRAGMA user_version = 5");
}

TEST_F(ResultsFile, OfTheVersionBefore_IsReadButNotContinued) {
  write({sampleRun()});
  makeVersion5(file_);
  const Results results = readResults(file_);
  ASSERT_EQ(results.runs.size(), 1u);
  EXPECT_EQ(results.runs[0].digest, "abc");
  EXPECT_EQ(results.runs[0].inputs_sha256, "");
  EXPECT_EQ(results.facts.format_version, 5);
  EXPECT_THAT(refusal(), HasSubstr("version 5, which is read but not continued"));
  query(file_, "PRAGMA user_version = 4");
  EXPECT_THAT(readRefusal(), HasSubstr("version 4, this program reads the versions 5 to 6"));
}

/// What readResults throws, or the number of runs, by a user who may read the folder only.
std::string readByAnotherUser(const test::TemporaryFolder& folder,
                              const std::filesystem::path& file) {
  int ends[2] = {};
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    std::string text = "no right to become another user";
    if (::setresuid(kNobody, kNobody, kNobody) == 0) {
      std::size_t runs = 0;
      text = folder.message([&] { runs = readResults(file).runs.size(); });
      if (text == "(nothing)") text = std::to_string(runs) + " runs";
    }
    (void)!::write(ends[1], text.data(), text.size());
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text(512, ' ');
  const ssize_t count = ::read(ends[0], text.data(), text.size());
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

TEST_F(ResultsFile, InAFolderThatCannotBeWritten_IsReadWhereItIsComplete) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs the right to become another user";
  std::filesystem::permissions(folder_.path(), std::filesystem::perms(0555));
  write({sampleRun()});
  EXPECT_EQ(readByAnotherUser(folder_, file_), "1 runs");
  query(file_, "PRAGMA journal_mode = wal");
  std::filesystem::remove(folder_ / "r.sqlite-wal");
  EXPECT_EQ(readByAnotherUser(folder_, file_), "1 runs") << "no changes wait in a log";
  folder_.write("r.sqlite-wal", "changes");
  EXPECT_THAT(readByAnotherUser(folder_, file_),
              HasSubstr("r.sqlite: its last changes are still in r.sqlite-wal, and its folder "
                        "cannot be written"));
}

TEST_F(ResultsFile, OfASequenceThatHasGrown_StatesTheNewCount) {
  write({sampleRun()});
  DatasetFacts grown = sampleDataset();
  grown.cases = 9;
  write({}, "r.sqlite", sampleMethod("whs"), grown);
  EXPECT_EQ(readResultsFacts(file_).dataset.cases, 9);
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
    return mergeResults(folder_ / "out", files).value();
  }
  std::string mergeRefusal(const std::vector<std::string>& names) const {
    return folder_.message([&] { (void)merge(names); });
  }
  /// "case/seed" of every run.
  std::string merged() const {
    std::string text;
    for (const RunResult& run : readResults(folder_ / "out").runs)
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
  write({stepped}, "b");
  write({sampleRun("bc-1", 0, 0), sampleRun("bc-1", 0, 1), sampleRun("bc-3", 2, 0)}, "a");
  const MergeCounts counts = merge({"b", "a"});
  EXPECT_EQ(counts.runs, 4);
  EXPECT_EQ(counts.equal, 0);
  EXPECT_EQ(merged(), "bc-1/0 bc-1/1 os-2/0 bc-3/0 ");
  const Results results = readResults(folder_ / "out");
  EXPECT_EQ(results.runs[2].tags, stepped.tags);
  EXPECT_EQ(results.facts.batch_runs.size(), 2u);
  EXPECT_EQ(query(folder_ / "out",
                  "SELECT machine FROM run JOIN batch_run ON batch_run.id = batch_run "
                  "WHERE case_id = 'bc-3'"),
            "a|");
  EXPECT_EQ(query(folder_ / "out",
                  "SELECT case_id FROM iteration JOIN run ON run.id = run; "
                  "SELECT count(*) FROM match"),
            "os-2|os-2|3|");
}

TEST_F(MergeResults, TakesEqualRunsOnceAndMayBeRepeated) {
  RunResult slower = sampleRun("bc-1", 0, 0);
  slower.seconds.matching = 9.0;
  write({sampleRun("bc-1", 0, 0), sampleRun("bc-1", 0, 1)}, "a");
  write({slower, sampleRun("os-2", 1, 0)}, "b");
  EXPECT_EQ(merge({"a", "b"}).equal, 1);
  EXPECT_EQ(merge({"a", "b"}).equal, 4);
  EXPECT_EQ(merged(), "bc-1/0 bc-1/1 os-2/0 ");
  EXPECT_EQ(readResults(folder_ / "out").facts.batch_runs.size(), 2u);
  EXPECT_EQ(folder_.fileCount(), 3u);
}

/// By their digests, or by their poses where a method has none.
TEST_F(MergeResults, RunsWithDifferentResults_AreRefused) {
  RunResult run = sampleRun("bc-1", 0, 0);
  write({run}, "a");
  run.digest = "abd";
  write({run, sampleRun("os-2", 1, 0)}, "b");
  EXPECT_THAT(mergeRefusal({"a", "b"}),
              HasSubstr("b: run of bc-1: seed 0, method whs has another result"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(folder_.fileCount(), 2u);
  run.digest.clear();
  for (const char* name : {"c", "d"}) write({run}, name);
  EXPECT_EQ(merge({"c", "d"}).equal, 1);
  run.camera_from_station.translation_m.x() += 1e-6;
  write({run}, "e");
  EXPECT_THAT(mergeRefusal({"c", "e"}), HasSubstr("has another result"));
}

TEST_F(MergeResults, RefusesOtherOptionsDatasetsAndFiles) {
  write({sampleRun("bc-1", 0, 0)}, "a");
  MethodFacts method = sampleMethod("whs");
  method.options_sha256 = "o2";
  method.options = "{}";
  write({sampleRun("os-2", 1, 0)}, "b", method);
  EXPECT_EQ(mergeRefusal({"a", "b"}).substr(0, 78),
            "a: its runs of whs have other options: pnp.seed 7, not the profile's, as those");
  DatasetFacts dataset = sampleDataset();
  dataset.dataset_sha256 = "d2";
  write({sampleRun("os-2", 1, 0)}, "c", sampleMethod("whs"), dataset);
  EXPECT_THAT(mergeRefusal({"a", "c"}), HasSubstr("another dataset"));
  folder_.write("d", "no");
  EXPECT_THAT(mergeRefusal({"d"}), HasSubstr("d: "));
  EXPECT_THAT(mergeRefusal({"none"}), HasSubstr("none: there is no such file"));
}

TEST_F(MergeResults, EqualRunsOfOtherInputs_AreRefusedAndUnknownInputsAreNot) {
  write({sampleRun("bc-1", 0, 0)}, "a");
  RunResult other = sampleRun("bc-1", 0, 0);
  other.inputs_sha256 = "i2";
  write({other, sampleRun("os-2", 1, 0)}, "b");
  EXPECT_THAT(mergeRefusal({"a", "b"}), HasSubstr("b: run of bc-1: it has other inputs"));
  makeVersion5(folder_ / "b");
  EXPECT_EQ(merge({"a", "b"}).equal, 1);
  const Results results = readResults(folder_ / "out");
  EXPECT_EQ(results.facts.format_version, kResultsVersion);
  EXPECT_EQ(results.runs[0].inputs_sha256, "i1");
  EXPECT_EQ(results.runs[1].inputs_sha256, "");
}

TEST_F(MergeResults, AfterAStop_OutIsAsItWasAndNothingIsLeft) {
  write({sampleRun("bc-1", 0, 0)}, "a");
  write({sampleRun("os-2", 1, 0)}, "out");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(mergeResults(folder_ / "out", {folder_ / "a"}, stop.get_token()));
  EXPECT_EQ(readResults(folder_ / "out").runs.size(), 1u);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_THAT(entry.path().filename(), testing::AnyOf("a", "a.lock", "out", "out.lock"));
}

TEST_F(MergeResults, FileThatIsBeingWritten_IsRefusedAndKept) {
  write({sampleRun("bc-1", 0, 0)}, "a");
  write({sampleRun("os-2", 1, 0)}, "out");
  const ResultsWriter writer(folder_ / "out", sampleDataset());
  EXPECT_THAT(mergeRefusal({"a"}), HasSubstr("out: another run is writing it"));
  EXPECT_EQ(merged(), "os-2/0 ");
}

TEST_F(MergeResults, PrefersARunToARefusedInput) {
  RunResult bad = sampleRun("bc-1", 0, 0);
  bad.status = "input_error";
  bad.digest.clear();
  write({bad}, "a");
  write({sampleRun("bc-1", 0, 0)}, "b");
  // Nothing of what was merged before is lost.
  for (const std::vector<std::string>& names : {std::vector<std::string>{"a", "b"}, {"a"}}) {
    EXPECT_EQ(merge(names).runs, 1);
    EXPECT_EQ(readResults(folder_ / "out").runs.front().status, "converged");
  }
}

}  // namespace
}  // namespace boresight::sessions
