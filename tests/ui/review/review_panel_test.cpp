// SPDX-License-Identifier: Apache-2.0
#include "ui/review/review_panel.h"

#include <algorithm>
#include <new>
#include <string>
#include <utility>

#include <QtWidgets>

#include "sessions/checks/pose_quality.h"
#include "sessions/decision/check_limits.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/session_document.h"
#include "tests/support/annotated_example.h"
#include "tests/ui/review/review_fixture.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/diagnose/options_table.h"
#include "ui/review/check_cards.h"
#include "ui/review/pose_export.h"
#include "ui/review/precision_bars.h"
#include "ui/run/export_runner.h"
#include "ui/state/document.h"
#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"
#include "ui/window/verdict_controller.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/job_strip.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

using sessions::CheckState;
using sessions::ReviewState;
using test::exampleSession;
using test::kPatienceMs;

/// The checks measure what the pixels allow.
[[maybe_unused]] const bool kNeedsAllPixels = test::needsAllPixels() = true;

/// The case that the runs are of.
const std::string& firstCase() { return exampleSession().cases.front()->id; }

class ReviewPanelTest : public ::testing::Test {
 protected:
  ReviewPanelTest() {
    panel_ = std::make_unique<ReviewPanel>(document_, state_);
    panel_->resize(900, 300);
    panel_->show();
  }

  std::filesystem::path file() const { return folder_.path() / "one.boresight.json"; }

  void open(const sessions::Session& session) {
    ASSERT_TRUE(document_.create(file(), session));
    static const auto loaded = sessions::loadCase(*exampleSession().cases.front());
    state_.setCase(loaded);
    if (const sessions::RunRecord* run = document_.session().lastRunOf(firstCase()))
      state_.setSnapshot(
          std::make_shared<const sessions::LocalizationTrace>(sessions::loadSnapshot(*run)));
  }
  void openRun() {
    open(test::withRunOfSeed(exampleSession(), file()));
    ASSERT_TRUE(checked());
  }
  bool checked() {
    return QTest::qWaitFor([this] { return controller().isCurrent() && !controller().isBusy(); },
                           kPatienceMs);
  }
  ReviewController& controller() { return panel_->controller(); }
  test::ReviewHands hands() { return test::ReviewHands(*panel_); }
  bool enabled(const char* button) { return hands().button(button)->isEnabled(); }
  ReviewState reviewState() { return controller().reviewStatus().state; }
  QString obstacle() { return panel_->findChild<DecisionForm*>()->obstacle(); }
  QString history() { return panel_->findChild<QTextBrowser*>()->toPlainText(); }
  int count(CheckState state) { return countOf(controller().checks(), state); }

  /// Thousands are a limit that nothing keeps to.
  void requireInliers(double count) {
    sessions::CheckLimits limits = sessions::checkLimits(controller().settings().preset, {});
    limits.inlier_count = count;
    controller().setLimits(limits);
    ASSERT_TRUE(checked());
    QCoreApplication::processEvents();  // new cards come into sight
  }

  test::TemporaryFolder folder_;
  test::OwnSettings settings_{folder_.path()};
  Document document_;
  ViewState state_;
  std::unique_ptr<ReviewPanel> panel_;
};

TEST_F(ReviewPanelTest, WithoutAPose_SaysWhatToDo) {
  EXPECT_EQ(hands().table().model()->rowCount(), 0);
  EXPECT_TRUE(test::has(hands().hint(), "No session"));
  EXPECT_FALSE(enabled("validate"));
  open(exampleSession());
  EXPECT_TRUE(test::has(hands().hint(), "F5"));
  EXPECT_TRUE(test::has(obstacle(), "run it"));
  hands().sign(QStringLiteral("Ada"), QStringLiteral("no reason"));
  EXPECT_FALSE(enabled("validate"));
  EXPECT_TRUE(enabled("reject")) << "an image can be refused as it is";
}

