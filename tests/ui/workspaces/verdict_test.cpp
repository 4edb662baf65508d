// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/verdict.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"
#include "tests/ui/window_test.h"
#include "ui/style/theme.h"
#include "ui/workspaces/remedies.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

Situation ready() {
  Situation situation;
  situation.has_case = true;
  situation.run = RunState::kReady;
  return situation;
}

/// Three sigma of this size, where 0.4 mm are required.
sessions::PoseQuality knownTo(double found_mm) {
  sessions::PoseQuality quality;
  quality.figures = {{{"covariance_lateral", "Covariance"},
                      "across the view axis",
                      "mm",
                      0.4,
                      found_mm,
                      found_mm,
                      " at the end effector"}};
  return quality;
}

std::shared_ptr<sessions::LocalizationTrace> ended(LocalizationStatus status) {
  auto trace = std::make_shared<sessions::LocalizationTrace>(*test::exampleRun());
  trace->status = status;
  return trace;
}

/// Converged, and known to 0.1 mm.
Situation converged() {
  Situation situation = ready();
  situation.run = RunState::kFinished;
  situation.trace = ended(LocalizationStatus::kConverged);
  situation.quality = knownTo(0.1);
  return situation;
}

Situation annotating() {
  Situation situation = ready();
  situation.workspace = Workspace::kAnnotate;
  return situation;
}

TEST(Verdict, FilesMissing_NamesThem) {
  Situation situation;
  situation.files = {2, QStringLiteral("Still needed: a camera (json) and a seed pose (json).")};
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("2 of 4 files added"));
  EXPECT_TRUE(test::has(verdict.sentence, "Still needed: a camera"));
  EXPECT_EQ(verdict.step, Step::kChooseFiles);
}

TEST(Verdict, CaseThatIsBeingRead_IsNamed) {
  Situation situation;
  situation.reading = QStringLiteral("bc-000041");
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Opening bc-000041."));
  EXPECT_EQ(verdictOf(situation).step, Step::kNone);
  Situation its_run = ready();
  its_run.reading = situation.reading;
  EXPECT_EQ(verdictOf(its_run).head, QStringLiteral("Opening bc-000041.")) << "not ready to run";
}

TEST(Verdict, ReadyCase_OffersRun) {
  const Verdict verdict = verdictOf(ready());
  EXPECT_EQ(verdict.head, QStringLiteral("Ready to run."));
  EXPECT_EQ(verdict.step, Step::kRun);
  EXPECT_EQ(verdict.tone, VerdictTone::kPlain);
}

TEST(Verdict, CaseWithoutSeed_LeadsToAnnotation) {
  Situation situation = ready();
  situation.has_seed = false;
  EXPECT_EQ(verdictOf(situation).step, Step::kAnnotate);
  situation.annotation.has_pose = true;
  EXPECT_EQ(verdictOf(situation).step, Step::kSeedFromAnnotation);
}

TEST(Verdict, RunUnderWay_TellsTheStageAndStops) {
  Situation situation = ready();
  situation.run = RunState::kWorking;
  auto trace = ended(LocalizationStatus::kRunning);
  trace->finished = false;
  trace->last_under_way = true;
  trace->iterations.resize(1);
  auto iteration = std::make_shared<sessions::IterationTrace>(*trace->iterations.front());
  iteration->reached = Stage::kRender;
  iteration->kind = IterationKind::kMatch;
  trace->iterations.front() = iteration;
  situation.trace = trace;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("Iteration 1: rendering done; next, templates."));
  EXPECT_EQ(verdict.step, Step::kStop);
  EXPECT_TRUE(verdict.plain);
}

TEST(Verdict, PoseBeyondTheRequirement_IsNoSuccess) {
  Situation situation = ready();
  situation.run = RunState::kFinished;
  situation.trace = ended(LocalizationStatus::kConverged);
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kPlain) << "not measured yet";
  situation.quality = knownTo(0.3676);
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kGood);
  EXPECT_TRUE(test::has(
      verdictOf(situation).sentence,
      "Pose known to 0.37 of 0.40 mm (3 sigma across the view axis at the end effector)."));
  situation.quality = knownTo(1.22);
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kCaution);
  EXPECT_TRUE(test::has(verdictOf(situation).sentence, "1.22 of 0.40 mm"));
  situation.quality = sessions::PoseQuality();
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kCaution) << "nothing is known";
}

