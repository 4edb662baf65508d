// SPDX-License-Identifier: Apache-2.0
// whs check, decide, export --pose, verify and report: from a run to a pose that is handed over.
#include <filesystem>
#include <memory>
#include <regex>

#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

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

  Arguments deciding(const Arguments& more) const {
    return with({"decide", session_, "--case", kOsCase, "--by", "Ada", "--comment", "right"}, more);
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

/// Whs where no file may be longer than 8 blocks: a journal of an edit is shorter, a session
/// longer.
ProgramRun runWithoutSpace(const Arguments& arguments) {
  return runProgram("trap '' XFSZ; ulimit -f 8; " BORESIGHT_WHS, arguments);
}

TEST_F(ReviewCommands, DecisionThatCannotBeSaved_IsNotLeftToBeRecovered) {
  const std::string journal = sessions::journalFileOf(session_);
  const std::string before = folder_.read("s.boresight.json");
  const ProgramRun failed = runWithoutSpace(deciding({"--reject"}));
  EXPECT_EQ(failed.exit_code, 3) << failed.err;
  EXPECT_THAT(failed.err, HasSubstr("cannot write"));
  EXPECT_EQ(folder_.read("s.boresight.json"), before);
  EXPECT_FALSE(std::filesystem::exists(journal));

  {
    auto document = sessions::SessionDocument::open(session_);
    sessions::Session next = document.session();
    next.view.case_id = kOsCase;
    document.apply(next, "Look at it");
  }
  const std::string left = folder_.read("s.boresight.journal");
  for (const Arguments& command :
       {deciding({"--reject", "--recover"}), Arguments{"run", session_, "--recover"}}) {
    const ProgramRun refused = runWithoutSpace(command);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_THAT(refused.err, Not(HasSubstr("Look at it"))) << command[0];
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(folder_.read("s.boresight.journal"), left) << command[0];
    EXPECT_EQ(folder_.read("s.boresight.json"), before);
  }
  folder_.write("s.boresight.journal", left + "damaged\n");
  EXPECT_THAT(runWhs(deciding({"--reject", "--recover"}), 0).err,
              AllOf(HasSubstr("the damaged journal is kept as " + journal + ".aside-1"),
                    HasSubstr("edit taken from the journal and saved: Look at it\n")));
  EXPECT_FALSE(std::filesystem::exists(journal));
}

TEST_F(ReviewCommands, APoseIsCheckedValidatedHandedOverAndVerified) {
  runWhs({"check", session_, "--case", kOsCase, "--convergence-test", "0"}, 0);
  EXPECT_THAT(runWhs(deciding({"--validate", "--convergence-test", "1"}), 0).out,
              HasSubstr("validated by Ada"));
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
              HasSubstr("WRONG       checksum"));
}

TEST_F(ReviewCommands, Rejection_KeepsTheChecksOfTheRun) {
  runWhs(deciding({"--reject"}), 0);
  EXPECT_FALSE(jsonOf(session_)["decisions"][0]["checks"].empty());
  for (const auto& run : std::filesystem::directory_iterator(sessions::runsFolderOf(session_)))
    std::filesystem::remove(run.path());
  EXPECT_THAT(runWhs(deciding({"--reject"}), 0).err, HasSubstr("rejected without checks: "));
  EXPECT_TRUE(jsonOf(session_)["decisions"][1].value("checks", nlohmann::json::array()).empty());
}

/// The other differences that are found: ValidatedPose.ASessionEditedByHandIsNotSigned and others.
TEST_F(ReviewCommands, PoseThatDiffersFromItsMeasurement_IsNeitherSignedNorReported) {
  runWhs(deciding({"--validate", "--convergence-test", "0"}), 0);
  auto session = jsonOf(session_);
  session["decisions"][0]["pose"]["camera_from_station"]["translation_m"][2] = 0.5;
  folder_.write("s.boresight.json", session.dump());
  for (const Arguments& to : {Arguments{"export", "--pose", folder_ / "pose.json"},
                              Arguments{"report", "--out", folder_ / "pose.pdf"}}) {
    EXPECT_THAT(refusal({to[0], session_, "--case", kOsCase, to[1], to[2]}),
                HasSubstr("the pose differs"));
    EXPECT_FALSE(std::filesystem::exists(to[2]));
  }
}