TEST_F(ReviewPanelTest, FailedChecksAreCards_OthersFoldToALine) {
  openRun();
  const auto* bars = panel_->findChild<PrecisionBars*>();
  EXPECT_EQ(bars->isVisible(), count(CheckState::kFailed) == 0)
      << "where nothing failed, the measure of the pose leads";
  EXPECT_TRUE(test::has(hands().banner(), "NOT VALIDATED"));
  requireInliers(10000.0);
  EXPECT_FALSE(bars->isVisible());

  const auto& checks = controller().checks();
  const QTableView& table = hands().table();
  const auto* cards = panel_->findChild<CheckCards*>();
  EXPECT_EQ(cards->findChildren<QLineEdit*>().size(), count(CheckState::kFailed));
  QStringList texts;
  for (const QLabel* label : cards->findChildren<QLabel*>()) texts << label->text();
  ASSERT_EQ(table.model()->rowCount(), static_cast<int>(checks.size()));
  for (const sessions::Check& check : checks) {
    const int row = hands().rowOf(fromText(check.title));
    ASSERT_GE(row, 0) << check.title;
    const QString text = test::textAt(table, row, ChecksModel::kCheck);
    EXPECT_TRUE(text.startsWith(ChecksModel::sign(check.state))) << text.toStdString();
    EXPECT_EQ(test::textAt(table, row, ChecksModel::kFound), fromText(sessions::foundText(check)));
    const bool card =
        texts.contains(fromText(check.sentence)) && texts.contains(foundAndLimit(check));
    EXPECT_TRUE(card || check.state != CheckState::kFailed) << check.title;
  }

  const auto shown = [&](CheckState state) {
    return std::ranges::count_if(checks, [&](const sessions::Check& check) {
      return check.state == state && table.isVisible() &&
             !table.isRowHidden(hands().rowOf(fromText(check.title)));
    });
  };
  const auto click = [this](const char* name) {
    auto* fold = panel_->findChild<FoldButton*>(QLatin1String(name));
    QTest::mouseClick(fold, Qt::LeftButton);
    return fold->text();
  };
  EXPECT_FALSE(table.isVisible()) << "at first";
  EXPECT_EQ(click("passedFold"), QStringLiteral("%1 passed").arg(count(CheckState::kPassed)));
  EXPECT_EQ(shown(CheckState::kPassed), count(CheckState::kPassed));
  EXPECT_EQ(shown(CheckState::kNotApplicable), 0);
  EXPECT_EQ(shown(CheckState::kFailed), 0) << "they are cards";
  ASSERT_GT(count(CheckState::kNotApplicable), 0);
  click("notApplicableFold");
  EXPECT_EQ(shown(CheckState::kNotApplicable), count(CheckState::kNotApplicable));
  const ReviewPanel next(document_, state_);
  EXPECT_FALSE(next.findChild<FoldButton*>(QStringLiteral("notApplicableFold"))->isFolded())
      << "as it was left";
}

TEST_F(ReviewPanelTest, HiddenPanel_ChecksNothing) {
  panel_->hide();
  open(test::withRunOfSeed(exampleSession(), file()));
  EXPECT_FALSE(controller().isBusy());
  EXPECT_TRUE(controller().checks().empty());
  panel_->show();
  EXPECT_TRUE(checked());
  EXPECT_FALSE(controller().checks().empty());
}

