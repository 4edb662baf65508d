// SPDX-License-Identifier: Apache-2.0
// The queue in the window, by its keys; of a results file, too.
#include "ui/review/queue_panel.h"

#include <set>

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_of_results.h"
#include "tests/support/run_batch.h"
#include "tests/ui/review/review_fixture.h"
#include "tests/ui/window_test.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// The example's two cases with their runs, and one of the second that could not converge.
struct RunExample {
  sessions::Session session = test::withoutSearch(test::exampleSession());
  sessions::Session strict;
  std::string good = session.cases[0]->id;
  std::string bad = session.cases[1]->id;
  sessions::LocalizationTrace of_good, of_bad, failed;

  RunExample() {
    session.review.limits = {{"check.focal_percent", 5.0}};  // easy to validate
    of_good = sessions::runCase(session, good);
    of_bad = sessions::runCase(session, bad);
    strict = session;
    strict.options = {{"search.enabled", false},
                      {"pnp.min_inliers", std::int64_t{100}},
                      {"refinement.enabled", false}};
    failed = sessions::runCase(strict, bad);
  }
  static const RunExample& get() {
    static const RunExample example;
    return example;
  }
  sessions::Session withRuns(const std::filesystem::path& file) const {
    sessions::Session next_session = withRun(session, storeRun(session, good, of_good, file));
    next_session = withRun(next_session, storeRun(next_session, bad, of_bad, file));
    return withRun(next_session, storeRun(strict, bad, failed, file));
  }
};

/// The queue, filled, with the worst case shown.
class QueuePanelTest : public test::SharedWindowTest {
 protected:
  using Act = ReviewController::Act;

  void SetUp() override {
    window_.resize(1700, 900);  // with room for the queue and the checks
    queue().setHalted(false);
    field("queueFilter").clear();
    window_.findChild<DecisionForm*>()->forgetName();  // and the drafts of an earlier test
    SharedWindowTest::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
    QTest::keySequence(&window_, QKeySequence(QStringLiteral("Shift+F9")));
    ASSERT_TRUE(table_->hasFocus()) << "the key leads into the list";
    ASSERT_TRUE(checked());
    EXPECT_EQ(panel_->chosenCase(), window_.cases().caseId()) << "the shown case is chosen";
    table_->setCurrentIndex(table_->model()->index(0, 0));
    ASSERT_TRUE(shown(bad_));
  }
  sessions::Session firstSession() override { return RunExample::get().withRuns(file_); }