TEST_F(ReviewCommands, RunOfFormerInputs_IsNotChecked) {
  auto session = jsonOf(session_);
  for (auto& session_case : session["cases"])
    if (session_case["id"] == kOsCase)
      session_case["uncertainty"]["translation_m"] = {0.05, 0.05, 0.05};
  folder_.write("s.boresight.json", session.dump());
  const std::string json = folder_ / "checks.json";
  const ProgramRun run =
      runWhs({"check", session_, "--case", kOsCase, "--convergence-test", "0", "--json", json}, 3);
  EXPECT_THAT(run.err, HasSubstr("the inputs have changed since the last run: run it again"));
  EXPECT_THAT(folder_.read("checks.json"), HasSubstr("\"passed\": false"));
}

TEST_F(ReviewCommands, InvalidDecision_IsRefusedAndChangesNothing) {
  const std::string before = folder_.read("s.boresight.json");
  EXPECT_THAT(refusal(deciding({"--approve"}), 4), HasSubstr("no validation"));
  runWhs(deciding({"--validate", "--reject"}), 2);
  runWhs(deciding({"--validate", "--waive", "x"}), 2);
  runWhs(deciding({"--reject", "--waive", "inlier_count=so"}), 2);
  EXPECT_EQ(folder_.read("s.boresight.json"), before);
}

TEST_F(ReviewCommands, UnvalidatedPose_IsReportedAsSuch) {
  const std::string pdf = folder_ / "report.pdf";
  EXPECT_THAT(runWhs({"report", session_, "--case", kOsCase, "--out", pdf}, 0).out,
              HasSubstr("NOT VALIDATED: converged"));
  EXPECT_EQ(folder_.read("report.pdf").substr(0, 5), "%PDF-");
  EXPECT_THAT(runWhs({"verify", exportPose()}, 6).out, HasSubstr("the pose is NOT VALIDATED"));
  runWhs({"verify", exportPose(), "--allow-not-validated"}, 0);
  EXPECT_THAT(folder_.read("pose.json"), HasSubstr("\"state\": \"NOT VALIDATED\""));
  runWhs({"report", session_, "--out", pdf}, 2);  // of which case?
  refusal({"report", session_, "--case", "bc-000028", "--out", pdf});
}

// whs queue: the cases of a session by trouble, and what changed since the run before.

TEST_F(ReviewCommands, QueueListsWhatWaitsBeforeWhatWasNotRunAndWritesItAsText) {
  const std::string csv = folder_ / "queue.csv";
  const ProgramRun run = runWhs({"queue", session_, "--jobs", "2", "--csv", csv}, 0);
  const std::size_t waits = run.out.find("os-000038");
  const std::size_t not_run = run.out.find("bc-");
  ASSERT_NE(waits, std::string::npos) << run.out;
  ASSERT_NE(not_run, std::string::npos) << run.out;
  EXPECT_LT(waits, not_run);
  EXPECT_THAT(run.out, HasSubstr("not run yet"));
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\nos-000038,converged,"));

  const ProgramRun differences = runWhs({"queue", session_, "--differences"}, 0);
  EXPECT_THAT(differences.err, HasSubstr("os-000038: fewer than two runs to compare"));
  EXPECT_THAT(differences.out, HasSubstr("0 better, 0 worse, 0 the same"));
  refusal({"queue", folder_ / "none.json"});

  // A case whose name looks like a formula.
  const std::regex name("\"os-000038\"");
  folder_.write("s.boresight.json", std::regex_replace(folder_.read("s.boresight.json"), name,
                                                       R"j("=HYPERLINK(\"x\")")j"));
  runWhs({"queue", session_, "--csv", csv}, 0);
  EXPECT_THAT(folder_.read("queue.csv"), HasSubstr("\r\n\"'=HYPERLINK(\"\"x\"\")\",converged,"));
}

}  // namespace
}  // namespace boresight::test