TEST(Verdict, FailedCheck_IsNoSuccessInAnyWorkspace) {
  Situation situation = converged();
  situation.review.current = true;
  situation.review.tested = true;
  situation.review.failed = 2;
  for (const Workspace workspace : {Workspace::kRun, Workspace::kReview}) {
    situation.workspace = workspace;
    EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kCaution);
    EXPECT_TRUE(test::has(verdictOf(situation).sentence, "2 checks failed"));
  }
}

TEST(Verdict, ValidationOfAnOutdatedRun_IsShownAsOutdatedInRunAndReview) {
  Situation situation = converged();
  situation.review.state = sessions::ReviewState::kValidated;
  situation.review.decision = QStringLiteral("by A. Operator, 09:02 UTC.");
  for (const Workspace workspace : {Workspace::kRun, Workspace::kReview}) {
    situation.workspace = workspace;
    situation.review.outdated.clear();
    situation.stale.clear();
    EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kGood);
    EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Validated"));
    EXPECT_EQ(verdictOf(situation).step, Step::kExportPose);
    EXPECT_EQ(verdictOf(situation).others.front(), Step::kReport);
    situation.review.outdated = QStringLiteral("the run was made with other options");
    situation.stale = QStringLiteral("The run was made with other options.");
    const Verdict verdict = verdictOf(situation);
    EXPECT_EQ(verdict.tone, VerdictTone::kCaution);
    EXPECT_EQ(verdict.head, QStringLiteral("Validated; outdated"));
    EXPECT_TRUE(test::has(verdict.sentence, "Outdated: the run was made with other options."));
    EXPECT_EQ(verdict.step, Step::kRunAgain);
    EXPECT_EQ(verdict.others.front(), Step::kExportPose);
  }
}

TEST(Verdict, ValidationWithAWaivedCheck_IsCaution) {
  Situation situation = converged();
  situation.review.state = sessions::ReviewState::kValidated;
  situation.review.decision = QStringLiteral("by A. Operator, 09:02 UTC.");
  situation.review.failed = 1;
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kCaution);
  EXPECT_TRUE(test::has(verdictOf(situation).sentence, "1 check failed, waived."));
}

TEST(Verdict, ValidationByOnePersonOfTwo_IsToBeApproved) {
  Situation situation = converged();
  situation.review.state = sessions::ReviewState::kConverged;
  situation.review.decision =
      QStringLiteral("by A. Operator, 09:02 UTC. A second person must approve.");
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("To be approved"));
  EXPECT_EQ(verdict.tone, VerdictTone::kCaution);
  EXPECT_EQ(verdict.step, Step::kReview);
}

TEST(Verdict, RunUnderWayOfAValidatedCase_IsTheRun) {
  Situation situation = ready();
  situation.review.state = sessions::ReviewState::kValidated;
  situation.review.decision = QStringLiteral("by A. Operator, 09:02 UTC.");
  situation.trace = ended(LocalizationStatus::kConverged);
  situation.in_batch = true;
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Running."));
  situation.in_batch = false;
  situation.trace.reset();
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Ready to run.")) << "it was dropped";
}

TEST(Verdict, AnnotationsThatAreTooCoarse_AreNoSuccess) {
  Situation situation = annotating();
  situation.annotation.pairs = 7;
  situation.annotation.has_pose = true;
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kGood);
  situation.annotation.concern = QStringLiteral("The residuals are 16.0 times the stated sigmas.");
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.tone, VerdictTone::kCaution);
  EXPECT_TRUE(test::has(verdict.sentence, "16.0 times the stated sigmas"));
}

/// One that stands out is switched off; several hide each other, and are weighed.
TEST(Verdict, SuspectedAnnotations_AreNamedAndRobustIsProposed) {
  Situation situation = annotating();
  situation.annotation.has_pose = true;
  situation.annotation.bad_pair = QStringLiteral("p2");
  situation.annotation.bad_sigmas = 3.2;
  EXPECT_EQ(verdictOf(situation).step, Step::kDisablePair);
  situation.annotation.concern = QStringLiteral("The residuals are 16.0 times the stated sigmas.");
  for (const char* id : {"p2", "p5", "p7", "p8", "p9"})
    situation.annotation.suspects << QString::fromLatin1(id);
  Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.step, Step::kRobust);
  EXPECT_TRUE(test::has(verdict.sentence, "Suspected: p2, p5, p7 and 2 others."));
  situation.annotation.robust = true;
  situation.annotation.concern.clear();
  verdict = verdictOf(situation);
  EXPECT_EQ(verdict.tone, VerdictTone::kGood) << "the others fit";
  EXPECT_TRUE(test::has(verdict.sentence, "Little weight: p2, p5, p7 and 2 others"));
  EXPECT_EQ(verdict.step, Step::kSeedFromAnnotation);
}

