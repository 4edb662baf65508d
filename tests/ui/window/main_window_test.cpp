// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <QtWidgets>

#include "sessions/session/case_run.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/models/text.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/measure_tool.h"
#include "ui/window/case_menu.h"
#include "ui/window/main_window.h"
#include "ui/window/shortcut_sheet.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

class MainWindowTest : public test::WindowTest {
 protected:
  QAction* key(const char* keys) {
    for (QAction* each : window_.findChildren<QAction*>())
      if (each->shortcut() == QKeySequence(QLatin1String(keys))) return each;
    ADD_FAILURE() << "no action has the key " << keys;
    return nullptr;
  }
  QString runState() { return find<QLabel>("runState").text(); }
  const sessions::Session& session() { return window_.document().session(); }
  bool becomes(RunState state) {
    return wait([this, state] { return window_.run().state() == state; });
  }
  bool batchEnds() {
    return wait([this] { return !window_.cases().batch() && resting(); });
  }
  void runAll() {
    key("Ctrl+F5")->trigger();
    ASSERT_TRUE(batchEnds());
  }
};

TEST_F(MainWindowTest, EmptyWindow_DisablesUnavailableActions) {
  EXPECT_FALSE(window_.image().view().grab().isNull());
  EXPECT_EQ(window_.state().currentCase(), nullptr);
  QTest::keyClick(&window_, Qt::Key_F5);
  EXPECT_EQ(window_.run().state(), RunState::kEmpty);
}

TEST_F(MainWindowTest, ADroppedDatasetIsShown) {
  drop(test::exampleFolder() / "dataset.json");
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() != nullptr; }));
  EXPECT_TRUE(window_.document().isUntitled());
  EXPECT_EQ(session().cases.size(), 2u);
  const auto file = window_.document().file();
  window_.document().close();
  std::filesystem::remove(file);
}

/// Otherwise the camera of a case that could not be made would quietly become the next one's.
TEST_F(MainWindowTest, ADropThatFailedIsNotPartOfTheNextCase) {
  const std::filesystem::path os = test::exampleFolder() / "os";
  const auto bad = folder_.write("bad.png", "no picture");
  const auto mesh = folder_.write("box.glb", "no mesh");  // asks for no unit
  window_.takeFiles({bad, mesh, os / "camera.json", os / "seed.json"});
  ASSERT_TRUE(wait([&] { return resting() && !window_.lastMessage().isEmpty(); }));
  EXPECT_TRUE(test::has(window_.lastMessage(), "bad.png"));
  EXPECT_EQ(window_.statusBar()->currentMessage(), QString()) << "nothing is being read any more";
  window_.takeFiles({os / "image.png", mesh, os / "seed.json"});
  EXPECT_TRUE(test::has(window_.statusBar()->currentMessage(), "Still needed: a camera"));
}

TEST_F(MainWindowTest, UndoOfAnotherCasesEditShowsThatCase) {
  openExample();
  const QString first = window_.cases().caseId();
  moveSeed(0.01);
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_TRUE(test::has(window_.statusBar()->currentMessage(), "Undone"));
  moveSeed(0.02);
  EXPECT_EQ(window_.statusBar()->currentMessage(), QString()) << "the next edit hides it";
  const QString other = QString::fromStdString(session().cases.back()->id);
  ASSERT_NE(other, first);
  window_.cases().chooseCase(other);
  ASSERT_TRUE(wait([&] { return resting() && window_.state().currentCase() != nullptr; }));
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_EQ(window_.cases().caseId(), first);
  EXPECT_TRUE(window_.statusBar()->currentMessage().contains(first))
      << window_.statusBar()->currentMessage().toStdString();
  ASSERT_TRUE(rests());
  window_.cases().chooseCase(other);
  ASSERT_TRUE(rests());
  QTest::keySequence(&window_, QKeySequence::Redo);
  EXPECT_EQ(window_.cases().caseId(), first);
  ASSERT_TRUE(rests());
}