TEST_F(ReviewPanelTest, Validation_NeedsANameACommentAndAReasonForEveryFailedCheck) {
  openRun();
  hands().passOverAll(QStringLiteral("known"));
  EXPECT_FALSE(enabled("validate"));
  EXPECT_TRUE(test::has(obstacle(), "name"));
  hands().type("decisionName", QStringLiteral("Ada"));
  EXPECT_TRUE(test::has(obstacle(), "comment"));
  hands().type("decisionComment", QStringLiteral("looked at it"));
  EXPECT_TRUE(enabled("validate"));
  EXPECT_TRUE(obstacle().isEmpty());

  requireInliers(10000.0);
  ASSERT_GT(count(CheckState::kFailed), 0);
  EXPECT_FALSE(enabled("validate"));
  EXPECT_TRUE(test::has(obstacle(), "Inliers"));
  std::string shown;
  QObject::connect(panel_.get(), &ReviewPanel::checkShowRequested, panel_.get(),
                   [&shown](const std::string& id) { shown = id; });
  panel_->findChild<QPushButton*>(QStringLiteral("showCheck"))->click();
  QCoreApplication::processEvents();
  EXPECT_EQ(shown, "inlier_count");
  auto* reason = panel_->findChild<QLineEdit*>(QStringLiteral("waiver"));
  reason->setFocus();
  reason->clear();
  QTest::keyClicks(reason, QStringLiteral("half a rea"));
  Q_EMIT controller().checksChanged();  // others may change while the operator types
  EXPECT_EQ(reason->text(), QStringLiteral("half a rea"));
  EXPECT_EQ(panel_->findChild<QLineEdit*>(QStringLiteral("waiver")), reason);
  hands().passOverAll(QStringLiteral("   "));
  EXPECT_FALSE(enabled("validate")) << "blanks are no reason";
  hands().passOverAll(QStringLiteral("known"));
  EXPECT_TRUE(enabled("validate")) << obstacle().toStdString();
  requireInliers(9999.0);
  EXPECT_FALSE(enabled("validate")) << "a reason holds for its figure alone";
  hands().passOverAll(QStringLiteral("a small station"));
  ASSERT_TRUE(enabled("validate")) << obstacle().toStdString();
  hands().click("validate");
  EXPECT_EQ(reviewState(), ReviewState::kValidated);
  EXPECT_TRUE(test::has(history(), "a small station"));
}

/// The field was hidden with its card, and with that its editing had ended.
TEST(CheckCards, ReasonThatIsBeingTyped_IsNotGivenToANewFigure) {
  CheckCards cards;
  FailedCheck failed;
  failed.check.id = "inlier_count";
  failed.check.title = "Inliers";
  failed.check.state = CheckState::kFailed;
  failed.check.figure = 7.0;
  failed.check.limit = 10.0;
  cards.setChecks({failed}, true);
  cards.show();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&cards));
  QSignalSpy reasons(&cards, &CheckCards::reasonEdited);
  auto* field = cards.findChild<QLineEdit*>(QStringLiteral("waiver"));
  field->setFocus();
  QTest::keyClicks(field, QStringLiteral("a small station"));
  failed.check.figure = 3.0;
  cards.setChecks({failed}, true);
  EXPECT_EQ(reasons.count(), 0);
}

TEST_F(ReviewPanelTest, ADecisionCanBeTakenBackOrUndone_AndOnlyItsNameStaysInTheForm) {
  openRun();
  EXPECT_FALSE(enabled("takeBack"));
  hands().sign(QStringLiteral("Ada"), QStringLiteral("the gripper hides it"));
  hands().click("reject");
  EXPECT_EQ(reviewState(), ReviewState::kRejected);
  EXPECT_TRUE(test::has(hands().banner(), "rejected by Ada"));
  hands().sign(QStringLiteral("Grace"), QStringLiteral("it does not"));
  hands().click("takeBack");
  EXPECT_EQ(reviewState(), ReviewState::kConverged);
  EXPECT_TRUE(test::has(history(), "the gripper hides it"));
  EXPECT_TRUE(test::has(history(), "Withdrawn by Grace")) << "the newest first";

  hands().validateAs(QStringLiteral("Ada"));
  ASSERT_EQ(reviewState(), ReviewState::kValidated);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Validate %1").arg(fromText(firstCase())));
  EXPECT_TRUE(test::has(hands().banner(), "Validated by Ada"));
  EXPECT_FALSE(enabled("validate")) << "said once";
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(reviewState(), ReviewState::kConverged);
  EXPECT_EQ(document_.session().decisions.size(), 2u);
  EXPECT_FALSE(history().contains(QStringLiteral("Validated by Ada")));
  ASSERT_TRUE(document_.redo());
  EXPECT_EQ(reviewState(), ReviewState::kValidated);
  const auto text = [this](const char* name) {
    return panel_->findChild<QLineEdit*>(QLatin1String(name))->text();
  };
  EXPECT_EQ(text("decisionComment"), QString());
  EXPECT_EQ(text("decisionName"), QStringLiteral("Ada"));
  ASSERT_TRUE(document_.save());
  EXPECT_EQ(text("decisionName"), QStringLiteral("Ada"));
  ASSERT_TRUE(document_.create(folder_.path() / "two.boresight.json", exampleSession()));
  EXPECT_EQ(text("decisionName"), QString()) << "another session is another reviewer's";
}

