// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/workspaces.h"

#include "tests/ui/window_test.h"
#include "tests/ui/workspaces/desk.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/run/close_ups_panel.h"
#include "ui/run/run_controller.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/case_strip.h"
#include "ui/workspaces/job_strip.h"
#include "ui/workspaces/remedies_panel.h"
#include "ui/workspaces/top_bar.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

class WorkspacesTest : public test::WindowTest {
 protected:
  void SetUp() override { openExample(); }
  Workspaces& workspaces() { return window_.workspaces(); }
  bool shows(const char* dock) { return window_.dock(QLatin1String(dock))->isVisible(); }
  void resize(int width, int height) {
    window_.resize(width, height);
    QApplication::processEvents();
  }
  void show(Workspace workspace) {
    workspaces().show(workspace);
    QApplication::processEvents();
  }
};

TEST_F(WorkspacesTest, KeysAndTabsChooseAWorkspace_BarsAreThereInEach) {
  auto& tabs = find<QTabBar>("workspaceTabs");
  for (int i = 0; i < kWorkspaceCount; ++i) {
    QTest::keyClick(&window_, static_cast<Qt::Key>(Qt::Key_1 + i), Qt::ControlModifier);
    EXPECT_EQ(workspaces().current(), static_cast<Workspace>(i));
    EXPECT_EQ(tabs.currentIndex(), i);
    QApplication::processEvents();
    EXPECT_TRUE(window_.frame().verdict().isVisible());
    EXPECT_TRUE(window_.frame().jobs().isVisible());
    EXPECT_TRUE(window_.frame().cases().isVisible());
  }
  tabs.setCurrentIndex(static_cast<int>(Workspace::kDiagnose));
  EXPECT_EQ(workspaces().current(), Workspace::kDiagnose);
}

TEST_F(WorkspacesTest, EachShowsThePanelsOfItsTaskAndThoseAddedToIt) {
  resize(1920, 1080);
  struct Expected {
    Workspace workspace;
    std::vector<const char*> shown;
    std::vector<const char*> hidden;
  };
  const Expected all[] = {
      {Workspace::kRun, {"scene", "closeUps", "result"}, {"queue", "inspector", "annotation"}},
      {Workspace::kDiagnose, {"inspector", "iterations"}, {"queue", "review", "scene"}},
      {Workspace::kAnnotate, {"scene", "annotation"}, {"queue", "review", "inspector"}},
      {Workspace::kReview, {"queue", "review"}, {"configuration", "annotation", "scene"}},
      {Workspace::kOnboard, {"onboard"}, {"annotation", "queue"}},
  };
  for (const Expected& each : all) {
    show(each.workspace);
    for (const char* dock : each.shown)
      EXPECT_TRUE(shows(dock)) << workspaceInfo(each.workspace).name << ": " << dock;
    for (const char* dock : each.hidden)
      EXPECT_FALSE(shows(dock)) << workspaceInfo(each.workspace).name << ": " << dock;
    EXPECT_EQ(window_.frame().cases().isVisible(), each.workspace != Workspace::kReview)
        << "the queue is the list of cases there";
  }
  show(Workspace::kRun);
  window_.dock(QStringLiteral("levels"))->show();
  workspaces().show(Workspace::kDiagnose);
  EXPECT_FALSE(shows("levels"));
  show(Workspace::kRun);
  EXPECT_TRUE(shows("levels"));
}

TEST_F(WorkspacesTest, AClickOnTheWarningsListsThemAndOpensNoPanel) {
  resize(1920, 1080);
  auto& bar = *window_.findChild<VerdictBar*>();
  bar.setWarnings({QStringLiteral("The mesh is not closed."), QStringLiteral("The seed is old.")});
  const QSize canvas = window_.image().view().size();
  find<QPushButton>("warningBadge").click();
  auto* popover = window_.findChild<QFrame*>(QStringLiteral("warningPopover"));
  ASSERT_TRUE(popover && popover->isVisible());
  const auto sentences = popover->findChildren<QLabel*>();
  ASSERT_EQ(sentences.size(), 2);
  EXPECT_EQ(sentences[1]->text(), QStringLiteral("The seed is old."));
  EXPECT_FALSE(shows("inputs"));
  EXPECT_EQ(window_.image().view().size(), canvas);
  popover->findChild<QPushButton*>(QStringLiteral("showInputs"))->click();
  EXPECT_TRUE(shows("inputs"));
}

TEST_F(WorkspacesTest, CloseUpsShowTheRefinedPose_AndAClickShowsThePlaceOnTheCanvas) {
  resize(1920, 1080);
  const auto close_ups = window_.findChildren<CloseUpView*>();
  ASSERT_EQ(close_ups.size(), 4);
  EXPECT_FALSE(close_ups[0]->place());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kFinished; }));
  for (CloseUpView* each : close_ups) {
    ASSERT_TRUE(each->place());
    EXPECT_LT(each->place()->distance_px, 1.0) << each->place()->name;
    EXPECT_GE(each->height(), each->minimumSizeHint().height());
  }
  QTest::mouseClick(close_ups[3], Qt::LeftButton);
  const auto& canvas = find<ImageView>("imageView");
  EXPECT_GE(canvas.transform().scale(), 4.0);
  const QPointF middle = canvas.transform().toPixel(QRectF(canvas.rect()).center());
  EXPECT_LT((middle - pointOf(close_ups[3]->place()->center_px)).manhattanLength(), 3.0);
}

