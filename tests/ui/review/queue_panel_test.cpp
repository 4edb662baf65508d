// SPDX-License-Identifier: Apache-2.0
// The queue in the window, by its keys; of a results file, too.
#include "ui/review/queue_panel.h"

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_of_results.h"
#include "tests/ui/window_test.h"
#include "ui/review/review_panel.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// The example's two cases with their runs, and one of the second that could not converge.
struct RunExample {
  sessions::Session session = easyToValidate();
  std::string good = session.cases[0]->id;
  std::string bad = session.cases[1]->id;
  sessions::LocalizationTrace of_good = sessions::runCase(session, good);
  sessions::LocalizationTrace of_bad = sessions::runCase(session, bad);
  sessions::Session strict = strictSession();
  sessions::LocalizationTrace failed = sessions::runCase(strict, bad);

  static const RunExample& get() {
    static const RunExample example;
    return example;
  }
  static sessions::Session easyToValidate() {
    sessions::Session easy = test::withoutSearch(test::exampleSession());
    easy.review.limits = {{"check.focal_percent", 5.0}};
    return easy;
  }
  sessions::Session strictSession() const {
    sessions::Session next_session = session;
    next_session.options = {{"search.enabled", false},
                            {"pnp.min_inliers", std::int64_t{100}},
                            {"refinement.enabled", false}};
    return next_session;
  }
  sessions::Session withRuns(const std::filesystem::path& file) const {
    sessions::Session next_session = withRun(session, storeRun(session, good, of_good, file));
    next_session = withRun(next_session, storeRun(next_session, bad, of_bad, file));
    return withRun(next_session, storeRun(strict, bad, failed, file));
  }
};

class QueuePanelTest : public test::SharedWindowTest {
 protected:
  void SetUp() override {
    window_.resize(1700, 900);  // with room for the queue and the checks
    panel_->controller().setHalted(false);
    for (const char* name : {"queueFilter", "decisionName", "decisionComment"}) field(name).clear();
    SharedWindowTest::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
    QTest::keySequence(&window_, QKeySequence(QStringLiteral("Shift+F9")));
  }
  sessions::Session firstSession() override { return RunExample::get().withRuns(file_); }

  bool checked() {
    return wait([&] {
      const QueueController& queue = panel_->controller();
      return queue.count() == 2 && queue.doneCount() == 2 && !window_.tasks().isBusy();
    });
  }
  ReviewController& review() { return window_.findChild<ReviewPanel*>()->controller(); }
  /// The case is on the screen, and its checks are complete.
  bool shown(const QString& id) {
    return wait([&] {
      return window_.cases().caseId() == id && review().caseId() == id.toStdString() &&
             review().isCurrent() && !review().isBusy() && resting();
    });
  }
  /// The first time the operator goes to the worst case.
  bool filled() {
    if (!checked()) return false;
    if (std::exchange(at_worst_, true)) return true;
    table_->setCurrentIndex(table_->model()->index(0, 0));
    return shown(bad_);
  }
  bool inSight() const { return !window_.dock(QStringLiteral("queue"))->visibleRegion().isEmpty(); }
  QStringList listed() const {
    QStringList ids;
    for (int row = 0; row < table_->model()->rowCount(); ++row)
      ids << table_->model()->index(row, QueueModel::kCase).data().toString();
    return ids;
  }
  QLineEdit& field(const char* name) const {
    return *window_.findChild<QLineEdit*>(QLatin1String(name));
  }
  QString reading() const {
    return window_.findChild<QTextBrowser*>(QStringLiteral("reading"))->toPlainText();
  }
  QString title() const { return window_.findChild<QLabel*>(QStringLiteral("titleChip"))->text(); }
  void click(const QString& id) {
    for (int row = 0; row < table_->model()->rowCount(); ++row) {
      const QModelIndex index = table_->model()->index(row, QueueModel::kCase);
      if (index.data().toString() == id)
        QTest::mouseClick(table_->viewport(), Qt::LeftButton, {},
                          table_->visualRect(index).center());
    }
  }
  /// On whatever has the focus.
  void press(Qt::Key key) { QTest::keyClick(QApplication::focusWidget(), key); }
  void type(const QString& text) { QTest::keyClicks(QApplication::focusWidget(), text); }
  const auto& decisions() { return window_.document().session().decisions; }