TEST_F(ReviewPanelTest, Approval_NeedsAnotherPerson_AndButtonsAreWholeInASidePane) {
  const auto visible = [this] {
    QApplication::processEvents();
    std::vector<std::string> names;
    for (const char* name : {"validate", "validateNext", "approve", "reject", "takeBack"}) {
      const QPushButton* button = hands().button(name);
      if (!button->isVisible()) continue;
      names.emplace_back(name);
      EXPECT_GE(button->width(), button->sizeHint().width()) << name;
    }
    return names;
  };
  openRun();
  panel_->resize(kNarrow.review_side, 600);
  EXPECT_THAT(visible(), testing::ElementsAre("validate", "validateNext", "reject"));
  document_.edit(sessions::withoutCase(document_.session(), exampleSession().cases[1]->id),
                 QStringLiteral("Remove"));
  EXPECT_THAT(visible(), testing::ElementsAre("validate", "reject"));
  ASSERT_TRUE(document_.undo());
  controller().setSecondPerson(true);
  hands().validateAs(QStringLiteral("Ada"));
  EXPECT_THAT(visible(), testing::ElementsAre("validate", "approve", "reject", "takeBack"));

  EXPECT_EQ(reviewState(), ReviewState::kConverged) << "not yet validated";
  EXPECT_TRUE(test::has(hands().banner(), "second person"));
  hands().sign(QStringLiteral(" aDa "), QStringLiteral("me again"));
  EXPECT_FALSE(enabled("approve"));
  EXPECT_FALSE(enabled("validate")) << "it would replace the first one";
  EXPECT_TRUE(test::has(obstacle(), "another person"));
  hands().type("decisionName", QStringLiteral("Grace"));
  ASSERT_TRUE(enabled("approve")) << obstacle().toStdString();
  hands().click("approve");
  EXPECT_EQ(reviewState(), ReviewState::kValidated);
  EXPECT_TRUE(test::has(hands().banner(), "approved by Grace"));
}

TEST_F(ReviewPanelTest, AnnotatedPose_CanBeJudgedAndItsChangeIsReported) {
  const std::string id = firstCase();
  open(withAnnotations(test::withRunOfSeed(exampleSession(), file()), id,
                       *test::annotatedExample(0.2).annotations.at(id)));
  ASSERT_TRUE(checked());
  auto* judged = panel_->findChild<QComboBox*>(QStringLiteral("judged"));
  ASSERT_EQ(judged->count(), 2);
  EXPECT_EQ(controller().source(), sessions::PoseSource::kRun);
  judged->setFocus();
  QTest::keyClick(judged, Qt::Key_Down);
  EXPECT_EQ(controller().source(), sessions::PoseSource::kAnnotation);
  EXPECT_FALSE(controller().isCurrent()) << "stale at once";
  ASSERT_TRUE(checked());
  hands().validateAs(QStringLiteral("Ada"));
  ASSERT_EQ(reviewState(), ReviewState::kValidated);
  EXPECT_EQ(controller().reviewStatus().decision->pose->source, sessions::PoseSource::kAnnotation);
  sessions::Annotations moved = *document_.session().annotations.at(id);
  moved.points[0].pixel->x() += 0.3;
  document_.edit(withAnnotations(document_.session(), id, moved), QStringLiteral("Move"));
  EXPECT_TRUE(test::has(hands().banner(), "the annotations have changed"));
  EXPECT_FALSE(controller().isCurrent());
}

TEST_F(ReviewPanelTest, RejectedAnnotationOfACaseWithoutARun_KeepsItsChecks) {
  open(withAnnotations(exampleSession(), firstCase(),
                       *test::annotatedExample(0.2).annotations.at(firstCase())));
  ASSERT_TRUE(checked());
  ASSERT_EQ(controller().source(), sessions::PoseSource::kAnnotation);
  ASSERT_TRUE(controller().decide(ReviewController::Act::kReject, {"Ada", "too coarse"}));
  EXPECT_EQ(document_.session().decisions.back().checks.size(), controller().checks().size());
}

