// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/results_writer.h"
#include "sessions/io/errors.h"
#include "tests/sessions/evaluation/sample_results.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::sampleDataset;
using test::sampleMethod;
using test::sampleRun;
using testing::HasSubstr;

class MergeResults : public testing::Test {
 protected:
  void write(const std::string& name, const std::vector<RunResult>& runs,
             const DatasetFacts& dataset = sampleDataset(),
             const MethodFacts& method = sampleMethod("whs")) const {
    ResultsWriter writer(folder_ / name, dataset);
    writer.admit(method);
    Sitting sitting;
    sitting.machine = name;
    writer.begin(sitting);
    for (const RunResult& run : runs) writer.add(run);
    writer.end();
  }
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

  const test::TemporaryFolder folder_;
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
  ASSERT_EQ(results.facts.sittings.size(), 2u);
  SqlDatabase database(folder_ / "out", SqlAccess::kRead);
  EXPECT_EQ(textOf(database.value("SELECT machine FROM run JOIN sitting ON sitting.id = sitting "
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
  EXPECT_EQ(readResults(folder_ / "out").facts.sittings.size(), 2u);
  EXPECT_EQ(folder_.fileCount(), 3u);
}

TEST_F(MergeResults, RefusesRunsThatEndedOtherwise) {
  RunResult other = sampleRun("bc-1", 0, 0);
  other.digest = "abd";
  write("a", {sampleRun("bc-1", 0, 0)});
  write("b", {other, sampleRun("os-2", 1, 0)});
  EXPECT_THAT(refusal({"a", "b"}), HasSubstr("b: run of bc-1: seed 0, method whs ended otherwise"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(folder_.fileCount(), 2u);
}

TEST_F(MergeResults, ComparesPosesWhereAMethodHasNoDigest) {
  RunResult one = sampleRun("bc-1", 0, 0);
  one.digest.clear();
  RunResult other = one;
  write("a", {one});
  write("b", {other});
  EXPECT_EQ(merge({"a", "b"}).equal, 1);
  other.camera_from_station.translation_m.x() += 1e-6;
  write("c", {other});
  EXPECT_THAT(refusal({"a", "c"}), HasSubstr("ended otherwise"));
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

TEST_F(MergeResults, SaysWhatIsNoResultsFile) {
  folder_.write("a", "no");
  EXPECT_THAT(refusal({"a"}), HasSubstr("a: "));
  EXPECT_THAT(refusal({"none"}), HasSubstr("none: there is no such file"));
}

}  // namespace
}  // namespace boresight::sessions