TEST_F(MainWindowTest, CaseMenu_RemovesACaseWhichAnUndoBringsBack) {
  openExample();
  const std::string id = session().cases.back()->id;
  const auto act = [&](const char* name) {
    const auto menu = caseMenu(fromText(id), window_.parts(), window_.workspaces(), window_);
    menu->findChild<QAction*>(QLatin1String(name))->trigger();
  };
  act("caseName");
  EXPECT_EQ(QGuiApplication::clipboard()->text(), fromText(id));
  act("caseRun");
  ASSERT_TRUE(batchEnds());
  ASSERT_NE(session().lastRunOf(id), nullptr);
  act("caseReview");
  EXPECT_EQ(window_.workspaces().current(), Workspace::kReview);
  EXPECT_EQ(window_.cases().caseId(), fromText(id));
  ASSERT_TRUE(rests());
  act("caseRemove");
  EXPECT_EQ(session().findCase(id), nullptr);
  EXPECT_NE(window_.cases().caseId(), fromText(id)) << "another case is shown";
  ASSERT_TRUE(rests());
  QTest::keySequence(&window_, QKeySequence::Undo);
  ASSERT_NE(session().findCase(id), nullptr);
  EXPECT_NE(session().lastRunOf(id), nullptr) << "with its run";
  ASSERT_TRUE(rests());
}

TEST_F(MainWindowTest, AllCasesAreRunAndCountedWhileTheShownCaseStays) {
  openExample();
  const QString shown = window_.cases().caseId();
  QStringList said;
  QStringList chosen;
  window_.state().onChange(ViewChange::kOtherCase, &window_,
                           [&] { chosen << window_.cases().caseId(); });
  QObject::connect(&window_.cases(), &CaseController::batchChanged, &window_, [&] {
    const QString text = runState() + QLatin1Char(' ') + find<QLabel>("jobCount").text();
    if (said.isEmpty() || said.back() != text) said << text;
    if (!window_.cases().batch()) return;
    EXPECT_TRUE(find<QPushButton>("jobStop").isVisible()) << "between two cases, too";
    EXPECT_NE(runState(), QStringLiteral("Finished"));
  });
  runAll();
  EXPECT_EQ(session().runs.size(), 2u);
  EXPECT_TRUE(said.contains(QStringLiteral("Running all cases 0 of 2 done")));
  EXPECT_TRUE(said.contains(QStringLiteral("Running all cases 1 of 2 done")));
  EXPECT_EQ(window_.cases().caseId(), shown);
  EXPECT_TRUE(chosen.isEmpty()) << chosen.join(QLatin1Char(' ')).toStdString();
  ASSERT_NE(window_.state().snapshot(), nullptr) << "the shown case has its run";
  EXPECT_EQ(window_.state().snapshot()->digest, session().lastRunOf(shown.toStdString())->digest);
  EXPECT_TRUE(test::has(runState(), "2 run in "));
  EXPECT_TRUE(test::has(find<QLabel>("jobDetail").toolTip(), " converged"));
  find<QPushButton>("jobStep").click();
  EXPECT_TRUE(window_.dock(QStringLiteral("queue"))->isVisible());
}

/// At the beginning of a second: the record of the repeated run is then the one that the session
/// has, so that storing it changes nothing.
TEST_F(MainWindowTest, RunAllGoesOnWhereTheTraceOfAFormerRunIsMissing) {
  ASSERT_TRUE(wait([] { return QTime::currentTime().msec() < 50; }));
  openRun();
  ASSERT_TRUE(std::filesystem::remove(session().runs[0].file));
  ASSERT_TRUE(wait([&] { return key("Ctrl+F5")->isEnabled(); }));
  key("Ctrl+F5")->trigger();
  ASSERT_TRUE(window_.cases().batch());
  ASSERT_TRUE(batchEnds());
  ASSERT_EQ(session().runs.size(), 2u);
  for (const sessions::RunRecord& run : session().runs)
    EXPECT_TRUE(std::filesystem::exists(run.file));
}

/// Between two cases, when one is stored and the next one read, no run is under way.
TEST_F(MainWindowTest, StopEndsRunAllBetweenTwoCases) {
  openExample();
  const auto stops = QObject::connect(&window_.document(), &Document::changed, &window_, [&] {
    EXPECT_FALSE(key("Ctrl+F5")->isEnabled()) << "all are being run already";
    find<QPushButton>("jobStop").click();
  });
  runAll();
  QTest::qWait(100);
  EXPECT_TRUE(rests());
  EXPECT_EQ(session().runs.size(), 1u) << "the second case is not run";
  EXPECT_TRUE(key("Ctrl+F5")->isEnabled());
  QObject::disconnect(stops);
  EXPECT_EQ(runState(), QStringLiteral("Stopped after 1 of 2"));
  find<QPushButton>("jobStep").click();  // the rest alone
  ASSERT_TRUE(batchEnds());
  ASSERT_EQ(session().runs.size(), 2u);
  EXPECT_NE(session().runs[0].case_id, session().runs[1].case_id);
  EXPECT_TRUE(test::has(runState(), "1 run in "));
}