TEST_F(ReviewPanelTest, LimitsAreEditedInTheirDialogAndSurviveSaving) {
  openRun();
  hands().click("openLimits");
  auto* dialog = panel_->findChild<LimitsDialog*>();
  ASSERT_NE(dialog, nullptr);
  auto* preset = dialog->findChild<QComboBox*>(QStringLiteral("preset"));
  preset->setFocus();
  QTest::keyClick(preset, Qt::Key_Down);
  EXPECT_EQ(document_.session().review.preset, sessions::checkPresets()[1].name);
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(preset->currentText(), QLatin1String(sessions::kDefaultCheckPreset));
  auto* table = dialog->findChild<QTableView*>(QStringLiteral("limits"));
  const int row = test::rowWith(*table, OptionsModel::kName, QStringLiteral("inlier_count"));
  ASSERT_GE(row, 0);
  test::ReviewHands::typeInto(*table, row, OptionsModel::kValue, QStringLiteral("-5"));
  EXPECT_TRUE(
      test::has(dialog->findChild<QLabel*>(QStringLiteral("limitHelp"))->text(), "Not changed"));
  EXPECT_TRUE(document_.session().review.limits.empty());
  test::ReviewHands::typeInto(*table, row, OptionsModel::kValue, QStringLiteral("9000"));
  ASSERT_EQ(document_.session().review.limits.size(), 1u);
  EXPECT_FALSE(controller().isCurrent()) << "stale at once";
  ASSERT_TRUE(checked());
  const int checked_row = hands().rowOf(QString::fromUtf8("✗ Inliers"));
  ASSERT_GE(checked_row, 0);
  EXPECT_EQ(test::textAt(hands().table(), checked_row, ChecksModel::kLimit),
            QString::fromUtf8("≥ 9000"));
  QTest::mouseClick(dialog->findChild<QCheckBox*>(QStringLiteral("secondPerson")), Qt::LeftButton,
                    Qt::NoModifier, QPoint(8, 8));
  EXPECT_TRUE(document_.session().review.second_person);
  ASSERT_TRUE(document_.save());
  const sessions::ReviewSettings kept = document_.session().review;
  document_.close();
  ASSERT_TRUE(document_.open(file()));
  EXPECT_EQ(document_.session().review, kept);
  EXPECT_EQ(sessions::checkLimits(kept.preset, kept.limits).inlier_count, 9000.0);
}

TEST_F(ReviewPanelTest, ConvergenceTestThatFails_IsReported) {
  openRun();
  QString message;
  QObject::connect(&controller(), &ReviewController::failed, panel_.get(),
                   [&](const QString& reported) { message = reported; });
  // Fails with the first seed that is done.
  bool thrown = false;
  QObject::connect(&controller(), &ReviewController::convergenceChanged, panel_.get(), [&] {
    if (controller().convergenceSoFar().seeds > 0 && !std::exchange(thrown, true))
      throw std::bad_alloc();
  });
  controller().startConvergenceTest(1);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !message.isEmpty(); }, kPatienceMs));
  EXPECT_TRUE(test::has(message, "The convergence test of"));
  EXPECT_TRUE(test::has(message, firstCase().c_str()));
  EXPECT_TRUE(checked()) << "and the checks remain";
}

TEST_F(ReviewPanelTest, ReasonThatIsTyped_IsForTheFigureThatWasShown) {
  openRun();
  requireInliers(9999.0);
  const auto failed = [this] {
    return *std::ranges::find(controller().checks(), CheckState::kFailed, &sessions::Check::state);
  };
  const sessions::Check before = failed();
  panel_->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(panel_.get()));
  auto* reason = panel_->findChild<CheckCards*>()->findChild<QLineEdit*>();
  reason->setFocus();
  QTest::keyClicks(reason, QStringLiteral("known"));
  requireInliers(10000.0);  // the field is left by this
  ASSERT_EQ(failed().id, before.id);
  ASSERT_FALSE(failed() == before);
  EXPECT_EQ(controller().reasonFor(failed()), QString());
}

