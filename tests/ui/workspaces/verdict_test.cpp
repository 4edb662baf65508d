// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/verdict.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"
#include "tests/ui/window_test.h"
#include "ui/style/theme.h"
#include "ui/style/tokens.h"
#include "ui/workspaces/remedies.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

using Tone = VerdictTone;

/// The head is compared whole, of the sentence a part.
testing::AssertionResult tells(const Situation& situation, Tone tone, const char* head,
                               const char* part, Step step) {
  const Verdict verdict = verdictOf(situation);
  if (verdict.tone == tone && verdict.head == QString::fromUtf8(head) &&
      verdict.sentence.contains(QString::fromUtf8(part)) && verdict.step == step)
    return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "tone " << static_cast<int>(verdict.tone) << ", head '" << verdict.head.toStdString()
         << "', sentence '" << verdict.sentence.toStdString() << "', step "
         << static_cast<int>(verdict.step);
}

Situation ready() {
  Situation situation;
  situation.has_case = true;
  situation.run = RunState::kReady;
  return situation;
}

/// A press that spans an update of the bar was no click; the menu of others was emptied.
TEST(VerdictBar, EqualVerdict_LeavesItsButtons) {
  VerdictBar bar;
  bar.resize(900, kVerdictHeight);
  bar.show();
  Verdict verdict{.head = QStringLiteral("Failed."),
                  .step = Step::kWiderSearch,
                  .others = {Step::kNudgeSeed, Step::kAnnotate, Step::kInputs}};
  bar.setVerdict(verdict);
  const auto buttons = bar.findChildren<QPushButton*>();
  bar.setVerdict(verdict);
  EXPECT_EQ(bar.findChildren<QPushButton*>(), buttons);
  verdict.others = {Step::kInputs};
  bar.setVerdict(verdict);
  EXPECT_NE(bar.findChildren<QPushButton*>(), buttons);
}

/// Its button acted on a case that is not on the screen.
TEST(Verdict, OnStart_IsAboutTheNewCase) {
  Situation situation = ready();
  situation.workspace = Workspace::kStart;
  EXPECT_TRUE(tells(situation, Tone::kPlain, "New case.", "Add an image", Step::kChooseFiles));
  situation.files.added = 2;
  situation.files.next = QStringLiteral("mesh");
  EXPECT_TRUE(tells(situation, Tone::kPlain, "2 of 4 files added", "", Step::kChooseFiles));
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

/// Converged, checked, and known to 0.1 mm.
Situation converged() {
  Situation situation = ready();
  situation.run = RunState::kFinished;
  situation.trace = ended(LocalizationStatus::kConverged);
  situation.quality = knownTo(0.1);
  situation.review.current = true;
  return situation;
}

Situation validated() {
  Situation situation = converged();
  situation.review.state = sessions::ReviewState::kValidated;
  situation.review.decision = QStringLiteral("by A. Operator, 09:02 UTC.");
  return situation;
}

Situation annotating() {
  Situation situation = ready();
  situation.workspace = Workspace::kAnnotate;
  return situation;
}

TEST(Verdict, BeforeARun_NamesWhatIsMissingAndOffersTheNextStep) {
  Situation situation;
  situation.files = {2, QStringLiteral("Still needed: a camera (json) and a seed pose (json).")};
  EXPECT_TRUE(tells(situation, Tone::kPlain, "2 of 4 files added", "Still needed: a camera",
                    Step::kChooseFiles));
  situation.reading = QStringLiteral("bc-000041");
  EXPECT_TRUE(tells(situation, Tone::kPlain, "Opening bc-000041.", "", Step::kNone));
  situation = ready();
  EXPECT_TRUE(tells(situation, Tone::kPlain, "Ready to run.", "", Step::kRun));
  situation.reading = QStringLiteral("bc-000041");  // its last run
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Opening bc-000041.")) << "not ready to run";
  situation = ready();
  situation.has_seed = false;
  EXPECT_EQ(verdictOf(situation).step, Step::kAnnotate);
  situation.annotation.has_pose = true;
  EXPECT_EQ(verdictOf(situation).step, Step::kSeedFromAnnotation);
}

TEST(Verdict, RunUnderWay_TellsTheStageAndStops_HaltedItGoesOn) {
  Situation situation = ready();
  situation.run = RunState::kWorking;
  auto trace = ended(LocalizationStatus::kRunning);
  trace->finished = false;
  trace->last_under_way = true;
  trace->iterations.resize(1);
  test::editIteration(*trace, 0, [](sessions::IterationTrace& iteration) {
    iteration.reached = Stage::kRender;
    iteration.kind = IterationKind::kMatch;
  });
  situation.trace = trace;
  const Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("Iteration 1: rendering done; next, templates."));
  EXPECT_EQ(verdict.step, Step::kStop);
  EXPECT_TRUE(verdict.plain);
  situation.run = RunState::kHalted;
  situation.trace = test::firstIterations(*test::exampleRun(), 1);
  EXPECT_TRUE(tells(situation, Tone::kPlain, "Paused after iteration 1.", "", Step::kGoOn));
}