  QueueController& queue() { return panel_->controller(); }
  bool checked() {
    return wait([&] {
      return queue().count() == 2 && queue().doneCount() == 2 && !window_.tasks().isBusy();
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
  QString cell(int row, int column = QueueModel::kCase) const {
    return test::textAt(*table_, row, column);
  }
  QStringList listed() const {
    QStringList ids;
    for (int row = 0; row < table_->model()->rowCount(); ++row) ids << cell(row);
    return ids;
  }
  QLineEdit& field(const char* name) { return find<QLineEdit>(name); }
  QString reading() { return find<QTextBrowser>("reading").toPlainText(); }
  QString title() { return find<QLabel>("titleChip").text(); }
  void click(const QString& id) {
    const QModelIndex index = table_->model()->index(listed().indexOf(id), QueueModel::kCase);
    QTest::mouseClick(table_->viewport(), Qt::LeftButton, {}, table_->visualRect(index).center());
  }
  /// On whatever has the focus.
  void press(Qt::Key key) { QTest::keyClick(QApplication::focusWidget(), key); }
  void answer(const QString& text) {
    QTest::keyClicks(QApplication::focusWidget(), text);
    press(Qt::Key_Return);
  }
  void goToGood() {
    press(Qt::Key_J);
    ASSERT_TRUE(shown(good_));
  }
  template <class Change>
  void edit(const Change& change) {
    sessions::Session session = window_.document().session();
    change(session);
    ASSERT_TRUE(window_.document().edit(session, QStringLiteral("Change")));
  }
  void requireInliers(double count) {
    edit([count](auto& session) { session.review.limits = {{"check.inlier_count", count}}; });
  }
  const auto& decisions() { return window_.document().session().decisions; }

  QueuePanel* panel_ = window_.findChild<QueuePanel*>();
  QTableView* table_ = panel_->findChild<QTableView*>(QStringLiteral("queue"));
  QString good_ = QString::fromStdString(RunExample::get().good);
  QString bad_ = QString::fromStdString(RunExample::get().bad);
};

TEST_F(QueuePanelTest, Queue_IsFilledInTheBackgroundWorstFirst) {
  EXPECT_EQ(listed(), QStringList({bad_, good_}));
  EXPECT_TRUE(test::has(cell(0, QueueModel::kTrouble), "100"));
  const auto picture = table_->model()->index(0, 0).data(Qt::DecorationRole).value<QIcon>();
  EXPECT_FALSE(picture.isNull());
  EXPECT_EQ(picture.pixmap(64, QIcon::Selected).toImage(), picture.pixmap(64).toImage())
      << "a chosen row does not tint it";
  EXPECT_FALSE(cell(1, QueueModel::kMargin).isEmpty());
  EXPECT_FALSE(cell(1, QueueModel::kFromSeed).isEmpty());
  field("queueFilter").setText(QStringLiteral("failed"));
  EXPECT_EQ(listed(), QStringList({bad_}));
  field("queueFilter").setText(good_);
  EXPECT_EQ(listed(), QStringList({good_}));
  EXPECT_EQ(panel_->chosenCase(), QString()) << "not another one";
  EXPECT_EQ(window_.cases().caseId(), bad_);
  field("queueFilter").clear();
  EXPECT_EQ(panel_->chosenCase(), bad_);
}

TEST_F(QueuePanelTest, EnterOpensTheIterationThatFailed) {
  EXPECT_EQ(panel_->chosenCase(), bad_);
  const auto status = [this] { return window_.state().iteration()->status; };
  press(Qt::Key_Return);
  ASSERT_TRUE(wait([&] {
    return window_.cases().caseId() == bad_ && window_.state().snapshot() &&
           !window_.tasks().isBusy();
  }));
  ASSERT_NE(window_.state().iteration(), nullptr);
  EXPECT_NE(status(), LocalizationStatus::kRunning);
  EXPECT_NE(status(), LocalizationStatus::kConverged);
  window_.state().setCursor({0, Stage::kRender});
  press(Qt::Key_Return);
  EXPECT_NE(status(), LocalizationStatus::kRunning) << "also when the case is shown already";
}

TEST_F(QueuePanelTest, ClickOnARow_ShowsTheCaseItsRunAndItsChecks) {
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
  goToGood();
}

TEST_F(QueuePanelTest, Validation_AsksNameAndReasonAndGoesToTheNextCase) {
  goToGood();
  press(Qt::Key_A);
  EXPECT_TRUE(decisions().empty());
  ASSERT_TRUE(field("decisionName").hasFocus()) << "the name is asked for in every start";
  answer(QStringLiteral("Ada A."));  // letters that are keys in the list
  ASSERT_TRUE(field("decisionComment").hasFocus());
  answer(QStringLiteral("Rather good"));
  ASSERT_EQ(decisions().size(), 1u) << reading().toStdString();
  EXPECT_EQ(decisions()[0].verdict, sessions::Verdict::kValidated);
  EXPECT_EQ(decisions()[0].case_id, good_.toStdString());
  EXPECT_EQ(decisions()[0].by, "Ada A.");
  EXPECT_EQ(decisions()[0].comment, "Rather good");
  EXPECT_TRUE(field("decisionComment").text().isEmpty());
  EXPECT_TRUE(table_->hasFocus());
  ASSERT_TRUE(shown(bad_)) << "the next that is open";
  press(Qt::Key_A);
  answer(QStringLiteral("also"));
  EXPECT_EQ(decisions().size(), 1u) << "a run that failed is not validated";
  EXPECT_TRUE(test::has(reading(), "did not converge"));
}

TEST_F(QueuePanelTest, EscapeLeavesTheQuestion_RejectTakesTheCommentAndIsUndoneAtOnce) {
  press(Qt::Key_R);
  ASSERT_TRUE(field("decisionName").hasFocus());
  press(Qt::Key_Escape);
  EXPECT_TRUE(table_->hasFocus());
  field("decisionName").setFocus();
  answer(QStringLiteral("Ada"));
  EXPECT_TRUE(decisions().empty()) << "nothing was asked";
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

/// Enter did nothing, the list took the focus, and the next letters were its keys.
TEST_F(QueuePanelTest, EnterBeforeTheChecksAreComplete_KeepsTheQuestionAndTheDraft) {
  goToGood();
  press(Qt::Key_A);
  answer(QStringLiteral("Ada"));
  edit([](auto& session) {  // the checks begin again
    session.review.limits.emplace_back("check.inlier_count", 8.0);
  });
  ASSERT_FALSE(review().isCurrent());
  answer(QStringLiteral("fine"));
  EXPECT_TRUE(decisions().empty());
  EXPECT_TRUE(test::has(reading(), "not complete yet"));
  EXPECT_TRUE(field("decisionComment").hasFocus());
  QTest::keyClicks(QApplication::focusWidget(), QStringLiteral(" ok"));
  EXPECT_EQ(window_.cases().caseId(), good_);
  ASSERT_TRUE(shown(good_));
  press(Qt::Key_Return);
  ASSERT_EQ(decisions().size(), 1u) << reading().toStdString();
  EXPECT_EQ(decisions()[0].comment, "fine ok");
}

TEST_F(QueuePanelTest, DraftOfAComment_StaysWithItsCase) {
  field("decisionComment").setText(QStringLiteral("blurred"));
  goToGood();
  EXPECT_TRUE(field("decisionComment").text().isEmpty());
  press(Qt::Key_K);
  ASSERT_TRUE(shown(bad_));
  EXPECT_EQ(field("decisionComment").text(), QStringLiteral("blurred"));
}

TEST_F(QueuePanelTest, CommentTypedWhileACaseIsRead_IsOfThatCase) {
  field("decisionComment").setText(QStringLiteral("of the first"));
  click(good_);
  ASSERT_FALSE(window_.state().currentCase()) << "it is being read";
  field("decisionComment").setText(QStringLiteral("typed at once"));
  ASSERT_TRUE(shown(good_));
  EXPECT_EQ(field("decisionComment").text(), QStringLiteral("typed at once"));
  press(Qt::Key_K);
  ASSERT_TRUE(shown(bad_));
  EXPECT_EQ(field("decisionComment").text(), QStringLiteral("of the first"));
}

TEST_F(QueuePanelTest, DecisionThatHolds_IsOverruledOnlyByTheSecondRequest) {
  goToGood();
  press(Qt::Key_A);
  answer(QStringLiteral("Ada"));
  answer(QStringLiteral("good"));
  ASSERT_EQ(decisions().size(), 1u) << reading().toStdString();
  ASSERT_TRUE(shown(bad_));
  click(good_);
  ASSERT_TRUE(shown(good_));
  table_->setFocus();
  press(Qt::Key_R);
  answer(QStringLiteral("blurred"));
  EXPECT_EQ(decisions().size(), 1u);
  EXPECT_TRUE(test::has(reading(), "decision by Ada"));
  press(Qt::Key_Return);
  ASSERT_EQ(decisions().size(), 2u);
  EXPECT_EQ(decisions()[1].verdict, sessions::Verdict::kRejected);
}

/// The window's Escape, which stops jobs, was first.
TEST_F(QueuePanelTest, EscapeInAQuestion_StopsNoJob) {
  press(Qt::Key_R);
  ASSERT_TRUE(field("decisionName").hasFocus());
  QKeyEvent escape(QEvent::ShortcutOverride, Qt::Key_Escape, Qt::NoModifier);
  escape.ignore();
  QCoreApplication::sendEvent(&field("decisionName"), &escape);
  EXPECT_TRUE(escape.isAccepted());
  press(Qt::Key_Escape);
  EXPECT_TRUE(table_->hasFocus());
}

TEST_F(QueuePanelTest, CaseThatIsStillReadOrShowsAnotherRun_IsNotDecided) {
  const auto obstacle = [this](Act act) { return review().obstacle(act, {"Ada", "blurred"}); };
  EXPECT_EQ(obstacle(Act::kReject), QString());
  click(good_);
  EXPECT_EQ(review().caseId(), "") << "no case is shown until this one is read";
  EXPECT_TRUE(test::has(obstacle(Act::kReject), "still being read"));
  EXPECT_FALSE(review().decide(Act::kReject, {"Ada", "blurred"}));
  ASSERT_TRUE(shown(good_));
  EXPECT_EQ(obstacle(Act::kReject), QString());
  const auto shown_before = window_.state().snapshot();
  window_.state().setSnapshot(
      std::make_shared<sessions::LocalizationTrace>(RunExample::get().failed));
  for (const Act act : {Act::kValidate, Act::kReject})
    EXPECT_TRUE(test::has(obstacle(act), "shows another run"));
  window_.state().setSnapshot(nullptr);
  for (const Act act : {Act::kValidate, Act::kReject})
    EXPECT_TRUE(test::has(obstacle(act), "shows no run"));
  window_.state().setMissingRun({shown_before->digest, QStringLiteral("It is gone.")});
  EXPECT_EQ(obstacle(Act::kReject), QString()) << "the window reports that it cannot be shown";
  window_.state().setSnapshot(shown_before);
}

TEST_F(QueuePanelTest, RunThatIsNotShown_IsNeitherApprovedNorRejectedWithItsAnnotation) {
  goToGood();
  edit([](auto& session) { session.review.second_person = true; });
  ASSERT_TRUE(shown(good_));
  ASSERT_TRUE(review().decide(Act::kValidate, {"Ada", "good"}));
  const auto obstacle = [this](Act act) { return review().obstacle(act, {"Bob", "so it is"}); };
  EXPECT_EQ(obstacle(Act::kApprove), QString());
  const auto shown_before = window_.state().snapshot();
  const auto other = std::make_shared<sessions::LocalizationTrace>(RunExample::get().failed);
  for (const auto& unseen : {ViewState::SnapshotPtr(other), ViewState::SnapshotPtr()}) {
    window_.state().setSnapshot(unseen);
    EXPECT_TRUE(test::has(obstacle(Act::kApprove), unseen ? "shows another run" : "shows no run"));
    EXPECT_FALSE(review().decide(Act::kApprove, {"Bob", "so it is"}));
    EXPECT_EQ(obstacle(Act::kTakeBack), QString()) << "it asks for no look at the run";
  }
  window_.state().setMissingRun({shown_before->digest, QStringLiteral("It is gone.")});
  EXPECT_TRUE(test::has(obstacle(Act::kApprove), "shows no run")) << "only reported";
  EXPECT_FALSE(review().decide(Act::kApprove, {"Bob", "so it is"}));
  EXPECT_EQ(obstacle(Act::kReject), QString());
  window_.state().setSnapshot(shown_before);
  edit([this](auto& session) {
    session.decisions.clear();
    sessions::Annotations annotations;
    annotations.points.emplace_back().id = "p1";
    session = sessions::withAnnotations(session, good_.toStdString(), annotations);
  });
  review().setSource(sessions::PoseSource::kAnnotation);
  ASSERT_EQ(review().source(), sessions::PoseSource::kAnnotation);
  EXPECT_EQ(obstacle(Act::kReject), QString());
  window_.state().setSnapshot(other);
  EXPECT_TRUE(test::has(obstacle(Act::kReject), "shows another run"));
  window_.state().setSnapshot(shown_before);
}

TEST_F(QueuePanelTest, RunThatEndsWhileTheReasonIsTyped_IsNotDecidedOnByTheAnswer) {
  press(Qt::Key_R);
  answer(QStringLiteral("Ada"));
  ASSERT_TRUE(field("decisionComment").hasFocus());
  edit([](sessions::Session& session) {  // as if the run before were the one that has ended
    session.runs.eraseIf([](const sessions::RunRecord& run) {
      return run.digest == RunExample::get().failed.digest;
    });
  });
  window_.state().setSnapshot(
      std::make_shared<sessions::LocalizationTrace>(RunExample::get().of_bad));
  ASSERT_EQ(review().obstacle(Act::kReject, {"Ada", "blurred"}), QString());
  answer(QStringLiteral("blurred"));
  EXPECT_TRUE(decisions().empty());
  EXPECT_TRUE(test::has(reading(), "Another run"));
  EXPECT_TRUE(field("decisionComment").hasFocus());
  press(Qt::Key_Return);
  ASSERT_EQ(decisions().size(), 1u) << reading().toStdString();
  EXPECT_EQ(decisions()[0].digest, RunExample::get().of_bad.digest);
}

TEST_F(QueuePanelTest, ChangedOptions_AreCalledOutdatedInListAndBadge) {
  goToGood();
  ASSERT_TRUE(review().decide(Act::kValidate, {"Ada", "good"}));
  EXPECT_EQ(cell(1, QueueModel::kStatus), QStringLiteral("★ validated"));
  edit([](auto& session) { session.options = {{"pnp.min_inliers", std::int64_t{20}}}; });
  EXPECT_EQ(cell(1, QueueModel::kStatus), QStringLiteral("★ validated, outdated"));
  EXPECT_TRUE(test::has(test::textAt(find<QTableView>("cases"), 0, 1), "validated, outdated"));
}

TEST_F(QueuePanelTest, ChangedInputs_CheckTheRowAgainUnlessHaltedOrOutOfSight) {
  requireInliers(9999.0);
  EXPECT_EQ(queue().doneCount(), 0);
  ASSERT_TRUE(checked());
  EXPECT_TRUE(test::has(cell(1, QueueModel::kTrouble), "nlier"));
  queue().setHalted(true);
  requireInliers(13.0);
  EXPECT_FALSE(queue().isBusy());
  QTest::keyClick(&window_, Qt::Key_2, Qt::ControlModifier);  // another workspace
  const QWidget* dock = window_.dock(QStringLiteral("queue"));
  ASSERT_TRUE(wait([&] { return dock->visibleRegion().isEmpty(); }));
  queue().setHalted(false);
  EXPECT_FALSE(queue().isBusy());
  QTest::keyClick(&window_, Qt::Key_5, Qt::ControlModifier);
  EXPECT_TRUE(checked());
}

/// Every row was made again for each edit, on the window's thread.
TEST_F(QueuePanelTest, EditOfOneCase_ChangesItsRowAlone) {
  auto& filter = *qobject_cast<QSortFilterProxyModel*>(table_->model());
  auto& cases = *qobject_cast<QSortFilterProxyModel*>(find<QTableView>("cases").model());
  std::set<int> queue_rows, case_rows;
  QObject owner;
  const auto note = [&owner](QAbstractItemModel& model, std::set<int>& rows) {
    QObject::connect(&model, &QAbstractItemModel::dataChanged, &owner,
                     [&rows](const QModelIndex& from, const QModelIndex& to) {
                       for (int row = from.row(); row <= to.row(); ++row) rows.insert(row);
                     });
  };
  note(*filter.sourceModel(), queue_rows);
  note(*cases.sourceModel(), case_rows);
  edit([this](sessions::Session& session) {
    session = sessions::withChanged(session, good_.toStdString(), [](auto& changed) {
      changed.camera_from_station_seed.translation_m.x() += 1e-6;
    });
  });
  ASSERT_TRUE(checked());
  EXPECT_EQ(queue_rows.size(), 1u);
  EXPECT_EQ(case_rows.size(), 1u);
}

TEST_F(QueuePanelTest, RowsKeepTheirPlacesWhileThePointerIsOnThem) {
  ASSERT_EQ(cell(0), bad_);
  QEnterEvent enter(QPointF(5.0, 5.0), QPointF(5.0, 5.0), QPointF(5.0, 5.0));
  QCoreApplication::sendEvent(table_, &enter);
  edit([](sessions::Session& session) {
    session.runs.eraseIf(
        [](const sessions::RunRecord& run) { return run.case_id == RunExample::get().bad; });
  });
  ASSERT_TRUE(checked());
  EXPECT_EQ(cell(0), bad_) << "it is no longer the worst";
  QEvent leave(QEvent::Leave);
  QCoreApplication::sendEvent(table_, &leave);
  EXPECT_NE(cell(0), bad_);
}

TEST_F(QueuePanelTest, ComparesTheLastTwoRuns) {
  press(Qt::Key_D);
  auto& table = find<QTableView>("differences");
  ASSERT_TRUE(table.hasFocus());
  ASSERT_TRUE(wait([&] { return queue().doneCount() == 1; }));
  ASSERT_EQ(table.model()->rowCount(), 1) << "the other case has one run";
  EXPECT_EQ(test::textAt(table, 0, DifferencesModel::kCase), bad_);
  EXPECT_TRUE(test::has(test::textAt(table, 0, DifferencesModel::kChange), "worse"));
  EXPECT_TRUE(test::has(test::textAt(table, 0, DifferencesModel::kWhy), "pnp.min_inliers"));
  press(Qt::Key_D);
  EXPECT_TRUE(table_->hasFocus());
}

/// A results file in the window: the example, each case from two seeds, by options under which none
/// converges.
class ResultsQueueTest : public test::WindowTest {
 protected:
  ~ResultsQueueTest() override {
    const auto file = window_.document().file();
    window_.document().close();
    std::filesystem::remove(file);
  }
};

TEST_F(ResultsQueueTest, RunsAreListedChosenAndRepeatedToTheBit_NoResultsAreReported) {
  const auto dataset = sessions::readDataset(test::smallExampleFolder() / "dataset.json");
  sessions::BatchOptions options;
  options.localizer = defaultProfile();
  options.localizer.search.enabled = false;
  options.localizer.loop.max_iterations = 1;
  options.reseeds = 1;
  const std::vector<sessions::RunResult> runs = test::runBatch(dataset, options, {});
  const std::filesystem::path results = folder_ / "results.sqlite";
  {
    sessions::ResultsWriter writer(results, sessions::datasetFacts(dataset));
    writer.admit(sessions::methodFacts("whs", "default", options.localizer));
    writer.begin(sessions::BatchRun{});
    for (const sessions::RunResult& run : runs) writer.add(run);
  }
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  drop(folder_.write("no.sqlite", "no"));
  ASSERT_TRUE(wait([&] { return resting() && !window_.lastMessage().isEmpty(); }));
  EXPECT_TRUE(test::has(window_.lastMessage(), "no.sqlite"));
  EXPECT_FALSE(window_.document().isOpen());

  drop(results);
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() != nullptr && resting(); }))
      << window_.lastMessage().toStdString();
  EXPECT_EQ(window_.document().session().cases.size(), 4u);
  EXPECT_FALSE(window_.dock(QStringLiteral("queue"))->visibleRegion().isEmpty())
      << "the queue comes to the front";
  auto& table = find<QTableView>("queue");
  ASSERT_TRUE(wait([&] { return table.model()->rowCount() == 4 && resting(); }));
  // The rows are there at once, what they say once the queue has been gone through.
  const auto trouble = [&table] { return test::textAt(table, 3, QueueModel::kTrouble); };
  ASSERT_TRUE(wait([&] {
    return trouble().contains(QStringLiteral("iteration_limit")) && resting();
  })) << trouble().toStdString();
  const QModelIndex last = table.model()->index(3, 0);
  table.setFocus();
  table.setCurrentIndex(last);
  QTest::keyClick(&table, Qt::Key_Return);
  const QString id = last.data().toString();
  ASSERT_TRUE(wait([&] { return window_.cases().caseId() == id && resting(); }));
  QTest::keyClick(&window_, Qt::Key_F5);
  const auto lastRun = [&] { return window_.document().session().lastRunOf(id.toStdString()); };
  ASSERT_TRUE(wait([&] { return lastRun() != nullptr && resting(); }));
  const auto run = std::ranges::find(runs, id.toStdString(), sessions::resultCaseId);
  ASSERT_NE(run, runs.end());
  EXPECT_EQ(lastRun()->digest, run->digest);
}

}  // namespace
}  // namespace boresight::ui