TEST_F(ReviewPanelTest, ReasonsOfASession_AreNotTakenIntoAnother) {
  openRun();
  requireInliers(10000.0);
  const sessions::Check check =
      *std::ranges::find(controller().checks(), CheckState::kFailed, &sessions::Check::state);
  controller().setReason(check, QStringLiteral("known"));
  EXPECT_EQ(controller().reasonFor(check), QStringLiteral("known"));
  ASSERT_TRUE(document_.save());
  document_.close();
  ASSERT_TRUE(document_.open(file()));
  EXPECT_EQ(controller().reasonFor(check), QString());
}

TEST_F(ReviewPanelTest, ConvergenceTest_EntersTheChecksAndCanBeStopped) {
  openRun();
  const auto state = [this] {
    for (const sessions::Check& check : controller().checks())
      if (check.id.find("convergence") != std::string::npos) return check.state;
    ADD_FAILURE() << "there is no such check";
    return CheckState::kNotApplicable;
  };
  EXPECT_EQ(state(), CheckState::kNotApplicable);
  panel_->findChild<QSpinBox*>(QStringLiteral("convergenceSeeds"))->setValue(1000);
  hands().click("convergence");
  EXPECT_TRUE(test::has(hands().button("convergence")->text(), "Stop"));
  ASSERT_TRUE(
      QTest::qWaitFor([this] { return controller().convergenceSoFar().seeds >= 2; }, kPatienceMs));
  hands().click("convergence");
  ASSERT_TRUE(checked());
  EXPECT_NE(state(), CheckState::kNotApplicable) << "what has been run counts";
  EXPECT_TRUE(test::has(hands().button("convergence")->text(), "test"));
}

TEST_F(ReviewPanelTest, AReadOnlySessionIsNotDecidedOn) {
  ASSERT_TRUE(document_.create(file(), test::withRunOfSeed(exampleSession(), file())));
  ASSERT_TRUE(document_.save());
  Document reader;
  ASSERT_TRUE(reader.open(file()));
  ASSERT_FALSE(reader.readOnlyReason().isEmpty()) << "another one has it open";
  ReviewController controller(reader, state_);
  state_.setCase(sessions::loadCase(*reader.session().cases[0]));
  EXPECT_EQ(controller.obstacle(ReviewController::Act::kReject, {"Ada", "no"}),
            reader.readOnlyReason());
  EXPECT_FALSE(controller.decide(ReviewController::Act::kReject, {"Ada", "no"}));
  LimitsDialog limits(controller, nullptr);
  auto* second = limits.findChild<QCheckBox*>(QStringLiteral("secondPerson"));
  second->click();
  EXPECT_FALSE(second->isChecked()) << "the session has not taken it";
}

TEST_F(ReviewPanelTest, Exports_AreLabelledUnlessValidated) {
  openRun();
  ExportRunner exports;
  PoseExport exporter(*panel_, document_, state_, exports);
  QString said;
  const auto hear = [&said](const QString& text) { said = text; };
  QObject::connect(&exporter, &PoseExport::noted, panel_.get(), hear);
  QObject::connect(&exports, &ExportRunner::failed, panel_.get(), hear);
  const auto saidOf = [&](const std::function<void()>& write) {
    said.clear();
    write();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !exports.isBusy(); }, kPatienceMs));
    return said;
  };
  const auto pose = folder_ / "pose.json", report = folder_ / "report.pdf";
  EXPECT_TRUE(test::has(exporter.poseFileName(), "NOT_VALIDATED"));
  EXPECT_TRUE(test::has(saidOf([&] { exporter.exportPose(pose); }), "NOT VALIDATED"));
  EXPECT_TRUE(sessions::verifyPose(pose, true).good());
  EXPECT_TRUE(test::has(saidOf([&] { exporter.exportReport(report); }), "NOT VALIDATED"));
  EXPECT_GT(std::filesystem::file_size(report), 10000u);

  // Results of poses that are not validated need a name that says so.
  const auto results = folder_ / "results.csv";
  const auto honest = folder_ / exporter.bopResultsFileName().toStdString();
  EXPECT_TRUE(test::has(saidOf([&] { exporter.exportBopResults(results, 1); }), "NOT-VALIDATED"));
  saidOf([&] { exporter.exportBopResults(honest, 1); });
  EXPECT_TRUE(std::filesystem::exists(honest));
  EXPECT_FALSE(std::filesystem::exists(results));

  hands().validateAs(QStringLiteral("Ada"));
  const QString id = fromText(firstCase());
  EXPECT_EQ(exporter.poseFileName(), id + QStringLiteral("_validated_pose.json"));
  EXPECT_EQ(exporter.reportFileName(), id + QStringLiteral("_pose_report.pdf"));
}

