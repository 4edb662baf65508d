// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/evaluation/sqlite.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Results of the example, quick and good.
class WhsTables : public testing::Test {
 protected:
  void evaluate(const std::string& name, const std::string& iterations) const {
    const ProgramRun run =
        runWhs({"evaluate", "--dataset", (exampleFolder() / "dataset.json").string(), "--out",
                (folder_ / name).string(), "--set", "loop.max_iterations=" + iterations});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  const TemporaryFolder folder_;
};

TEST_F(WhsTables, MakesTablesAndFigures) {
  evaluate("r.sqlite", "10");
  const ProgramRun text = runWhs({"tables", file("r.sqlite"), "--paper", "--figures",
                                  file("figures"), "--figure-format", "pdf", "png", "svg"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("Errors per station and method"), HasSubstr("seed"),
                              HasSubstr("whs (paper)"), HasSubstr("Time per run and step"),
                              HasSubstr("profile default")));
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "figures"))
    figures += std::filesystem::file_size(entry.path()) > 2000 ? 1 : 0;
  EXPECT_EQ(figures, 12u) << "four figures in three formats";
  const ProgramRun csv = runWhs({"tables", file("r.sqlite"), "--table", "errors", "--station", "os",
                                 "--format", "csv", "--out", file("t.csv")});
  EXPECT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_EQ(csv.out, "");
  EXPECT_THAT(folder_.read("t.csv"),
              AllOf(HasSubstr("normal mm mean,normal mm std"),
                    HasSubstr("os,near,whs,1,100,100,0,"), Not(HasSubstr("bc"))));
  EXPECT_THAT(runWhs({"tables", file("r.sqlite"), "--format", "latex"}).out,
              HasSubstr("\\begin{tabular}"));
}

TEST_F(WhsTables, ComparesTwoResultsRunByRun) {
  evaluate("good.sqlite", "10");
  evaluate("bad.sqlite", "1");
  const ProgramRun worse = runWhs({"tables", file("good.sqlite"), "--against", file("bad.sqlite")});
  EXPECT_EQ(worse.exit_code, 6) << worse.err;
  EXPECT_THAT(worse.out, HasSubstr("2 runs in both: 0 better, 2 worse"));
  const ProgramRun same = runWhs({"tables", file("good.sqlite"), "--against", file("good.sqlite")});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_THAT(same.out, HasSubstr("2 the same (2 bit for bit)"));
}

TEST_F(WhsTables, AreOfRunsThatASessionRepeatsAndItsQueueLists) {
  evaluate("r.sqlite", "1");
  const ProgramRun made =
      runWhs({"new", "--results", file("r.sqlite"), "--out", file("q.boresight.json")});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("2 cases"));
  EXPECT_THAT(folder_.read("q.boresight.json"), HasSubstr("loop.max_iterations"));
  EXPECT_THAT(runWhs({"queue", file("q.boresight.json")}).out,
              HasSubstr("not run here; in the results: iteration_limit"));
}

TEST_F(WhsTables, WithATriggerOrAViewAreRefusedByEveryCommand) {
  const std::string dataset = (exampleFolder() / "dataset.json").string();
  for (const char* object :
       {"CREATE TRIGGER stop BEFORE INSERT ON run BEGIN SELECT RAISE(IGNORE); END",
        "DROP TABLE tag; CREATE VIEW tag AS WITH RECURSIVE n(run) AS (SELECT 1 UNION ALL SELECT "
        "run FROM n) SELECT run, 'a' AS tag FROM n"}) {
    evaluate("good.sqlite", "1");
    std::filesystem::copy(file("good.sqlite"), file("r.sqlite"),
                          std::filesystem::copy_options::overwrite_existing);
    sessions::SqlDatabase(file("r.sqlite"), sessions::SqlAccess::kWrite).execute(object);
    for (const Arguments& arguments :
         {Arguments{"tables", file("r.sqlite")},
          Arguments{"tables", file("good.sqlite"), "--against", file("r.sqlite")},
          Arguments{"merge", file("m.sqlite"), file("good.sqlite"), file("r.sqlite")},
          Arguments{"merge", file("r.sqlite"), file("good.sqlite")},
          Arguments{"new", "--results", file("r.sqlite"), "--out", file("q.boresight.json")},
          Arguments{"evaluate", "--dataset", dataset, "--out", file("r.sqlite"), "--set",
                    "loop.max_iterations=1"}}) {
      const ProgramRun run = runWhs(arguments);
      EXPECT_EQ(run.exit_code, 3) << arguments[0] << run.out;
      EXPECT_EQ(run.errorLines(), 1) << run.err;
      EXPECT_THAT(run.err, AllOf(HasSubstr("r.sqlite: its "), HasSubstr("is not one that whs "
                                                                        "evaluate makes")));
      EXPECT_EQ(run.out, "");
    }
    EXPECT_FALSE(std::filesystem::exists(file("m.sqlite")));
  }
}

TEST_F(WhsTables, RefusesWhatIsNoResults) {
  folder_.write("no.sqlite", "no");
  EXPECT_EQ(runWhs({"tables", file("no.sqlite")}).exit_code, 3);
  EXPECT_EQ(runWhs({"tables", file("none.sqlite")}).exit_code, 3);
  EXPECT_EQ(runWhs({"tables"}).exit_code, 2);
  EXPECT_EQ(runWhs({"tables", file("no.sqlite"), "--format", "word"}).exit_code, 2);
}

}  // namespace
}  // namespace boresight::test