  bool at_worst_ = false;
  QueuePanel* panel_ = window_.findChild<QueuePanel*>();
  QTableView* table_ = panel_->findChild<QTableView*>(QStringLiteral("queue"));
  QString good_ = QString::fromStdString(RunExample::get().good);
  QString bad_ = QString::fromStdString(RunExample::get().bad);
};

TEST_F(QueuePanelTest, Queue_IsFilledInTheBackgroundWorstFirst) {
  ASSERT_TRUE(table_->hasFocus()) << "the key leads into the list";
  ASSERT_TRUE(filled());
  EXPECT_EQ(listed(), QStringList({bad_, good_}));
  const QModelIndex first = table_->model()->index(0, 0);
  EXPECT_TRUE(test::has(first.siblingAtColumn(QueueModel::kTrouble).data().toString(), "100"));
  EXPECT_FALSE(first.data(Qt::DecorationRole).isNull()) << "a picture";
  const auto picture = first.data(Qt::DecorationRole).value<QIcon>();
  EXPECT_EQ(picture.pixmap(64, QIcon::Selected).toImage(), picture.pixmap(64).toImage())
      << "a chosen row does not tint it";
  const QModelIndex second = table_->model()->index(1, 0);
  EXPECT_FALSE(second.siblingAtColumn(QueueModel::kMargin).data().toString().isEmpty());
  EXPECT_FALSE(second.siblingAtColumn(QueueModel::kFromSeed).data().toString().isEmpty());
  field("queueFilter").setText(QStringLiteral("failed"));
  EXPECT_EQ(listed(), QStringList({bad_}));
}

TEST_F(QueuePanelTest, OpensWithTheShownCaseChosen) {
  ASSERT_TRUE(checked());
  EXPECT_EQ(panel_->chosenCase(), window_.cases().caseId());
}

TEST_F(QueuePanelTest, EnterOpensTheIterationThatFailed) {
  ASSERT_TRUE(filled());
  EXPECT_EQ(panel_->chosenCase(), bad_);
  press(Qt::Key_Return);
  ASSERT_TRUE(wait([&] {
    return window_.cases().caseId() == bad_ && window_.state().snapshot() &&
           !window_.tasks().isBusy();
  }));
  ASSERT_NE(window_.state().iteration(), nullptr);
  EXPECT_NE(window_.state().iteration()->status, LocalizationStatus::kRunning);
  EXPECT_NE(window_.state().iteration()->status, LocalizationStatus::kConverged);
  window_.state().setCursor({0, Stage::kRender});
  press(Qt::Key_Return);
  EXPECT_NE(window_.state().iteration()->status, LocalizationStatus::kRunning)
      << "also when the case is shown already";
}

TEST_F(QueuePanelTest, ClickOnARow_ShowsTheCaseItsRunAndItsChecks) {
  ASSERT_TRUE(filled());
  EXPECT_TRUE(test::has(title(), bad_.toUtf8())) << "the image says whose it is";
  EXPECT_TRUE(test::has(title(), "run 2 of 2, no result"));
  click(good_);
  ASSERT_TRUE(shown(good_));
  EXPECT_EQ(panel_->chosenCase(), good_);
  EXPECT_EQ(window_.state().currentCase()->source.id, good_.toStdString());
  EXPECT_TRUE(test::has(title(), good_.toUtf8()));
  EXPECT_TRUE(test::has(title(), "run 1 of 1, converged"));
  table_->setFocus();
  press(Qt::Key_K);
  ASSERT_TRUE(shown(bad_));
  press(Qt::Key_J);
  ASSERT_TRUE(shown(good_));
}

TEST_F(QueuePanelTest, FilterWithoutTheShownCase_ShowsNoOther) {
  ASSERT_TRUE(filled());
  auto& filter = field("queueFilter");
  filter.setText(good_);
  EXPECT_EQ(listed(), QStringList({good_}));
  EXPECT_EQ(panel_->chosenCase(), QString());
  EXPECT_EQ(window_.cases().caseId(), bad_);
  filter.clear();
  EXPECT_EQ(panel_->chosenCase(), bad_);
}

