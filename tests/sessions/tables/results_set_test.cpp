// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/evaluation/results_writer.h"
#include "sessions/io/errors.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::madeRun;
using testing::ElementsAre;
using testing::HasSubstr;

class ReadResultsSet : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::vector<RunResult>& runs,
                              const std::string& profile = "default",
                              const std::string& dataset = "d") const {
    ResultsWriter writer(folder_ / name, {"/data/dataset.json", dataset, 2, "1"});
    MethodFacts facts;
    facts.profile = profile;
    facts.options_sha256 = profile;
    for (const RunResult& run : runs) {
      facts.method = run.method;
      writer.admit(facts);
    }
    writer.begin(Sitting{});
    for (const RunResult& run : runs) writer.add(run);
    return folder_ / name;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(ReadResultsSet, TakesFilesTogetherAndFilters) {
  RunResult tagged = madeRun("os-1", "whs", true, 0.0, 0.0, 0.0);
  tagged.tags = {"real"};
  const auto a = write("a", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0),
                             madeRun("bc-1", "orb", true, 0.0, 0.0, 0.0)});
  const auto b = write("b", {tagged, madeRun("bc-1", "mine", true, 0.0, 0.0, 0.0)});
  EXPECT_EQ(readResultsSet({a, b}).runs.size(), 4u);
  EXPECT_THAT(readResultsSet({a, b}).methodNames(), ElementsAre("orb", "mine", "whs"));
  EXPECT_EQ(readResultsSet({a, b}, {.tags = {"real"}}).runs.size(), 1u);
  EXPECT_EQ(readResultsSet({a, b}, {.stations = {"bc"}, .methods = {"whs"}}).runs.size(), 1u);
}

TEST_F(ReadResultsSet, NamesVariantsOfAMethodApart) {
  const auto a = write("a", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)});
  const auto b = write("b", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)}, "paper");
  EXPECT_THAT(readResultsSet({a, b}).methodNames(), ElementsAre("whs default", "whs paper"));
}

TEST_F(ReadResultsSet, CountsNoRunTwice) {
  const auto a = write("a", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)});
  const auto b = write("b", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)});
  EXPECT_THAT(folder_.message([&] { (void)readResultsSet({a, b}); }), HasSubstr("it is also in"));
  const auto c = write("c", {madeRun("bc-1", "whs", true, 0.0, 0.0, 0.0)}, "default", "e");
  EXPECT_EQ(readResultsSet({a, c}).runs.size(), 2u) << "the case of another dataset is another";
}

TEST(MethodBefore, IsThePapersOrder) {
  EXPECT_TRUE(methodBefore("seed", "orb"));
  EXPECT_TRUE(methodBefore("ncc", "loftr-r"));
  EXPECT_TRUE(methodBefore("loftr-s", "another"));
  EXPECT_TRUE(methodBefore("another", "whs"));
  EXPECT_TRUE(methodBefore("zebra", "whs paper"));
  EXPECT_FALSE(methodBefore("whs", "whs"));
}

}  // namespace
}  // namespace boresight::sessions
