// SPDX-License-Identifier: Apache-2.0
// whs queue: the cases of a session by trouble, and what changed since the run before.
#include <gmock/gmock.h>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using ::testing::HasSubstr;

class QueueCommand : public ::testing::Test {
 protected:
  QueueCommand() {
    EXPECT_EQ(
        runWhs({"new", "--dataset", (exampleFolder() / "dataset.json").string(), "--out", session_})
            .exit_code,
        0);
    EXPECT_EQ(runWhs({"run", session_, "--case", "os-000038"}).exit_code, 0);
  }

  TemporaryFolder folder_;
  std::string session_ = (folder_ / "s.boresight.json").string();
};

TEST_F(QueueCommand, ListsWhatWaitsBeforeWhatWasNotRun) {
  const std::string csv = (folder_ / "queue.csv").string();
  const ProgramRun run = runWhs({"queue", session_, "--jobs", "2", "--csv", csv});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::size_t waits = run.out.find("os-000038");
  const std::size_t not_run = run.out.find("bc-");
  ASSERT_NE(waits, std::string::npos) << run.out;
  ASSERT_NE(not_run, std::string::npos) << run.out;
  EXPECT_LT(waits, not_run);
  EXPECT_THAT(run.out, HasSubstr("not run yet"));
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\nos-000038,converged,"));
}

TEST_F(QueueCommand, WritesTextThatLooksLikeAFormulaAsText) {
  std::string session = folder_.read("s.boresight.json");
  for (std::size_t at = session.find("\"os-000038\""); at != std::string::npos;
       at = session.find("\"os-000038\""))
    session.replace(at, 11, R"j("=HYPERLINK(\"x\")")j");
  folder_.write("s.boresight.json", session);
  const std::string csv = (folder_ / "queue.csv").string();
  EXPECT_EQ(runWhs({"queue", session_, "--csv", csv}).exit_code, 0);
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\n\"'=HYPERLINK(\"\"x\"\")\",converged,"));
}

TEST_F(QueueCommand, DifferencesNeedTwoRuns) {
  const ProgramRun run = runWhs({"queue", session_, "--differences"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("os-000038: it has no two runs to compare"));
  EXPECT_THAT(run.out, HasSubstr("0 better, 0 worse, 0 the same"));
}

TEST_F(QueueCommand, SaysWhatIsNoSession) {
  const ProgramRun run = runWhs({"queue", (folder_ / "none.json").string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

}  // namespace
}  // namespace boresight::test