TEST_F(QueuePanelTest, Validation_AsksNameAndReasonAndGoesToTheNextCase) {
  ASSERT_TRUE(filled());
  press(Qt::Key_J);
  ASSERT_TRUE(shown(good_));
  press(Qt::Key_A);
  EXPECT_TRUE(decisions().empty());
  ASSERT_TRUE(field("decisionName").hasFocus()) << "the name is asked for in every start";
  type(QStringLiteral("Ada A."));  // letters that are keys in the list
  press(Qt::Key_Return);
  ASSERT_TRUE(field("decisionComment").hasFocus());
  type(QStringLiteral("Rather good"));
  press(Qt::Key_Return);
  ASSERT_EQ(decisions().size(), 1u) << reading().toStdString();
  EXPECT_EQ(decisions()[0].verdict, sessions::Verdict::kValidated);
  EXPECT_EQ(decisions()[0].case_id, good_.toStdString());
  EXPECT_EQ(decisions()[0].by, "Ada A.");
  EXPECT_EQ(decisions()[0].comment, "Rather good");
  EXPECT_TRUE(field("decisionComment").text().isEmpty());
  EXPECT_TRUE(table_->hasFocus());
  ASSERT_TRUE(shown(bad_)) << "the next that is open";
  press(Qt::Key_A);
  type(QStringLiteral("also"));
  press(Qt::Key_Return);
  EXPECT_EQ(decisions().size(), 1u) << "a run that failed is not validated";
  EXPECT_TRUE(test::has(reading(), "did not converge"));
}

TEST_F(QueuePanelTest, RejectTakesTheCommentAndIsUndoneAtOnce) {
  ASSERT_TRUE(filled());
  field("decisionName").setText(QStringLiteral("Ada"));
  field("decisionComment").setText(QStringLiteral("blurred"));
  table_->setFocus();
  press(Qt::Key_R);
  ASSERT_EQ(decisions().size(), 1u);
  EXPECT_EQ(decisions()[0].verdict, sessions::Verdict::kRejected);
  EXPECT_EQ(decisions()[0].case_id, bad_.toStdString());
  EXPECT_EQ(decisions()[0].comment, "blurred");
  EXPECT_FALSE(decisions()[0].checks.empty()) << "what was checked is kept";
  EXPECT_TRUE(field("decisionComment").text().isEmpty());
  ASSERT_TRUE(shown(good_));
  EXPECT_EQ(listed(), QStringList({good_, bad_})) << "what is decided comes last";
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_TRUE(decisions().empty());
  EXPECT_EQ(listed(), QStringList({bad_, good_}));
}

TEST_F(QueuePanelTest, EscapeLeavesTheQuestion) {
  ASSERT_TRUE(filled());
  press(Qt::Key_R);
  ASSERT_TRUE(field("decisionName").hasFocus());
  press(Qt::Key_Escape);
  EXPECT_TRUE(table_->hasFocus());
  field("decisionName").setFocus();
  type(QStringLiteral("Ada"));
  press(Qt::Key_Return);
  EXPECT_TRUE(decisions().empty()) << "nothing was asked";
}

TEST_F(QueuePanelTest, CaseThatIsStillRead_IsNotDecided) {
  ASSERT_TRUE(filled());
  const ReviewController::Act reject = ReviewController::Act::kReject;
  EXPECT_EQ(review().obstacle(reject, {"Ada", "blurred"}), QString());
  click(good_);  // the image is still that of the other case
  EXPECT_EQ(review().caseId(), bad_.toStdString());
  EXPECT_TRUE(test::has(review().obstacle(reject, {"Ada", "blurred"}), "still being read"));
  EXPECT_FALSE(review().decide(reject, {"Ada", "blurred"}));
  ASSERT_TRUE(shown(good_));
  EXPECT_EQ(review().obstacle(reject, {"Ada", "blurred"}), QString());
}

TEST_F(QueuePanelTest, AnotherRunOnTheScreen_IsNotValidated) {
  ASSERT_TRUE(filled());
  press(Qt::Key_J);
  ASSERT_TRUE(shown(good_));
  auto other = std::make_shared<sessions::LocalizationTrace>(RunExample::get().failed);
  const auto shown_before = window_.state().snapshot();
  window_.state().setSnapshot(other);
  const auto validate = ReviewController::Act::kValidate;
  EXPECT_TRUE(test::has(review().obstacle(validate, {"Ada", "good"}), "shows another run"));
  window_.state().setSnapshot(shown_before);
}