/// Reviewing in the whole window: from a run to a decision, and what takes it away again.
class ReviewWindowTest : public test::WindowTest {
 protected:
  bool checked() {
    return wait([this] {
      return panel().controller().isCurrent() && !panel().controller().isBusy() && resting();
    });
  }
  ReviewPanel& panel() { return *window_.findChild<ReviewPanel*>(); }
  test::ReviewHands hands() { return test::ReviewHands(panel()); }
  /// As the list of cases names the state of the example's first case.
  QString listed() {
    const auto& table = find<QTableView>("cases");
    const int row = test::rowWith(table, CasesModel::kCase, fromText(firstCase()));
    return test::textAt(table, row, CasesModel::kState);
  }
  void validateRun() {
    QTest::keyClick(&window_, Qt::Key_F9);
    ASSERT_TRUE(checked());
    ASSERT_GT(hands().table().model()->rowCount(), 5) << "checks appear by themselves";
    hands().validateAs(QStringLiteral("Ada"));
    ASSERT_TRUE(test::has(listed(), "validated"));
  }
};

/// Two figures against one limit were shown: the image's alone, and the checks'.
TEST_F(ReviewWindowTest, BarResultChecksAndReport_StateOneQuality) {
  openRun();
  const std::shared_ptr<const sessions::LoadedCase> loaded = window_.state().currentCase();
  const sessions::PoseQuality quality =
      sessions::runQuality(window_.document().session(), loaded, *window_.state().snapshot());
  const sessions::PrecisionFigure* worst = quality.worst();
  ASSERT_NE(worst, nullptr);
  const auto& bar = window_.frame().verdict();
  ASSERT_TRUE(wait([&] { return bar.text().contains(QStringLiteral("known to")); }));
  EXPECT_TRUE(test::has(bar.text(), quality.text().c_str()));
  const auto labels = window_.dock(QStringLiteral("result"))->findChildren<QLabel*>();
  EXPECT_THAT(labels, testing::Contains(testing::Property(&QLabel::text, fromText(worst->text()))));
  QTest::keyClick(&window_, Qt::Key_F9);
  ASSERT_TRUE(checked());
  const auto& checks = panel().controller().checks();
  const auto check = std::ranges::find(checks, worst->check.id, &sessions::Check::id);
  ASSERT_NE(check, checks.end());
  EXPECT_EQ(check->figure, worst->found);
  EXPECT_EQ(bar.verdict().tone == VerdictTone::kCaution, countOf(checks, CheckState::kFailed) > 0);
}

/// At most 64 cases are asked for their decision.
TEST_F(ReviewWindowTest, CaseBehindManyThatAwaitTheirSecondPerson_IsTheNext) {
  sessions::Session session = exampleSession();
  session.review.second_person = true;
  for (int i = 0; i < 70; ++i) {
    sessions::SessionCase copy = *exampleSession().cases[1];
    copy.id = "copy-" + std::to_string(i);
    session = withCase(session, copy);
  }
  sessions::Decision awaiting;
  awaiting.verdict = sessions::Verdict::kValidated;
  awaiting.by = "Ada";
  awaiting.comment = "looked at it";
  awaiting.time = "2026-01-31T23:59:59Z";
  awaiting.pose.emplace().source = sessions::PoseSource::kAnnotation;
  const auto validate = [&awaiting](sessions::Session& changed, const std::string& id) {
    awaiting.case_id = id;
    awaiting.input_fingerprint = sessions::inputFingerprint(changed, id, "");
    changed.decisions.push_back(awaiting);
    ASSERT_TRUE(sessions::reviewStatusOf(changed, id).awaits_approval);
  };
  const std::string last = "copy-69";
  for (const auto& each : exampleSession().cases) validate(session, each->id);
  for (int i = 0; i < 69; ++i) validate(session, "copy-" + std::to_string(i));
  open(session);
  const auto& verdicts = *window_.findChild<VerdictController*>();
  EXPECT_TRUE(wait([&] { return verdicts.nextCase() == fromText(last); }));
  session = window_.document().session();
  validate(session, last);
  ASSERT_TRUE(window_.document().edit(session, QStringLiteral("Validate")));
  EXPECT_TRUE(wait([&] { return verdicts.nextCase() == QString(); })) << "none is left";
}

