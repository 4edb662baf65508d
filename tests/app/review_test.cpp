// SPDX-License-Identifier: Apache-2.0
// whs check, decide, export --pose, verify and report: from a run to a pose that is handed over.
#include <memory>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ReviewCommands : public ::testing::Test {
 protected:
  /// A session of which one case was run, made once; each test has a copy of its files.
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    runWhs({"run", newSession(*made_, true), "--case", kOsCase}, 0);
  }
  static void TearDownTestSuite() { made_.reset(); }

  ReviewCommands() {
    std::filesystem::copy(made_->path(), folder_.path(), std::filesystem::copy_options::recursive);
  }

  ProgramRun decide(const Arguments& more) const {
    Arguments arguments = {"decide", session_, "--case", kOsCase};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runWhs(arguments);
  }

  std::string exportPose() const {
    const std::string file = folder_ / "pose.json";
    runWhs({"export", session_, "--case", kOsCase, "--pose", file}, 0);
    return file;
  }

  static std::unique_ptr<TemporaryFolder> made_;
  const TemporaryFolder folder_;
  const std::string session_ = folder_ / "s.boresight.json";
};
std::unique_ptr<TemporaryFolder> ReviewCommands::made_;

TEST_F(ReviewCommands, APoseIsCheckedValidatedHandedOverAndVerified) {
  runWhs({"check", session_, "--case", kOsCase, "--convergence-test", "0"}, 0);
  const ProgramRun decided =
      decide({"--validate", "--by", "Ada", "--comment", "right", "--convergence-test", "1"});
  EXPECT_EQ(decided.exit_code, 0) << decided.err;
  EXPECT_THAT(decided.out, HasSubstr("validated by Ada"));
  const std::string file = exportPose();
  EXPECT_THAT(runWhs({"verify", file}, 0).out,
              AllOf(HasSubstr("the run gives the same digest"), HasSubstr("not proved  who: Ada"),
                    HasSubstr("not proved  convergence test: its 1 further seeds"),
                    HasSubstr("stated: validated by Ada")));
  EXPECT_THAT(runWhs({"verify", file, "--full"}).out, Not(HasSubstr("convergence test")));
  runWhs({"verify", file, "--full", "--no-run"}, 2);

  std::string text = folder_.read("pose.json");
  text.replace(text.find("\"comment\": \"right\""), 18, "\"comment\": \"wrong\"");
  folder_.write("tampered.json", text);
  EXPECT_THAT(runWhs({"verify", folder_ / "tampered.json", "--no-run"}, 6).out,
              HasSubstr("WRONG       signature"));
}

/// The other differences that are found: ValidatedPose.ASessionEditedByHandIsNotSigned and others.
TEST_F(ReviewCommands, PoseThatDiffersFromItsMeasurement_IsNeitherSignedNorReported) {
  EXPECT_EQ(decide({"--validate", "--by", "Ada", "--comment", "right", "--convergence-test", "0"})
                .exit_code,
            0);
  nlohmann::json session = nlohmann::json::parse(folder_.read("s.boresight.json"));
  session["decisions"][0]["pose"]["camera_from_station"]["translation_m"][2] = 0.5;
  folder_.write("s.boresight.json", session.dump());
  for (const Arguments& to : {Arguments{"export", "--pose", folder_ / "pose.json"},
                              Arguments{"report", "--out", folder_ / "pose.pdf"}}) {
    const ProgramRun run = runWhs({to[0], session_, "--case", kOsCase, to[1], to[2]}, 3);
    EXPECT_EQ(run.errorLines(), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("the pose differs"));
    EXPECT_FALSE(std::filesystem::exists(to[2]));
  }
}

TEST_F(ReviewCommands, InvalidDecision_IsRefusedAndChangesNothing) {
  const std::string before = folder_.read("s.boresight.json");
  const ProgramRun approval = decide({"--approve", "--by", "Ada", "--comment", "yes"});
  EXPECT_EQ(approval.exit_code, 4);
  EXPECT_EQ(approval.errorLines(), 1) << approval.err;
  EXPECT_THAT(approval.err, HasSubstr("no validation"));
  const ProgramRun unknown = decide({"--validate", "--by", "Ada", "--comment", "yes", "--waive",
                                     "nothing=because", "--convergence-test", "0"});
  EXPECT_EQ(unknown.exit_code, 4);
  EXPECT_THAT(unknown.err, HasSubstr("no check 'nothing'"));
  EXPECT_EQ(decide({"--validate", "--reject", "--by", "A", "--comment", "b"}).exit_code, 2);
  EXPECT_EQ(decide({"--validate", "--by", "A", "--comment", "b", "--waive", "x"}).exit_code, 2);
  EXPECT_EQ(folder_.read("s.boresight.json"), before);
}

TEST_F(ReviewCommands, UnvalidatedPose_IsReportedAsSuch) {
  const std::string pdf = folder_ / "report.pdf";
  const ProgramRun report = runWhs({"report", session_, "--case", kOsCase, "--out", pdf}, 0);
  EXPECT_THAT(report.out, HasSubstr("NOT VALIDATED: converged"));
  EXPECT_EQ(folder_.read("report.pdf").substr(0, 5), "%PDF-");
  runWhs({"verify", exportPose()}, 0);
  EXPECT_THAT(folder_.read("pose.json"), HasSubstr("\"state\": \"NOT VALIDATED\""));
  EXPECT_EQ(runWhs({"report", session_, "--out", pdf}).exit_code, 2) << "which case?";
  const ProgramRun none = runWhs({"report", session_, "--case", "bc-000028", "--out", pdf}, 3);
  EXPECT_EQ(none.errorLines(), 1) << none.err;
}

// whs queue: the cases of a session by trouble, and what changed since the run before.

TEST_F(ReviewCommands, TheQueueListsWhatWaitsBeforeWhatWasNotRun) {
  const std::string csv = folder_ / "queue.csv";
  const ProgramRun run = runWhs({"queue", session_, "--jobs", "2", "--csv", csv}, 0);
  const std::size_t waits = run.out.find("os-000038");
  const std::size_t not_run = run.out.find("bc-");
  ASSERT_NE(waits, std::string::npos) << run.out;
  ASSERT_NE(not_run, std::string::npos) << run.out;
  EXPECT_LT(waits, not_run);
  EXPECT_THAT(run.out, HasSubstr("not run yet"));
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\nos-000038,converged,"));
}

TEST_F(ReviewCommands, TheQueueWritesTextThatLooksLikeAFormulaAsText) {
  std::string session = folder_.read("s.boresight.json");
  for (std::size_t at = session.find("\"os-000038\""); at != std::string::npos;
       at = session.find("\"os-000038\""))
    session.replace(at, 11, R"j("=HYPERLINK(\"x\")")j");
  folder_.write("s.boresight.json", session);
  const std::string csv = folder_ / "queue.csv";
  runWhs({"queue", session_, "--csv", csv}, 0);
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\n\"'=HYPERLINK(\"\"x\"\")\",converged,"));
}

TEST_F(ReviewCommands, DifferencesInTheQueueNeedTwoRuns) {
  const ProgramRun run = runWhs({"queue", session_, "--differences"}, 0);
  EXPECT_THAT(run.err, HasSubstr("os-000038: fewer than two runs to compare"));
  EXPECT_THAT(run.out, HasSubstr("0 better, 0 worse, 0 the same"));
}

TEST_F(ReviewCommands, Queue_OfAnotherFile_IsRefused) {
  const ProgramRun run = runWhs({"queue", folder_ / "none.json"}, 3);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

}  // namespace
}  // namespace boresight::test