TEST(Verdict, ConvergedRun_IsGoodAndNotYetValidated_OutdatedItIsRunAgain) {
  Situation situation = converged();
  EXPECT_TRUE(tells(situation, Tone::kGood, "Converged", "Not yet validated.", Step::kReview));
  situation.stale = QStringLiteral("The run was made with other options.");
  EXPECT_TRUE(tells(situation, Tone::kCaution, "Converged; outdated.", "", Step::kRunAgain));
}

TEST(Verdict, PoseBeyondTheRequirementOrAFailedCheck_IsNoSuccess) {
  Situation unchecked = converged();
  unchecked.review.current = false;
  EXPECT_EQ(verdictOf(unchecked).tone, Tone::kPlain) << "until the checks are complete";
  Situation situation = converged();
  situation.quality.reset();
  EXPECT_EQ(verdictOf(situation).tone, Tone::kPlain) << "not measured yet";
  situation.quality = knownTo(0.3676);
  EXPECT_TRUE(
      tells(situation, Tone::kGood, "Converged",
            "Pose known to 0.37 of 0.40 mm (3 sigma across the view axis at the end effector).",
            Step::kReview));
  situation.quality = knownTo(1.22);
  EXPECT_TRUE(tells(situation, Tone::kCaution, "Converged", "1.22 of 0.40 mm", Step::kReview));
  situation.quality = sessions::PoseQuality();
  EXPECT_EQ(verdictOf(situation).tone, Tone::kCaution) << "nothing is known";
  situation = converged();
  situation.review.tested = true;
  situation.review.failed = 2;
  EXPECT_TRUE(tells(situation, Tone::kCaution, "Converged", "2 checks failed", Step::kReview));
  situation.workspace = Workspace::kReview;
  EXPECT_TRUE(tells(situation, Tone::kCaution, "Converged; not yet validated", "2 checks failed",
                    Step::kNone));
}

TEST(Verdict, ValidationOfAnOutdatedRun_IsShownAsOutdatedInRunAndReview) {
  for (const Workspace workspace : {Workspace::kRun, Workspace::kReview}) {
    Situation situation = validated();
    situation.workspace = workspace;
    EXPECT_TRUE(tells(situation, Tone::kGood, "Validated", "", Step::kExportPose));
    EXPECT_EQ(verdictOf(situation).others.front(), Step::kReport);
    situation.review.outdated = QStringLiteral("the run was made with other options");
    situation.stale = QStringLiteral("The run was made with other options.");
    EXPECT_TRUE(tells(situation, Tone::kCaution, "Validated; outdated",
                      "Outdated: the run was made with other options.", Step::kRunAgain));
    EXPECT_EQ(verdictOf(situation).others.front(), Step::kExportPose);
  }
}

TEST(Verdict, RunThatCannotBeShown_IsReportedWithItsReason) {
  Situation situation = ready();
  situation.run_problem = QStringLiteral("There is not enough memory.");
  EXPECT_TRUE(tells(situation, Tone::kBad, "There is no run to show.",
                    "There is not enough memory.", Step::kRunAgain));
}