TEST_F(MainWindowTest, StopEndsRunAllDuringACase) {
  openExample();
  QObject::connect(&window_.cases(), &CaseController::batchChanged, &window_, [&] {
    const auto& batch = window_.cases().batch();
    if (batch && batch->iteration == 1) key("F8")->trigger();
  });
  runAll();
  QTest::qWait(100);
  EXPECT_TRUE(session().runs.empty());
}

TEST_F(MainWindowTest, F8AndEscapeStopWhatRuns_UnlessAToolHasEscape_AndF5GoesOn) {
  openExample(true);
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(becomes(RunState::kWorking));
  QTest::keyClick(&window_, Qt::Key_F8);
  EXPECT_TRUE(becomes(RunState::kHalted));
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(becomes(RunState::kWorking));
  QTest::keyClick(&window_, Qt::Key_Escape);
  EXPECT_TRUE(becomes(RunState::kHalted));
  auto& canvas = find<ImageView>("imageView");
  window_.image().measure().setActive(true);
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(becomes(RunState::kWorking));
  QTest::keyClick(&canvas, Qt::Key_Escape);
  EXPECT_FALSE(canvas.toolActive()) << "the ruler is put away first";
  ASSERT_TRUE(becomes(RunState::kFinished));
  EXPECT_TRUE(window_.run().snapshot()->converged());
}

TEST_F(MainWindowTest, AnotherCaseCanBeLookedAtDuringRunAll) {
  openExample();
  const QString second = QString::fromStdString(session().cases.back()->id);
  key("Ctrl+F5")->trigger();
  ASSERT_TRUE(window_.cases().batch());
  window_.cases().chooseCase(second);
  EXPECT_TRUE(window_.cases().batch());
  ASSERT_TRUE(batchEnds());
  EXPECT_EQ(session().runs.size(), 2u);
  EXPECT_EQ(window_.cases().caseId(), second);
}

/// A case that is edited while it is run has a run of what it was, which is stale.
TEST_F(MainWindowTest, EditDuringRunAll_MakesThatRunStale) {
  openExample();
  bool edited = false;
  QObject::connect(&window_.cases(), &CaseController::batchChanged, &window_, [&] {
    const auto& batch = window_.cases().batch();
    if (!batch || batch->iteration != 1 || std::exchange(edited, true)) return;
    moveSeed(0.01);
  });
  runAll();
  ASSERT_EQ(session().runs.size(), 2u);
  EXPECT_FALSE(window_.cases().staleness().isEmpty());
}

TEST_F(MainWindowTest, ClosingItKeepsARunThatHasJustEnded) {
  openExample();
  QTest::keyClick(&window_, Qt::Key_F5);
  const test::ModalAnswer<QMessageBox> saves(
      [](QMessageBox& box) { box.button(QMessageBox::Save)->click(); });
  bool closed = false;
  // At once, before the run can have been stored.
  QObject::connect(&window_.run(), &RunController::finished, &window_,
                   [&] { closed = window_.close(); });
  ASSERT_TRUE(wait([&] { return closed; }));
  EXPECT_EQ(session().runs.size(), 1u);
  EXPECT_FALSE(window_.document().isModified());
}

/// The run was ended without a word.
TEST_F(MainWindowTest, ClosingItDuringARunOrABatch_AsksOnceAndKeepsWhatIsDone) {
  openExample(true);
  QString asked;
  const auto answer = [&asked](const char* button) {
    return test::ModalAnswer<QMessageBox>([&asked, button](QMessageBox& box) {
      if (auto* chosen = box.findChild<QAbstractButton*>(QLatin1String(button))) {
        asked = box.informativeText();
        chosen->click();
      } else {
        box.button(QMessageBox::Save)->click();
      }
    });
  };
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(becomes(RunState::kWorking));
  {
    const auto stay = answer("stay");
    EXPECT_FALSE(window_.close());
  }
  EXPECT_TRUE(test::has(asked, "is run"));
  EXPECT_EQ(window_.run().state(), RunState::kWorking);
  ASSERT_TRUE(becomes(RunState::kFinished));
  ASSERT_TRUE(wait([&] { return session().runs.size() == 1; }));

  moveSeed(1e-4);
  ASSERT_TRUE(rests());
  bool closed = false;
  QObject::connect(&window_.cases(), &CaseController::batchChanged, &window_, [&] {
    const auto& batch = window_.cases().batch();
    if (closed || !batch || batch->done != 1 || batch->iteration != 1) return;
    const auto end = answer("endJobs");
    closed = window_.close();
  });
  key("Ctrl+F5")->trigger();
  ASSERT_TRUE(wait([&] { return closed; }));
  EXPECT_TRUE(test::has(asked, "1 of 2"));
  EXPECT_FALSE(window_.cases().batch());
  EXPECT_EQ(session().runs.size(), 2u) << "the run that had ended";
  EXPECT_FALSE(window_.document().isModified());
}