TEST_F(QueuePanelTest, ChangedOptions_AreCalledOutdatedInListAndBadge) {
  ASSERT_TRUE(filled());
  press(Qt::Key_J);
  ASSERT_TRUE(shown(good_));
  ASSERT_TRUE(review().decide(ReviewController::Act::kValidate, {"Ada", "good"}));
  const auto state = [this] {
    const QModelIndex row = table_->model()->index(1, 0);
    return row.siblingAtColumn(QueueModel::kStatus).data().toString();
  };
  EXPECT_EQ(state(), QStringLiteral("★ validated"));
  sessions::Session changed = window_.document().session();
  changed.options = {{"pnp.min_inliers", std::int64_t{20}}};
  ASSERT_TRUE(window_.document().edit(changed, QStringLiteral("options")));
  EXPECT_EQ(state(), QStringLiteral("★ validated, outdated"));
  const auto* cases = window_.findChild<QTableView*>(QStringLiteral("cases"));
  EXPECT_TRUE(test::has(cases->model()->index(0, 1).data().toString(), "validated, outdated"));
}

TEST_F(QueuePanelTest, ChangedInputs_ChecksTheRowAgain) {
  ASSERT_TRUE(filled());
  sessions::Session changed = window_.document().session();
  changed.review.limits = {{"check.inlier_count", 9999.0}};
  ASSERT_TRUE(window_.document().edit(changed, QStringLiteral("limits")));
  EXPECT_EQ(panel_->controller().doneCount(), 0);
  ASSERT_TRUE(checked());
  const QModelIndex row = table_->model()->index(1, QueueModel::kTrouble);
  EXPECT_TRUE(test::has(row.data().toString(), "nlier"));
}

TEST_F(QueuePanelTest, IsNotFilledWhileHaltedOrOutOfSight) {
  ASSERT_TRUE(filled());
  panel_->controller().setHalted(true);
  sessions::Session changed = window_.document().session();
  changed.review.limits = {{"check.inlier_count", 13.0}};
  ASSERT_TRUE(window_.document().edit(changed, QStringLiteral("limits")));
  EXPECT_FALSE(panel_->controller().isBusy());
  QTest::keyClick(&window_, Qt::Key_2, Qt::ControlModifier);  // another workspace
  ASSERT_TRUE(wait([&] { return !inSight(); }));
  panel_->controller().setHalted(false);
  EXPECT_FALSE(panel_->controller().isBusy());
  QTest::keyClick(&window_, Qt::Key_5, Qt::ControlModifier);
  EXPECT_TRUE(filled());
}

TEST_F(QueuePanelTest, RowsKeepTheirPlacesWhileThePointerIsOnThem) {
  ASSERT_TRUE(checked());
  const auto first = [this] {
    return table_->model()->index(0, QueueModel::kCase).data().toString();
  };
  ASSERT_EQ(first(), bad_);
  QEnterEvent enter(QPointF(5.0, 5.0), QPointF(5.0, 5.0), QPointF(5.0, 5.0));
  QCoreApplication::sendEvent(table_, &enter);
  sessions::Session session = window_.document().session();
  session.runs.eraseIf(
      [](const sessions::RunRecord& run) { return run.case_id == RunExample::get().bad; });
  ASSERT_TRUE(window_.document().edit(session, QStringLiteral("Drop the failed case's runs")));
  ASSERT_TRUE(checked());
  EXPECT_EQ(first(), bad_) << "it is no longer the worst";
  QEvent leave(QEvent::Leave);
  QCoreApplication::sendEvent(table_, &leave);
  EXPECT_NE(first(), bad_);
}