/// For the seconds after a session is opened the count of failed checks is not known.
TEST(Verdict, ValidationWhoseChecksAreNotMeasured_HasNoShieldAndNoTone) {
  Situation situation = validated();
  EXPECT_EQ(verdictOf(situation).icon, Icon::kShield);
  situation.review.current = false;
  EXPECT_EQ(verdictOf(situation).tone, Tone::kPlain);
  EXPECT_NE(verdictOf(situation).icon, Icon::kShield);
}

TEST(Verdict, ValidationWithAWaivedCheckOrByOnePersonOfTwo_IsCaution) {
  Situation situation = validated();
  situation.review.failed = 1;
  EXPECT_TRUE(
      tells(situation, Tone::kCaution, "Validated", "1 check failed, waived.", Step::kExportPose));
  situation = validated();
  situation.review.state = sessions::ReviewState::kConverged;
  situation.review.decision += QStringLiteral(" A second person must approve.");
  EXPECT_TRUE(tells(situation, Tone::kCaution, "To be approved", "", Step::kReview));
}

TEST(Verdict, RunUnderWayOfAValidatedCase_IsTheRun) {
  Situation situation = validated();
  situation.run = RunState::kReady;
  situation.in_batch = true;
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Running."));
  situation.in_batch = false;
  situation.trace.reset();
  EXPECT_EQ(verdictOf(situation).head, QStringLiteral("Ready to run.")) << "it was dropped";
}

/// One that stands out is switched off; several hide each other, and are weighed.
TEST(Verdict, SuspectedAnnotations_AreNamedAndRobustIsProposed) {
  Situation situation = annotating();
  situation.annotation.pairs = 8;
  situation.annotation.rms_px = 1.72;
  situation.annotation.has_pose = true;
  const char* head = "8 pairs, rms 1.72 px";
  EXPECT_TRUE(tells(situation, Tone::kGood, head, "", Step::kSeedFromAnnotation));
  situation.annotation.bad_pair = QStringLiteral("p6");
  situation.annotation.bad_sigmas = 12.0;
  EXPECT_TRUE(tells(situation, Tone::kCaution, head, "p6 stands out", Step::kDisablePair));
  situation.annotation.concern = QStringLiteral("The residuals are 16.0 times the stated sigmas.");
  for (const char* id : {"p2", "p5", "p7", "p8", "p9"})
    situation.annotation.suspects << QString::fromLatin1(id);
  EXPECT_TRUE(
      tells(situation, Tone::kCaution, head, "Suspected: p2, p5, p7 and 2 others.", Step::kRobust));
  situation.annotation.robust = true;
  situation.annotation.concern.clear();
  EXPECT_TRUE(tells(situation, Tone::kGood, head, "Little weight: p2, p5, p7 and 2 others",
                    Step::kSeedFromAnnotation))
      << "the others fit";
}

TEST(Verdict, AnnotationsThatAreTooCoarse_AreNoSuccess_ABlindRoundHasNoFigures) {
  Situation situation = annotating();
  situation.annotation.pairs = 7;
  situation.annotation.has_pose = true;
  situation.annotation.concern = QStringLiteral("The residuals are 16.0 times the stated sigmas.");
  EXPECT_TRUE(tells(situation, Tone::kCaution, "7 pairs", "16.0 times the stated sigmas",
                    Step::kSeedFromAnnotation));
  situation = annotating();
  situation.annotation.pairs = 3;
  situation.annotation.blind = true;
  situation.annotation.unplaced = 4;
  EXPECT_TRUE(tells(situation, Tone::kPlain, "Blind round: 3 pairs",
                    "Place or remove the 4 that are left", Step::kNone));
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
    SCOPED_TRACE(localizationStatusText(status));
    EXPECT_EQ(verdict.tone, Tone::kBad);
    EXPECT_FALSE(verdict.sentence.isEmpty());
    EXPECT_NE(verdict.step, Step::kNone);
    EXPECT_FALSE(verdict.others.empty());
    EXPECT_EQ(remediesFor(*situation.trace).front().step, verdict.step);
  }
}