/// Measuring a pose again can take as long as its convergence test.
TEST_F(ReviewWindowTest, Exports_AreInTheJobStripUntilTheyAreWritten) {
  openRun();
  JobStrip& strip = window_.frame().jobs();
  PoseExport exporter(window_, window_.document(), window_.state(), window_.exports());
  int cases = 0;
  QObject::connect(&window_.exports(), &ExportRunner::changed, &window_,
                   [&] { cases = std::max(cases, strip.job().of); });
  exporter.exportReport(folder_ / "report.pdf");
  exporter.exportColmap(folder_ / "colmap");
  EXPECT_EQ(strip.job().name, QStringLiteral("Writing report.pdf"));
  EXPECT_TRUE(strip.job().runs);
  EXPECT_FALSE(strip.stop().isVisible()) << "it cannot be stopped";
  ASSERT_TRUE(wait([&] { return !window_.exports().isBusy(); }));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report.pdf"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "colmap")) << "none replaces another";
  EXPECT_EQ(cases, 2) << "counted";
  EXPECT_FALSE(strip.job().runs);
}

TEST_F(ReviewWindowTest, FromARunToAValidation_ThatOptionsOutdateAndANewSeedInvalidates) {
  openExample();
  QTest::keyClick(&window_, Qt::Key_F9);
  EXPECT_TRUE(test::has(hands().hint(), "F5"));
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(checked());
  validateRun();
  const auto& bar = window_.frame().verdict();
  ASSERT_TRUE(wait([&] { return bar.verdict().head == QStringLiteral("Validated"); }));
  EXPECT_EQ(bar.verdict().step, Step::kExportPose);

  sessions::Session changed = window_.document().session();
  changed.options = {{"pnp.min_inliers", std::int64_t{20}}};
  ASSERT_TRUE(window_.document().edit(changed, QStringLiteral("options")));
  const char* outdated = "outdated: the run was made with other options";
  EXPECT_TRUE(test::has(hands().banner(), outdated));
  for (const Workspace workspace : {Workspace::kReview, Workspace::kRun}) {
    window_.workspaces().show(workspace);
    ASSERT_TRUE(wait([&] { return bar.verdict().head == QStringLiteral("Validated; outdated"); }));
    EXPECT_TRUE(test::has(bar.text().toLower(), outdated));
  }
  ASSERT_TRUE(window_.document().undo());

  QTest::keyClick(&window_, Qt::Key_F9);
  ASSERT_TRUE(checked());
  moveSeed(0.001);
  EXPECT_FALSE(panel().controller().isCurrent()) << "stale at once";
  EXPECT_TRUE(test::has(listed(), "converged"));
  EXPECT_TRUE(test::has(hands().banner(), "no longer holds: the image, camera, mesh, seed"));
  ASSERT_TRUE(checked());
  hands().passOverAll(QStringLiteral("known"));
  hands().sign(QStringLiteral("Ada"), QStringLiteral("again"));
  EXPECT_FALSE(hands().button("validate")->isEnabled()) << "the run is of the former seed";
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_TRUE(test::has(listed(), "validated")) << "what was judged is back";
  ASSERT_TRUE(window_.document().save());
  ASSERT_TRUE(reopen());
  QTest::keyClick(&window_, Qt::Key_F9);
  ASSERT_TRUE(checked());
  EXPECT_TRUE(test::has(hands().banner(), "Validated by Ada"));
}

}  // namespace
}  // namespace boresight::ui