TEST_F(QueuePanelTest, ComparesTheLastTwoRuns) {
  ASSERT_TRUE(filled());
  press(Qt::Key_D);
  auto* table = panel_->findChild<QTableView*>(QStringLiteral("differences"));
  ASSERT_TRUE(table->hasFocus());
  ASSERT_TRUE(wait([&] { return panel_->controller().doneCount() == 1; }));
  ASSERT_EQ(table->model()->rowCount(), 1) << "the other case has one run";
  const QModelIndex row = table->model()->index(0, DifferencesModel::kCase);
  EXPECT_EQ(row.data().toString(), bad_);
  EXPECT_TRUE(row.siblingAtColumn(DifferencesModel::kChange)
                  .data()
                  .toString()
                  .contains(QStringLiteral("worse")));
  EXPECT_TRUE(row.siblingAtColumn(DifferencesModel::kWhy)
                  .data()
                  .toString()
                  .contains(QStringLiteral("pnp.min_inliers")));
  press(Qt::Key_D);
  EXPECT_TRUE(table_->hasFocus());
}

/// A results file in the window: the example, each case from two seeds, by options under which none
/// converges.
class ResultsQueueTest : public test::WindowTest {
 protected:
  ResultsQueueTest() {
    writeResults();
    window_.activateWindow();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&window_));
  }
  ~ResultsQueueTest() override {
    const auto file = window_.document().file();
    window_.document().close();
    std::filesystem::remove(file);
  }

  void writeResults() {
    const std::filesystem::path dataset = test::smallExampleFolder() / "dataset.json";
    sessions::BatchOptions options;
    options.localizer = defaultProfile();
    options.localizer.search.enabled = false;
    options.localizer.loop.max_iterations = 1;
    options.reseeds = 1;
    runs_ = sessions::runBatch(sessions::readDataset(dataset), options, {});
    sessions::ResultsWriter writer(results_,
                                   sessions::datasetFacts(sessions::readDataset(dataset)));
    writer.admit(sessions::methodFacts("whs", "default", options.localizer));
    writer.begin(sessions::BatchRun{});
    for (const sessions::RunResult& run : runs_) writer.add(run);
  }
  std::filesystem::path results_ = folder_.path() / "results.sqlite";
  std::vector<sessions::RunResult> runs_;
};

TEST_F(ResultsQueueTest, RunsAreListedChosenAndRepeatedToTheBit) {
  drop(results_);
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() != nullptr && resting(); }))
      << window_.lastMessage().toStdString();
  EXPECT_EQ(window_.document().session().cases.size(), 4u);
  EXPECT_FALSE(window_.dock(QStringLiteral("queue"))->visibleRegion().isEmpty())
      << "the queue comes to the front";
  auto* panel = window_.findChild<QueuePanel*>();
  auto* table = panel->findChild<QTableView*>(QStringLiteral("queue"));
  ASSERT_TRUE(wait([&] { return table->model()->rowCount() == 4 && resting(); }));
  const auto trouble = [table] {
    return table->model()->index(3, QueueModel::kTrouble).data().toString();
  };
  // The rows are there at once, what they say once the queue has been gone through.
  ASSERT_TRUE(wait([&] {
    return trouble().contains(QStringLiteral("iteration_limit")) && resting();
  })) << trouble().toStdString();
  const QModelIndex last = table->model()->index(3, 0);
  table->setFocus();
  table->setCurrentIndex(last);
  QTest::keyClick(table, Qt::Key_Return);
  ASSERT_TRUE(
      wait([&] { return window_.cases().caseId() == last.data().toString() && resting(); }));
  QTest::keyClick(&window_, Qt::Key_F5);
  const std::string id = last.data().toString().toStdString();
  ASSERT_TRUE(
      wait([&] { return window_.document().session().lastRunOf(id) != nullptr && resting(); }));
  for (const sessions::RunResult& run : runs_) {
    if (sessions::resultCaseId(run) != id) continue;
    EXPECT_EQ(window_.document().session().lastRunOf(id)->digest, run.digest);
  }
}

using NoResultsFileTest = test::WindowTest;

TEST_F(NoResultsFileTest, IsReportedAndTheSessionStays) {
  folder_.write("no.sqlite", "no");
  drop(folder_.path() / "no.sqlite");
  ASSERT_TRUE(wait([&] { return resting() && !window_.lastMessage().isEmpty(); }));
  EXPECT_TRUE(test::has(window_.lastMessage(), "no.sqlite"));
  EXPECT_FALSE(window_.document().isOpen());
}

}  // namespace
}  // namespace boresight::ui