/// The headline of Review once called a rejected run converged, as its checks were there.
TEST(Verdict, NotSupportedPose_IsRejectedInRunAndReviewAndOffersAWiderSearch) {
  Situation situation = ready();
  situation.trace = ended(LocalizationStatus::kNotSupported);
  for (const char* part : {"needed", "seed may be turned"})
    EXPECT_TRUE(tells(situation, Tone::kBad, "Rejected", part, Step::kWiderSearch));
  EXPECT_EQ(verdictOf(situation).others.front(), Step::kNudgeSeed);
  situation.workspace = Workspace::kReview;
  situation.review.current = true;
  situation.review.failed = 10;
  EXPECT_TRUE(tells(situation, Tone::kBad, "Rejected", "", Step::kWiderSearch));
}

TEST(Verdict, DoubtfulPose_OffersToAnnotateFromItInRunAndReview) {
  Situation situation = ready();
  auto run = ended(LocalizationStatus::kNotSupported);
  run->probability = 0.095;
  situation.trace = run;
  for (const Workspace workspace : {Workspace::kRun, Workspace::kDiagnose, Workspace::kReview}) {
    situation.workspace = workspace;
    EXPECT_TRUE(tells(situation, Tone::kBad, "Rejected", "Doubtful pose, probability 9.5 %",
                      Step::kAnnotateFromPose));
  }
  situation.tried = {Step::kAnnotateFromPose};
  EXPECT_NE(verdictOf(situation).step, Step::kAnnotateFromPose) << "it did not lead to a pose";
}

TEST(Verdict, Review_TellsOpenChecksThenTheTestThenTheDecision) {
  Situation situation = converged();
  situation.workspace = Workspace::kReview;
  situation.review.failed = 1;
  EXPECT_TRUE(tells(situation, Tone::kCaution, "Converged; not yet validated", "1 check failed",
                    Step::kConvergenceTest));
  situation.review.testing = true;
  EXPECT_EQ(verdictOf(situation).sentence, QStringLiteral("No seed is done yet."));
  situation.review.seeds_done = situation.review.seeds_returned = 3;
  Verdict verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("3 seeds done; all end at this pose."));
  EXPECT_EQ(verdict.step, Step::kStopTest);
  situation.review.testing = false;
  situation.review.tested = true;
  situation.review.failed = 0;
  verdict = verdictOf(situation);
  EXPECT_EQ(verdict.sentence, QStringLiteral("All checks passed."));
  EXPECT_EQ(verdict.tone, Tone::kGood);
  EXPECT_EQ(verdict.step, Step::kValidate);
  situation.review.state = sessions::ReviewState::kRejected;
  situation.review.decision = QStringLiteral("by A. Operator: blurred");
  EXPECT_TRUE(tells(situation, Tone::kBad, "Rejected in review", "", Step::kNextCase));
  situation.has_next = false;
  EXPECT_TRUE(tells(situation, Tone::kBad, "Rejected in review", "", Step::kNone));
}

TEST(Remedies, AFailedCheckLeadsToWhatItsFigureComesFrom) {
  EXPECT_EQ(stepOfCheck("convergence_competing"), Step::kCompetingPoses);
  EXPECT_EQ(stepOfCheck("image_saturated"), Step::kMask);
  EXPECT_EQ(stepOfCheck("image_range"), Step::kInputs);
  EXPECT_EQ(stepOfCheck("agreement_annotation"), Step::kAnnotate);
  EXPECT_EQ(stepOfCheck("edge_coverage"), Step::kInspect);
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
  EXPECT_TRUE(tells(situation, Tone::kGood, "Agrees bit for bit.", "", Step::kNextCase));
  comparison->verdict = sessions::RunVerdict::kDifferent;
  EXPECT_EQ(verdictOf(situation).tone, Tone::kBad);
  comparison->verdict = sessions::RunVerdict::kWithinLimits;
  EXPECT_EQ(verdictOf(situation).tone, Tone::kCaution) << "neither inputs nor ends were compared";
  comparison->inputs_compared = comparison->ends_compared = true;
  EXPECT_EQ(verdictOf(situation).tone, Tone::kGood);
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