TEST(Verdict, BlindRound_HasNoFiguresOfAPose) {
  Situation situation = annotating();
  situation.annotation.pairs = 3;
  situation.annotation.blind = true;
  situation.annotation.unplaced = 4;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Blind round: 3 pairs"));
  EXPECT_TRUE(test::has(verdict.sentence, "Place or remove the 4 that are left"));
  EXPECT_EQ(verdict.tone, VerdictTone::kPlain);
  EXPECT_EQ(verdict.step, Step::kNone);
}

TEST(Verdict, HaltedRun_GoesOn) {
  Situation situation = ready();
  situation.run = RunState::kHalted;
  auto trace = ended(LocalizationStatus::kRunning);
  trace->finished = false;
  trace->iterations.resize(1);
  situation.trace = trace;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Paused after iteration 1."));
  EXPECT_EQ(verdict.step, Step::kGoOn);
}

TEST(Verdict, ConvergedRun_IsGoodAndNotYetValidated) {
  Situation situation = converged();
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.tone, VerdictTone::kGood);
  EXPECT_EQ(verdict.head, QStringLiteral("Converged"));
  EXPECT_TRUE(test::has(verdict.sentence, "Not yet validated."));
  EXPECT_EQ(verdict.step, Step::kReview);
}

TEST(Verdict, StaleRun_IsRunAgain) {
  Situation situation = ready();
  situation.trace = ended(LocalizationStatus::kConverged);
  situation.stale = QStringLiteral("The run was made with other options.");
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Converged; outdated."));
  EXPECT_EQ(verdict.step, Step::kRunAgain);
  EXPECT_EQ(verdict.tone, VerdictTone::kCaution);
}

/// A failed run was taken for a success: the state was only in small print.
TEST(Verdict, EveryFailure_IsBadAndLeadsOn) {
  for (int i = 0; i <= static_cast<int>(LocalizationStatus::kFault); ++i) {
    const auto status = static_cast<LocalizationStatus>(i);
    if (status == LocalizationStatus::kConverged || status == LocalizationStatus::kRunning)
      continue;
    Situation situation = ready();
    situation.run = RunState::kFinished;
    situation.trace = ended(status);
    const Verdict verdict = verdictOf(situation);
    const std::string name = localizationStatusText(status);
    EXPECT_EQ(verdict.tone, VerdictTone::kBad) << name;
    EXPECT_FALSE(verdict.sentence.isEmpty()) << name;
    EXPECT_NE(verdict.step, Step::kNone) << name;
    EXPECT_FALSE(verdict.others.empty()) << name;
    EXPECT_EQ(remediesFor(*situation.trace).front().step, verdict.step) << name;
  }
}

TEST(Verdict, NotSupportedPose_IsRejectedAndOffersAWiderSearch) {
  Situation situation = ready();
  situation.trace = ended(LocalizationStatus::kNotSupported);
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Rejected"));
  EXPECT_TRUE(test::has(verdict.sentence, "needed"));
  EXPECT_TRUE(test::has(verdict.sentence, "seed may be turned"));
  EXPECT_EQ(verdict.step, Step::kWiderSearch);
  EXPECT_EQ(verdict.others.front(), Step::kNudgeSeed);
}