TEST_F(MainWindowTest, StepsAStageAndAnIteration) {
  openExample(true);
  for (const Stage stage : {Stage::kEdges, Stage::kSearch, Stage::kRender}) {
    QTest::keyClick(&window_, Qt::Key_F7);
    ASSERT_TRUE(wait([&] {
      const auto& shown = window_.state().snapshot();
      return window_.run().state() == RunState::kHalted && shown && shown->stage == stage;
    })) << stageText(stage);
  }
  EXPECT_TRUE(window_.state().snapshot()->last_under_way);
  QTest::keyClick(&window_, Qt::Key_F6);
  ASSERT_TRUE(wait([&] {
    return window_.run().state() == RunState::kHalted &&
           !window_.state().snapshot()->last_under_way;
  }));
  EXPECT_EQ(window_.state().snapshot()->iterations.size(), 1u);
  EXPECT_EQ(window_.state().cursor().iteration, 0);
}

TEST_F(MainWindowTest, RunsAgainWhileTheLastIterationOrTheSeedIsShown_AndIsFollowedToItsEnd) {
  openRun();
  const auto first = window_.state().snapshot();
  ASSERT_GT(window_.state().cursor().iteration, 0);
  QTest::keyClick(&window_, Qt::Key_F5);  // shows fewer iterations than the cursor knows
  ASSERT_TRUE(wait([&] { return window_.state().snapshot() != first && resting(); }));
  EXPECT_EQ(window_.state().snapshot()->digest, first->digest);
  window_.state().setCursor({-1, Stage::kFinished});
  moveSeed(0.001);
  ASSERT_TRUE(runToTheEnd(2));
  EXPECT_EQ(window_.state().cursor().iteration,
            static_cast<int>(window_.state().snapshot()->iterations.size()) - 1);
}

/// Reading may take a second: what is shown meanwhile is not of the run before.
TEST_F(MainWindowTest, RunThatWaitsForItsFiles_IsUnderWayForTheBar) {
  openRun();
  window_.cases().runWithWiderSearch();
  QStringList heads;
  ASSERT_TRUE(wait([&] {
    heads << window_.frame().verdict().verdict().head;
    return session().runs.size() == 2 && resting();
  }));
  EXPECT_TRUE(heads.filter(QStringLiteral("outdated")).isEmpty())
      << heads.join(QLatin1Char('|')).toStdString();
}

TEST_F(MainWindowTest, KeysShowAndHideLayers) {
  openExample();
  const bool before = window_.image().style(LayerId::kTestEdges).visible;
  QTest::keyClick(&window_, Qt::Key_E);
  EXPECT_EQ(window_.image().style(LayerId::kTestEdges).visible, !before);
}

TEST(ShortcutSheet, ListsEveryKeyOfTheWindowAndThoseOfImageSceneAndNudging) {
  QStandardPaths::setTestModeEnabled(true);
  MainWindow window;
  const ShortcutSheet sheet(window);
  QString all;
  for (const QLabel* label : sheet.findChildren<QLabel*>())
    all += label->text() + QLatin1Char('\n');
  int keys = 0;
  QMap<QString, QString> owner;
  for (const QAction* action : window.findChildren<QAction*>()) {
    if (action->shortcut().isEmpty()) continue;
    const QString key = action->shortcut().toString(QKeySequence::NativeText);
    SCOPED_TRACE(action->text().toStdString() + ": " + key.toStdString());
    if (qobject_cast<QMenu*>(action->parent()) || action->parent() == &window) {
      ++keys;
      EXPECT_TRUE(all.contains(key.toHtmlEscaped()));
    }
    if (action->shortcutContext() != Qt::WindowShortcut) continue;
    // Two actions of one key: Qt would do neither.
    EXPECT_FALSE(owner.contains(key)) << owner[key].toStdString();
    owner[key] = action->text();
  }
  EXPECT_GT(keys, 20);
  for (const char* place : {"Image:", "Scene:", "Nudging:", "Configuration:"})
    EXPECT_TRUE(all.contains(QLatin1String(place))) << place;
}

}  // namespace
}  // namespace boresight::ui
