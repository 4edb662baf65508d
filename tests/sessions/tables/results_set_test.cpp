// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_set.h"

#include <gtest/gtest.h>

#include "sessions/evaluation/results_file.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

class ReadResultsSet : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::vector<RunResult>& runs,
                              const std::string& profile = "default",
                              const std::string& dataset = "d",
                              const std::string& version = "1") const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    ResultsWriter writer(folder_ / name, {"/data/dataset.json", dataset, 2, version});
    MethodFacts facts;
    facts.profile = profile.substr(0, profile.find(' '));
    facts.options_sha256 = profile;
    for (const RunResult& run : runs) {
      facts.method = run.method;
      writer.admit(facts);
    }
    writer.begin(BatchRun{});
    for (const RunResult& run : runs) writer.add(run);
    return folder_ / name;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(ReadResultsSet, TakesFilesTogetherAndFilters) {
  RunResult tagged = madeRun("os-1", "whs");
  tagged.tags = {"real"};
  const auto a = write("a", {madeRun("bc-1", "whs"), madeRun("bc-1", "orb")});
  const auto b = write("b", {tagged, madeRun("bc-1", "mine")});
  EXPECT_EQ(readResultsSet({a, b}).runs.size(), 4u);
  EXPECT_THAT(readResultsSet({a, b}).methodNames(), ElementsAre("orb", "mine", "whs"));
  EXPECT_EQ(readResultsSet({a, b}, {.tags = {"real"}}).runs.size(), 1u);
  EXPECT_EQ(readResultsSet({a, b}, {.stations = {"bc"}, .methods = {"whs"}}).runs.size(), 1u);
}

TEST_F(ReadResultsSet, CountsNoRunTwiceAndNamesVariantsOfAMethodApart) {
  const std::vector<RunResult> run = {madeRun("bc-1", "whs")};
  const auto a = write("a", run);
  const auto b = write("b", run);
  EXPECT_THAT(folder_.message([&] { (void)readResultsSet({a, b}); }), HasSubstr("it is also in"));
  const auto paper = write("paper", run, "paper");
  EXPECT_THAT(readResultsSet({a, paper}).methodNames(), ElementsAre("whs default", "whs paper"));
  const auto c = write("c", run, "default", "e");
  EXPECT_EQ(readResultsSet({a, c}).runs.size(), 2u) << "the case of another dataset is another";
}

TEST_F(ReadResultsSet, VariantsInFilesOfOneName_HaveRowsOfTheirOwn) {
  const std::vector<RunResult> run = {madeRun("bc-1", "whs")};
  const auto a = write("a/res.sqlite", run, "default pnp.seed=7");
  const auto b = write("b/res.sqlite", run, "default max_iterations=3", "e");
  EXPECT_THAT(readResultsSet({a, b}).methodNames(), ElementsAre("whs res", "whs res (2)"));
  const auto older = write("older", run, "default", "d", "0.9.0");
  const auto newer = write("newer", run, "default", "d", "1.0.0");
  const ResultsSet set = readResultsSet({older, newer});
  EXPECT_THAT(set.methodNames(), ElementsAre("whs 0.9.0", "whs 1.0.0"));
  EXPECT_EQ(set.runs.size(), 2u);
}

TEST(MethodBefore, IsThePapersOrder) {
  EXPECT_TRUE(methodBefore("seed", "orb"));
  EXPECT_TRUE(methodBefore("ncc", "loftr-r"));
  EXPECT_TRUE(methodBefore("loftr-s", "another"));
  EXPECT_TRUE(methodBefore("another", "whs"));
  EXPECT_TRUE(methodBefore("zebra", "whs paper"));
  EXPECT_FALSE(methodBefore("whs", "whs"));
}

ResultsSet setOf(std::vector<RunResult> runs) {
  ResultsSet set;
  set.runs = std::move(runs);
  return set;
}

TEST(CompareResults, JudgesRunByRun) {
  ResultsSet before = setOf({madeRun("bc-1", "whs", true, 0.1), madeRun("bc-2", "whs", true, 0.1),
                             madeRun("bc-3", "whs", false), madeRun("bc-4", "whs", false),
                             madeRun("bc-5", "whs", true, 2.0), madeRun("bc-6", "whs")});
  ResultsSet after = setOf({madeRun("bc-1", "whs", true, 0.1), madeRun("bc-2", "whs", true, 0.3),
                            madeRun("bc-3", "whs", true, 0.2), madeRun("bc-4", "whs", true, 5.0),
                            madeRun("bc-5", "whs", true, 1.0), madeRun("bc-7", "whs")});
  for (RunResult& run : after.runs)
    if (run.case_id != "bc-1") run.digest += "'";
  const ResultsDifference made = compareResults(before, after);
  ASSERT_EQ(made.pairs.size(), 5u);
  EXPECT_EQ(made.pairs[0].change, RunChange::kSame) << "bit for bit";
  EXPECT_EQ(made.pairs[1].change, RunChange::kSame) << "both within the requirement";
  EXPECT_EQ(made.pairs[2].change, RunChange::kBetter) << "a right pose where there was none";
  EXPECT_EQ(made.pairs[3].change, RunChange::kWorse) << "a wrong pose is worse than none";
  EXPECT_EQ(made.pairs[4].change, RunChange::kBetter) << "nearer, of two wrong ones";
  EXPECT_EQ(differenceSentence(made),
            "5 runs in both: 2 better, 1 worse, 2 the same (1 bit for bit); 1 only before; 1 only "
            "after.");
  EXPECT_EQ(differenceTable(made, false).rows.size(), 3u);
  EXPECT_EQ(differenceTable(made, true).rows.size(), 5u);
}