TEST(Verdict, Review_TellsOpenChecksThenTheTestThenTheDecision) {
  Situation situation = converged();
  situation.workspace = Workspace::kReview;
  situation.review.current = true;
  situation.review.failed = 1;
  Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Converged; not yet validated"));
  EXPECT_TRUE(test::has(verdict.sentence, "1 check failed"));
  EXPECT_EQ(verdict.step, Step::kConvergenceTest);
  situation.review.testing = true;
  EXPECT_EQ(verdictOf(situation).sentence, QStringLiteral("No seed is done yet."));
  situation.review.seeds_done = situation.review.seeds_returned = 3;
  verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("3 seeds done; all end at this pose."));
  EXPECT_EQ(verdict.step, Step::kStopTest);
  situation.review.testing = false;
  situation.review.tested = true;
  situation.review.failed = 0;
  verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("All checks passed."));
  EXPECT_EQ(verdict.tone, VerdictTone::kGood);
  EXPECT_EQ(verdict.step, Step::kValidate);
  situation.review.state = sessions::ReviewState::kRejected;
  situation.review.decision = QStringLiteral("by A. Operator: blurred");
  verdict = verdictOf(situation);
  EXPECT_EQ(verdict.tone, VerdictTone::kBad);
  EXPECT_EQ(verdict.step, Step::kNextCase);
}

/// The headline once called a rejected run converged, as its checks were there.
TEST(Verdict, ReviewOfAFailedRun_TellsTheFailure) {
  Situation situation = ready();
  situation.workspace = Workspace::kReview;
  situation.trace = ended(LocalizationStatus::kNotSupported);
  situation.review.current = true;
  situation.review.failed = 10;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("Rejected"));
  EXPECT_EQ(verdict.tone, VerdictTone::kBad);
  EXPECT_EQ(verdict.step, Step::kWiderSearch);
}

TEST(Verdict, BadAnnotation_IsSwitchedOff) {
  Situation situation = annotating();
  situation.annotation.pairs = 8;
  situation.annotation.rms_px = 1.72;
  situation.annotation.bad_pair = QStringLiteral("p6");
  situation.annotation.bad_sigmas = 12.0;
  situation.annotation.has_pose = true;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.head, QStringLiteral("8 pairs, rms 1.72 px"));
  EXPECT_TRUE(test::has(verdict.sentence, "p6 stands out"));
  EXPECT_EQ(verdict.step, Step::kDisablePair);
  EXPECT_EQ(verdict.tone, VerdictTone::kCaution);
}

TEST(Verdict, Onboard_TellsWhetherTheRunsAgree) {
  Situation situation = ready();
  situation.workspace = Workspace::kOnboard;
  situation.not_compared = QStringLiteral("No record is attached.");
  EXPECT_EQ(verdictOf(situation).step, Step::kLoadRecord);
  situation.can_repeat = true;
  EXPECT_EQ(verdictOf(situation).step, Step::kRepeatRecord);
  situation.run = RunState::kWorking;
  EXPECT_EQ(verdictOf(situation).step, Step::kStop);
  situation.run = RunState::kFinished;
  auto comparison = std::make_shared<sessions::RecordComparison>();
  comparison->verdict = sessions::RunVerdict::kEqual;
  situation.comparison = comparison;
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Agrees bit for bit."));
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kGood);
  comparison->verdict = sessions::RunVerdict::kDifferent;
  EXPECT_EQ(verdictOf(situation).tone, VerdictTone::kBad);
}

/// In the program's look, whose font does not round as plain widgets' does.
TEST(VerdictBarText, LongSentenceTakesTwoLinesBeforeItIsCut) {
  applyTheme(*qApp, ThemeName::kLight);
  VerdictBar bar;
  bar.resize(1200, kVerdictHeight);
  bar.show();
  Verdict verdict;
  verdict.head = QStringLiteral("Converged");
  verdict.sentence = QStringLiteral("in 4 iterations, ").repeated(10);
  verdict.step = Step::kReview;
  bar.setVerdict(verdict);
  QApplication::processEvents();
  const auto* sentence = bar.findChild<QLabel*>(QStringLiteral("verdictSentence"));
  const int needed = sentence->fontMetrics().horizontalAdvance(verdict.sentence);
  ASSERT_GT(needed, sentence->width()) << "it takes more than a line";
  ASSERT_LT(needed, 1.8 * sentence->width()) << "and less than two";
  EXPECT_EQ(sentence->text(), verdict.sentence);
  bar.resize(700, kVerdictHeight);
  QApplication::processEvents();
  EXPECT_NE(sentence->text(), verdict.sentence);
  EXPECT_EQ(sentence->toolTip(), verdict.sentence);
  qApp->setStyleSheet({});
}

}  // namespace
}  // namespace boresight::ui