TEST_F(WorkspacesTest, NarrowDiagnose_OpensOneDrawerAtATime) {
  resize(1280, 800);
  show(Workspace::kDiagnose);
  EXPECT_TRUE(shows("inspector"));
  EXPECT_FALSE(shows("iterations"));
  window_.dock(QStringLiteral("iterations"))->toggleViewAction()->trigger();
  QApplication::processEvents();
  EXPECT_TRUE(shows("iterations"));
  EXPECT_FALSE(shows("inspector"));
}

TEST_F(WorkspacesTest, StripShowsAndChoosesCases) {
  auto& list = window_.frame().cases().list();
  EXPECT_EQ(list.model()->rowCount(), 2);
  EXPECT_EQ(list.currentIndex().row(), 0);
  list.setCurrentIndex(list.model()->index(1, 0));
  EXPECT_EQ(window_.cases().caseId(),
            QString::fromStdString(window_.document().session().cases.back()->id));
  ASSERT_TRUE(rests());
}

TEST_F(WorkspacesTest, VerdictRunsTheCaseAndLeadsToReview) {
  VerdictBar& bar = window_.frame().verdict();
  ASSERT_TRUE(wait([&] { return bar.verdict().step == Step::kRun; })) << bar.text().toStdString();
  QTest::mouseClick(&bar.action(), Qt::LeftButton);
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 1 && resting(); }));
  ASSERT_TRUE(wait([&] { return bar.verdict().step == Step::kReview; }))
      << bar.text().toStdString();
  EXPECT_TRUE(test::has(bar.text(), "Converged in"));
  QTest::keyClick(&window_, Qt::Key_Return, Qt::ControlModifier);
  EXPECT_EQ(workspaces().current(), Workspace::kReview);
}

/// Each panel that was opened squeezed those of the workspace.
TEST_F(WorkspacesTest, OpenedPanel_IsATabAndTakesNoRoom) {
  resize(1920, 1080);
  workspaces().show(Workspace::kRun);
  workspaces().arrange();
  QApplication::processEvents();
  const QDockWidget& close_ups = *window_.dock(QStringLiteral("closeUps"));
  const int before_px = close_ups.height();
  window_.dock(QStringLiteral("runs"))->toggleViewAction()->trigger();
  QApplication::processEvents();
  EXPECT_TRUE(shows("runs"));
  EXPECT_NEAR(close_ups.height(), before_px, 2) << "but for rounding";
}

using OwnWindowTest = test::WindowTest;

TEST_F(OwnWindowTest, EmptyWindow_BeginsAtStartAndASessionInRun) {
  EXPECT_EQ(window_.workspaces().current(), Workspace::kStart);
  openExample();
  EXPECT_EQ(window_.workspaces().current(), Workspace::kRun);
  window_.document().close();
  EXPECT_EQ(window_.workspaces().current(), Workspace::kStart);
}

TEST_F(OwnWindowTest, DiagnoseOfAFailedRun_HasWhatMayHelpInFrontAtFullHeight) {
  open(test::Desk::failed().withItsRun(file_));
  ASSERT_TRUE(wait([this] { return window_.state().snapshot() && resting(); }));
  window_.resize(1920, 1080);
  window_.workspaces().show(Workspace::kDiagnose);
  QApplication::processEvents();
  const auto in_front = [this](const char* dock) {
    return !window_.dock(QString::fromLatin1(dock))->visibleRegion().isEmpty();
  };
  for (const CloseUpView* each : window_.findChildren<CloseUpView*>())
    EXPECT_TRUE(!each->place() || each->figureText().endsWith(QStringLiteral(" % found")));
  EXPECT_TRUE(in_front("remedies"));
  EXPECT_FALSE(in_front("inspector"));
  const auto* scroll = window_.findChild<RemediesPanel*>()->findChild<QScrollArea*>();
  EXPECT_EQ(scroll->verticalScrollBar()->maximum(), 0) << "all remedies are in view";
}

TEST(CaseStrip, ListsFailedCasesFirstForDecisionsOnly) {
  CasesModel model;
  std::vector<CaseRow> rows(4);
  const CaseState states[] = {CaseState::kValidated, CaseState::kNew, CaseState::kConverged,
                              CaseState::kFailed};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].id = QString::number(i);
    rows[i].state = states[i];
  }
  model.setRows(rows);
  CaseStrip strip(model);
  const auto ids = [&order = *strip.list().model()] {
    QString all;
    for (int row = 0; row < order.rowCount(); ++row) all += order.index(row, 0).data().toString();
    return all;
  };
  EXPECT_EQ(ids(), QStringLiteral("0123"));
  strip.setForDecisions(true);
  EXPECT_EQ(ids(), QStringLiteral("3210"));
  rows[0].state = CaseState::kFailed;
  model.setRows(rows);
  EXPECT_EQ(ids(), QStringLiteral("0321")) << "equal ones in the session's order";
  strip.setForDecisions(false);
  EXPECT_EQ(ids(), QStringLiteral("0123"));
}

}  // namespace
}  // namespace boresight::ui