TEST(CompareResults, PairsByMethodWhereThereAreSeveral) {
  const ResultsSet whs = setOf({madeRun("bc-1", "whs", true, 0.1)});
  const ResultsSet ncc = setOf({madeRun("bc-1", "ncc", true, 0.1)});
  const ResultsSet both = setOf({whs.runs[0], ncc.runs[0]});
  EXPECT_EQ(compareResults(whs, ncc).pairs.size(), 1u) << "one method against another";
  EXPECT_EQ(compareResults(both, ncc).pairs.size(), 1u);
  EXPECT_EQ(compareResults(both, ncc).only_before, 1);
}

/// A set of one method, as if read from a file of this dataset.
ResultsSet filedSet(std::vector<RunResult> runs, const MethodFacts& method,
                    const std::string& dataset = "d") {
  ResultsSet set = setOf(std::move(runs));
  set.files.push_back({dataset + ".sqlite", {"/data/dataset.json", dataset, 2, "1"}, {method}, {}});
  set.methods["whs"] = method;
  return set;
}

TEST(CompareResults, OtherDatasetsMeshesOrSeeds_AreRefused) {
  const std::vector<RunResult> runs = {madeRun("bc-1", "whs")};
  const ResultsSet before = filedSet(runs, {});
  EXPECT_TRUE(compareResults(before, before).holds());
  const auto refusal = [&before](const ResultsSet& after) {
    return test::TemporaryFolder().message([&] { (void)compareResults(before, after); });
  };
  EXPECT_THAT(refusal(filedSet(runs, {}, "e")), HasSubstr("are of another dataset"));
  MethodFacts mirrored;
  mirrored.mirror = "y";
  EXPECT_THAT(refusal(filedSet(runs, mirrored)),
              HasSubstr("the wrong mesh mirrored across y, those before have the right mesh"));
  MethodFacts others_mesh;
  others_mesh.mesh_of = "os";
  EXPECT_THAT(refusal(filedSet(runs, others_mesh)), HasSubstr("the wrong mesh of os"));
  ResultsSet drawn = filedSet(runs, {});
  drawn.runs[0].reseed = 1;
  ResultsSet farther = drawn;
  farther.methods["whs"].reseed_scale = 2.0;
  EXPECT_THAT(test::TemporaryFolder().message([&] { (void)compareResults(drawn, farther); }),
              HasSubstr("drawn at another distance"));
  EXPECT_THAT(refusal(filedSet({runs[0], runs[0]}, {})), HasSubstr("one dataset at a time"));
}

TEST(CompareResults, PoseFoundWithAWrongMesh_IsWorseThanNoneAndNeverNear) {
  RunResult refused = madeRun("bc-1", "whs", false);
  judge(true, refused);
  RunResult accepted = madeRun("bc-1", "whs", true, 0.05);
  accepted.digest = "other";
  judge(true, accepted);
  const ResultsDifference made = compareResults(setOf({refused}), setOf({accepted}));
  EXPECT_EQ(made.worse, 1);
  EXPECT_EQ(made.pairs[0].why, "failed before, now accepted on a wrong mesh");
  EXPECT_EQ(compareResults(setOf({accepted}), setOf({refused})).better, 1);
  RunResult farther = madeRun("bc-1", "whs", true, 9.0);
  farther.digest = "third";
  judge(true, farther);
  EXPECT_EQ(compareResults(setOf({accepted}), setOf({farther})).same, 1);
}

TEST(CompareResults, HoldOnlyWhenRunsWereComparedAndNoneIsMissing) {
  const RunResult first = madeRun("bc-1", "whs");
  const RunResult second = madeRun("bc-2", "whs");
  EXPECT_TRUE(compareResults(setOf({first}), setOf({first, second})).holds());
  EXPECT_FALSE(compareResults(setOf({first, second}), setOf({first})).holds());
  EXPECT_FALSE(compareResults(setOf({}), setOf({first})).holds());
}

TEST(CompareResults, GoesByCompletionWithoutTruth) {
  ResultsSet before = setOf({madeRun("bc-1", "whs")});
  before.runs[0].error.reset();
  ResultsSet after = before;
  after.runs[0].completed = false;
  after.runs[0].status = "pnp_failed";
  const ResultsDifference made = compareResults(before, after);
  EXPECT_EQ(made.worse, 1);
  EXPECT_EQ(made.pairs[0].why, "converged before, now pnp_failed");
}

}  // namespace
}  // namespace boresight::sessions
