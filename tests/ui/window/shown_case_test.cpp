// SPDX-License-Identifier: Apache-2.0
// From a click on another case until its files are read, no case is shown: nothing acts on a case
// that the operator does not see.
#include <fstream>
#include <functional>
#include <future>

#include "sessions/annotation/annotations_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/ignore_strokes.h"
#include "sessions/session/session_file.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/models/text.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/panels/case/frames_panel.h"
#include "ui/panels/case/input_sheet_panel.h"
#include "ui/panels/run/nudge_box.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/review/pose_export.h"
#include "ui/run/export_runner.h"
#include "ui/window/application.h"
#include "ui/window/input_findings.h"
#include "ui/window/session_files.h"
#include "ui/window/verdict_controller.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/uncertainty_dialog.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

class ShownCaseTest : public test::WindowTest {
 protected:
  const std::string& a() const { return test::exampleSession().cases[0]->id; }
  const std::string& b() const { return test::exampleSession().cases[1]->id; }
  const sessions::Session& session() { return window_.document().session(); }
  std::string shown() {
    return window_.state().currentCase() ? window_.state().currentCase()->source.id : "";
  }
  void choose(const std::string& id) { window_.cases().chooseCase(fromText(id)); }
};

TEST_F(ShownCaseTest, ChosenCase_IsTheShownOneOrNoneIsShown) {
  openRun();
  bool agree = true;
  const QObject here;
  window_.state().onChange(ViewChange::kAll, &here, [&] {
    agree = agree && (shown().empty() || shown() == window_.cases().caseId().toStdString());
  });
  const CaseOpening of_a = window_.state().opening();
  EXPECT_EQ(of_a.id, a());
  moveSeed(0.001);
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.state().opening(), of_a) << "an edit opens nothing";
  choose(b());
  EXPECT_EQ(shown(), "");
  EXPECT_EQ(window_.state().snapshot(), nullptr);
  ASSERT_TRUE(showsCase(b()));
  choose(a());
  ASSERT_TRUE(showsCase(a()));
  EXPECT_NE(window_.state().opening(), of_a) << "a dialog of then is about another opening";
  EXPECT_TRUE(agree);
}

TEST_F(ShownCaseTest, ActsOnTheCaseBefore_ChangeNothingWhileAnotherIsRead) {
  openExample();
  auto& nudge = window_.findChild<PosePanel*>()->nudgeController();
  Pose moved = window_.state().currentCase()->source.camera_from_station_seed;
  moved.translation_m.x() += 0.0321;
  nudge.setPose(moved);
  ASSERT_TRUE(rests());
  const sessions::Session before = session();
  choose(b());
  nudge.useAsSeed();
  window_.cases().runWithWiderSearch();
  window_.cases().runWithUncertainty({});
  auto* mask = window_.findChild<MaskPanel*>();
  Q_EMIT mask->strokeRequested({});
  mask->clearAll();
  EXPECT_TRUE(session() == before) << window_.document().undoText().toStdString();
  ASSERT_TRUE(showsCase(b()));
  EXPECT_TRUE(session() == before);
  EXPECT_NE(window_.run().state(), RunState::kWorking);
}

TEST_F(ShownCaseTest, RunRequestedForACase_IsNotMadeOfAnother) {
  openRun();
  bool works = false;
  QObject::connect(&window_.run(), &RunController::stateChanged, &window_,
                   [&] { works = works || window_.run().state() == RunState::kWorking; });
  choose(b());
  window_.cases().advance(sessions::StepUntil::kEnd);
  EXPECT_TRUE(window_.cases().runsSoon());
  choose(a());
  EXPECT_FALSE(window_.cases().runsSoon());
  ASSERT_TRUE(showsCase(a()));
  EXPECT_FALSE(works);
  choose(b());
  window_.cases().advance(sessions::StepUntil::kEnd);
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2 && resting(); }));
  EXPECT_EQ(session().runs.back().case_id, b());
}

/// While the dialog is open another case is opened.
TEST_F(ShownCaseTest, Export_HoldsTheCaseOfItsTitle) {
  openRun();
  auto* poses = window_.findChild<PoseExport*>();
  const auto out = folder_.path() / "pose.json";
  QString title;
  const test::ModalAnswer<QFileDialog> dialogs{[&](QFileDialog& dialog) {
    if (shown() == a()) choose(b());
    if (shown() != b()) return;
    title = dialog.windowTitle();
    auto* name = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
    name->setText(fromText(out.string()));
    QTest::keyClick(name, Qt::Key_Return);
  }};
  poses->askForPose();
  ASSERT_TRUE(wait([&] { return !window_.exports().isBusy(); }));
  EXPECT_TRUE(title.contains(fromText(a()))) << title.toStdString();
  ASSERT_TRUE(std::filesystem::exists(out)) << window_.lastMessage().toStdString();
  EXPECT_TRUE(test::has(fromText(folder_.read("pose.json")), ('"' + a() + '"').c_str()));
}

TEST_F(ShownCaseTest, NameOfAStroke_IsNotGivenToTheMaskOfAnotherCase) {
  openExample();
  sessions::MaskStroke stroke;
  stroke.kind = sessions::StrokeKind::kSaturation;
  stroke.level = 250;
  auto* mask = window_.findChild<MaskPanel*>();
  Q_EMIT mask->strokeRequested(stroke);
  ASSERT_TRUE(rests());
  mask->findChild<QListWidget*>(QStringLiteral("strokes"))->setCurrentRow(0);
  const test::ModalAnswer<QInputDialog> answer{[&](QInputDialog& dialog) {
    if (shown() == a()) choose(b());
    if (shown() != b()) return;
    dialog.setTextValue(QStringLiteral("glare"));
    dialog.accept();
  }};
  mask->findChild<QPushButton*>(QStringLiteral("nameStroke"))->click();
  ASSERT_TRUE(rests());
  EXPECT_TRUE(session().findCase(b())->ignore_strokes.empty());
  EXPECT_TRUE(session().findCase(a())->ignore_strokes.front().name.empty());
  EXPECT_TRUE(test::has(window_.lastMessage(), "not named"));
}

TEST_F(ShownCaseTest, ButtonOfTheVerdictBar_DoesNotActOnACaseThatItDoesNotTellOf) {
  openRun();
  auto* verdicts = window_.findChild<VerdictController*>();
  const sessions::Session before = session();
  choose(b());
  verdicts->performShown(Step::kWiderSearch);  // at once: the bar tells of the first case
  EXPECT_TRUE(session() == before);
  ASSERT_TRUE(showsCase(b()));
  EXPECT_TRUE(session() == before);
  choose(a());
  ASSERT_TRUE(showsCase(a()));
  const test::ModalAnswer<UncertaintyDialog> answer{[&](UncertaintyDialog& dialog) {
    if (shown() == a()) choose(b());
    if (shown() == b()) dialog.accept();
  }};
  verdicts->performShown(Step::kUncertainty);
  EXPECT_EQ(shown(), b());
  EXPECT_TRUE(session() == before) << "the figures were those of the first case";
  EXPECT_TRUE(test::has(window_.lastMessage(), "no longer shown"));
}

/// While each dialog is open another case is opened.
TEST_F(ShownCaseTest, DialogsOfACaseThatWasLeft_ChangeNothing) {
  openExample();
  sessions::Annotations annotations;
  annotations.points.resize(1);
  annotations.points.front().id = "p1";
  annotations.points.front().pixel = Eigen::Vector2d(100.0, 100.0);
  const auto points = folder_.path() / "points.json";
  sessions::writeAnnotations(points, annotations);
  QGuiApplication::clipboard()->setText(QStringLiteral("0.1 0.2 0.3"));
  auto& annotation = *window_.findChild<AnnotationPanel*>();
  const std::function<void()> dialogs[] = {
      [&] { find<QAction>("importAnnotations").trigger(); },
      [&] { Q_EMIT annotation.openLandmarksRequested(); },
      [&] { Q_EMIT annotation.saveLandmarksRequested(); },
      [&] { annotation.askForName(); },
      [&] { Q_EMIT window_.findChild<FramesPanel*>()->addRequested(); },
      [&] { Q_EMIT window_.findChild<InputSheetPanel*>()->sigmasRequested(); },
      [&] { Q_EMIT window_.findChild<InputSheetPanel*>()->judgementRequested(); },
  };
  const test::ModalAnswer<QDialog> answer{[&](QDialog& dialog) {
    if (shown() == a()) choose(b());
    if (shown() != b()) return;
    auto* name = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
    if (!name) return dialog.accept();
    const auto& of_files = static_cast<const QFileDialog&>(dialog);
    const bool saves = of_files.acceptMode() == QFileDialog::AcceptSave;
    name->setText(fromText((saves ? folder_.path() / "new.json" : points).string()));
    QTest::keyClick(name, Qt::Key_Return);
  }};
  for (const auto& open_dialog : dialogs) {
    SCOPED_TRACE(&open_dialog - dialogs);
    choose(a());
    ASSERT_TRUE(showsCase(a()));
    const sessions::Session before = session();
    open_dialog();
    EXPECT_EQ(shown(), b());
    EXPECT_TRUE(session() == before) << window_.document().undoText().toStdString();
    EXPECT_TRUE(test::has(window_.lastMessage(), "no longer shown"));
  }
}

/// The last run of the case is being read while an operator opens another of its runs.
TEST_F(ShownCaseTest, RunThatIsOpenedWhileTheLastOneIsRead_EndsTheReading) {
  openRun();
  const std::string digest = window_.state().snapshot()->digest;
  choose(b());
  ASSERT_TRUE(showsCase(b()));
  bool opened = false;
  const QObject here;
  window_.state().onChange(ViewChange::kCase, &here, [&] {
    if (shown() == a() && !opened)
      QTimer::singleShot(0, &window_, [&] { window_.cases().showRun(digest); });
    opened = opened || shown() == a();
  });
  choose(a());
  ASSERT_TRUE(wait([&] { return opened && window_.state().snapshot() && resting(); }));
  EXPECT_FALSE(window_.cases().readsRun());
}

/// Reading a dataset takes a while; the open session can be edited meanwhile.
TEST_F(ShownCaseTest, DatasetThatIsRead_DoesNotReplaceEditsWithoutAQuestion) {
  openExample();
  const test::OwnDataFolder data;
  bool asked = false;
  const test::ModalAnswer<QMessageBox> stay{[&](QMessageBox& box) {
    asked = true;
    box.reject();
  }};
  drop(test::smallExampleFolder() / "dataset.json");
  moveSeed(0.001);
  const sessions::Session edited = session();
  ASSERT_TRUE(wait([&] { return asked && resting(); }));
  EXPECT_TRUE(session() == edited);
}

TEST_F(ShownCaseTest, DroppedFiles_AreTakenOnceTheDropHasEnded) {
  openExample();
  folder_.write("notes.txt", "hello");
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(fromText((folder_.path() / "notes.txt").string()))});
  QDragEnterEvent enter(QPoint(600, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&window_, &enter);
  QDropEvent event(QPointF(600, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  const QString message = window_.lastMessage();
  QCoreApplication::sendEvent(&window_, &event);
  EXPECT_EQ(window_.lastMessage(), message) << "a dialog would keep the other program waiting";
  EXPECT_TRUE(wait([&] { return test::has(window_.lastMessage(), "notes.txt"); }));
}

TEST_F(ShownCaseTest, RemovingTheShownCase_KeepsTheBatchAndRunsThatAreNotStored) {
  openExample();
  choose(b());
  ASSERT_TRUE(showsCase(b()));
  window_.cases().runAll({fromText(a())});
  ASSERT_TRUE(window_.cases().batch());
  ASSERT_TRUE(
      window_.document().edit(sessions::withoutCase(session(), b()), QStringLiteral("Remove")));
  EXPECT_TRUE(window_.cases().batch()) << "it is of another case";
  ASSERT_TRUE(wait([&] { return !window_.cases().batch() && resting(); }));
  EXPECT_EQ(session().runs.size(), 1u);
  EXPECT_EQ(shown(), a());
}

/// An edit that is no input of the run: a requirement, a name.
TEST_F(ShownCaseTest, EditThatIsNoInput_LeavesTheRunUnderWay) {
  open(test::exampleSession());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kWorking; }));
  const auto tag = [](sessions::SessionCase& changed) { changed.tags = {"seen"}; };
  ASSERT_TRUE(
      window_.document().edit(sessions::withChanged(session(), a(), tag), QStringLiteral("Tag")));
  ASSERT_TRUE(wait([&] { return session().runs.size() == 1 && resting(); }));
  EXPECT_TRUE(window_.cases().staleness().isEmpty());
}

/// A run that has just ended belongs to the session that it was run from.
TEST_F(ShownCaseTest, RunThatIsBeingStored_IsNotRecordedInAnotherSession) {
  openExample();
  const std::filesystem::path first = file_;
  sessions::Session other = test::withoutSearch(test::exampleSession());
  newFile();
  const std::filesystem::path second = file_;
  bool left = false;
  QObject::connect(&window_.run(), &RunController::finished, &window_, [&] {
    ASSERT_TRUE(window_.document().create(second, other));  // at once
    left = true;
  });
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return left; }));
  ASSERT_TRUE(showsCase(a()));
  EXPECT_TRUE(session().runs.empty());
  EXPECT_TRUE(window_.store().unstored().isEmpty());
  EXPECT_TRUE(test::has(window_.lastMessage(), first.c_str())) << "where it belongs";
  EXPECT_TRUE(test::has(window_.lastMessage(), "again")) << "how to have it";
}

/// A task that holds the thread that reads files.
struct HeldReader {
  explicit HeldReader(TaskRunner& tasks) {
    tasks.queue(
        [held = gate.get_future().share()](const std::stop_token&) {
          held.wait();
          return 1;
        },
        [](int) {}, [](const QString&) {});
  }
  std::promise<void> gate;
};

/// It waited for them: of a dataset some minutes.
TEST_F(ShownCaseTest, RunThatHasEnded_IsStoredWhileFilesAreRead) {
  openExample();
  HeldReader reader(window_.tasks());
  QTest::keyClick(&window_, Qt::Key_F5);
  EXPECT_TRUE(wait([&] { return session().runs.size() == 1; }));
  reader.gate.set_value();
  ASSERT_TRUE(rests());
}

TEST_F(ShownCaseTest, RunWhoseTraceIsMissing_IsReportedWhereTheRunWouldBe) {
  openRun();
  const sessions::RunRecord run = *session().lastRunOf(a());
  ASSERT_TRUE(window_.document().save());
  std::filesystem::remove(run.file);
  ASSERT_TRUE(reopen());
  ASSERT_TRUE(window_.state().missingRun());
  EXPECT_EQ(window_.state().shownRun(), run.digest);
  const auto verdict = [this] { return window_.findChild<VerdictBar*>()->verdict(); };
  EXPECT_TRUE(wait([&] { return verdict().head == QStringLiteral("There is no run to show."); }));
  EXPECT_EQ(verdict().sentence, window_.state().missingRun()->problem);
  // After another run that fails at its start it is reported again where it is asked for.
  window_.state().setMissingRun({{}, QStringLiteral("It did not start.")});
  window_.cases().showRun(run.digest);
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.state().shownRun(), run.digest) << "so that it can be rejected";
  choose(b());
  EXPECT_FALSE(window_.state().missingRun());
  ASSERT_TRUE(showsCase(b()));
}

TEST_F(ShownCaseTest, RunThatFailsAtItsStart_IsReportedWhereTheRunWouldBe) {
  openRun();
  const auto seedless = [](sessions::SessionCase& changed) {
    changed.has_seed = false;
    changed.camera_from_station_seed = Pose();
  };
  ASSERT_TRUE(window_.document().edit(sessions::withChanged(session(), a(), seedless),
                                      QStringLiteral("Remove the seed")));
  ASSERT_TRUE(rests());
  window_.cases().runAgain();
  ASSERT_TRUE(window_.state().missingRun());
  EXPECT_EQ(window_.state().shownRun(), "");
  EXPECT_EQ(window_.state().missingRun()->problem, window_.lastMessage());
}

/// The last run of a case that was opened came over one that was made meanwhile.
TEST_F(ShownCaseTest, RunBefore_IsNotShownOverOneThatHasEnded) {
  openRun();
  sessions::Session other = session();
  other.options = {{"search.enabled", false}, {"templates.count", std::int64_t{48}}};
  ASSERT_TRUE(window_.document().edit(other, QStringLiteral("Options")));
  choose(b());
  ASSERT_TRUE(showsCase(b()));
  choose(a());
  HeldReader reader(window_.tasks());
  ASSERT_TRUE(wait([&] { return shown() == a(); }));
  window_.cases().advance(sessions::StepUntil::kEnd);
  EXPECT_FALSE(window_.cases().readsRun());
  EXPECT_TRUE(wait([&] { return session().runs.size() == 2; }));
  reader.gate.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.state().snapshot()->digest, session().lastRunOf(a())->digest);
}

TEST_F(ShownCaseTest, RunThatIsRead_IsNotShownAfterAReset) {
  openRun();
  choose(b());
  ASSERT_TRUE(showsCase(b()));
  choose(a());
  HeldReader reader(window_.tasks());
  ASSERT_TRUE(wait([&] { return shown() == a(); }));
  window_.cases().reset();
  reader.gate.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.state().snapshot(), nullptr);
  EXPECT_FALSE(window_.cases().readsRun());
}

TEST_F(ShownCaseTest, HaltedRun_StaysWhereABatchStoresARunOfItsCase) {
  openExample();
  window_.cases().advance(sessions::StepUntil::kIteration);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kHalted; }));
  window_.cases().runAll({fromText(b()), fromText(a())});
  ASSERT_TRUE(wait([&] { return !window_.cases().batch() && resting(); }));
  EXPECT_EQ(session().runs.size(), 2u);
  EXPECT_EQ(window_.run().state(), RunState::kHalted);
  EXPECT_EQ(window_.state().snapshot(), window_.run().snapshot());
}

TEST_F(ShownCaseTest, SessionThatIsLeft_EndsItsRunsWithAMessage) {
  QString noted;
  QObject::connect(&window_.cases(), &CaseController::noted, &window_,
                   [&](const QString& text) { noted = text; });
  openExample();
  window_.cases().runAll({fromText(a()), fromText(b())});
  open(test::exampleSession());
  EXPECT_TRUE(test::has(noted, "The batch run was stopped"));
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kWorking; }));
  window_.document().close();
  EXPECT_TRUE(
      test::has(noted, ("The run of " + a() + " was stopped: its session was closed").c_str()));
}

TEST_F(ShownCaseTest, SessionThatIsReadAgain_EndsItsRunsWithATrueMessage) {
  QString noted;
  QObject::connect(&window_.cases(), &CaseController::noted, &window_,
                   [&](const QString& text) { noted = text; });
  openExample();
  window_.cases().runAll({fromText(a()), fromText(b())});
  ASSERT_TRUE(window_.document().open(file_, Former::kDiscard));
  EXPECT_TRUE(test::has(noted, "The batch run was stopped: its session was read again."));
  ASSERT_TRUE(rests());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kWorking; }));
  ASSERT_TRUE(window_.document().open(file_, Former::kDiscard));
  EXPECT_TRUE(test::has(noted, "was stopped: its session was read again."));
  EXPECT_FALSE(noted.contains(QStringLiteral("closed")));
}

TEST_F(ShownCaseTest, RunThatCouldNotBeStored_StaysWhileItsSessionIsReadAgain) {
  openExample();
  const std::filesystem::path runs = sessions::runsFolderOf(file_);
  std::ofstream(runs) << "not a folder";
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return !window_.store().unstored().isEmpty(); }));
  ASSERT_TRUE(window_.document().open(file_, Former::kDiscard));
  EXPECT_EQ(window_.store().unstored(), QStringList{fromText(a())});
  std::filesystem::remove(runs);
  ASSERT_TRUE(window_.document().save());
  EXPECT_TRUE(wait([&] { return session().runs.size() == 1; }));
}

TEST_F(ShownCaseTest, ClosingWhileAFileIsRead_SaysSoAndCanBeDoneWithoutWaiting) {
  openExample();
  HeldReader reader(window_.tasks());
  QString told;
  {
    const test::ModalAnswer<QMessageBox> leaves{[&told](QMessageBox& box) {
      told = box.text();
      box.findChild<QAbstractButton*>(QStringLiteral("leave"))->click();
    }};
    EXPECT_FALSE(endTasks());
  }
  EXPECT_TRUE(test::has(told, "being read"));
  reader.gate.set_value();
  EXPECT_TRUE(endTasks());
}

TEST_F(ShownCaseTest, RunWhoseFolderDoesNotAnswer_IsNotWaitedForWithoutAWord) {
  openExample();
  HeldReader writer(window_.store().runner());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.store().isStoring(); }));
  QStringList told;
  {
    const test::ModalAnswer<QMessageBox> answer{[&told](QMessageBox& box) {
      told << box.text();
      auto* leave = box.findChild<QAbstractButton*>(QStringLiteral("leave"));
      (leave ? leave : box.button(QMessageBox::Cancel))->click();
    }};
    EXPECT_FALSE(window_.findChild<SessionFiles*>()->mayLeave());
  }
  ASSERT_EQ(told.size(), 2);
  EXPECT_TRUE(test::has(told[0], "being written"));
  EXPECT_TRUE(test::has(told[1], "are not stored"));
  writer.gate.set_value();
  EXPECT_TRUE(wait([&] { return session().runs.size() == 1; }));
}

/// The runs are stored while the operator reads the question: Cancel stays in the session.
TEST_F(ShownCaseTest, CancelAfterTheRunWasStoredMeanwhile_StaysInTheSession) {
  openExample();
  ASSERT_TRUE(window_.document().save());
  HeldReader writer(window_.store().runner());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.store().isStoring(); }));
  QStringList told;
  bool released = false;
  {
    const test::ModalAnswer<QMessageBox> answer{[&](QMessageBox& box) {
      if (!told.contains(box.text())) told << box.text();
      if (auto* leave = box.findChild<QAbstractButton*>(QStringLiteral("leave")))
        return leave->click();
      if (!std::exchange(released, true)) writer.gate.set_value();
      if (window_.store().waiting().isEmpty()) box.button(QMessageBox::Cancel)->click();
    }};
    EXPECT_FALSE(window_.findChild<SessionFiles*>()->mayLeave());
  }
  ASSERT_EQ(told.size(), 2) << "and no further question";
  EXPECT_TRUE(test::has(told[1], "are not stored"));
}

TEST_F(ShownCaseTest, ListOfCases_IsThatOfTheSessionAlsoWithoutCases) {
  openExample();
  const QAbstractItemModel& list = *find<QTableView>("cases").model();
  EXPECT_EQ(list.rowCount(), 2);
  window_.document().close();
  EXPECT_EQ(list.rowCount(), 0);
  openExample();
  EXPECT_EQ(list.rowCount(), 2);
  newFile();
  ASSERT_TRUE(window_.document().create(file_, sessions::Session()));
  EXPECT_EQ(list.rowCount(), 0);
}

/// A run that was read to be shown came over one that was begun and halted meanwhile.
TEST_F(ShownCaseTest, RunThatIsReadToBeShown_DoesNotReplaceALaterOne) {
  openRun();
  HeldReader reader(window_.tasks());
  window_.cases().showRun(session().runs[0].digest);
  window_.cases().advance(sessions::StepUntil::kStage);
  EXPECT_TRUE(wait([&] { return window_.run().state() == RunState::kHalted; }));
  reader.gate.set_value();
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.state().snapshot(), window_.run().snapshot());
}

TEST_F(ShownCaseTest, RunThatIsStoredWhileTheSessionGetsAnotherName_IsStoredThere) {
  openExample();
  const std::filesystem::path first = file_;
  newFile();
  bool named = false;
  QObject::connect(&window_.run(), &RunController::finished, &window_, [&] {
    ASSERT_TRUE(window_.document().saveAs(file_));  // at once
    named = true;
  });
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return named && session().runs.size() == 1; }));
  const sessions::RunRecord& run = session().runs[0];
  EXPECT_EQ(run.file, sessions::runFileOf(file_, run.digest));
  std::filesystem::remove_all(sessions::runsFolderOf(first));
  EXPECT_TRUE(std::filesystem::exists(run.file));
  EXPECT_TRUE(window_.store().unstored().isEmpty());
}

/// What cannot be stored is known, whatever the reason, and is stored as soon as that is possible.
TEST_F(ShownCaseTest, RunWhoseFolderIsAFile_IsKeptWithTheReasonAndStoredLater) {
  openExample();
  const std::filesystem::path runs = sessions::runsFolderOf(file_);
  std::ofstream(runs) << "not a folder";
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return !window_.store().unstored().isEmpty(); }));
  EXPECT_FALSE(window_.store().unstoredReason().isEmpty());
  std::filesystem::remove(runs);
  ASSERT_TRUE(window_.document().save());
  ASSERT_TRUE(wait([&] { return session().runs.size() == 1; }));
  EXPECT_TRUE(window_.store().unstored().isEmpty());
}

TEST_F(ShownCaseTest, WaitForARunThatIsBeingStored_SleepsMeanwhile) {
  openExample();
  const int none = -1;
  int rounds = none;
  QObject::connect(&window_.run(), &RunController::finished, &window_, [&] {
    ASSERT_TRUE(window_.store().isStoring());
    rounds = 0;
    const QObject here;
    QObject::connect(QAbstractEventDispatcher::instance(), &QAbstractEventDispatcher::awake, &here,
                     [&rounds] { ++rounds; });
    const test::ModalAnswer<QMessageBox> discards{
        [](QMessageBox& box) { box.button(QMessageBox::Discard)->click(); }};
    EXPECT_EQ(window_.findChild<SessionFiles*>()->mayLeave(), Former::kDiscard);
    EXPECT_FALSE(window_.store().isStoring());
  });
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return rounds != none && resting(); }));
  EXPECT_LT(rounds, 300);
}

TEST_F(ShownCaseTest, ClosingDuringAnExport_Asks) {
  openExample();
  std::promise<void> gate;
  window_.exports().start(
      QStringLiteral("Writing a.json"), {},
      [held = gate.get_future().share()](const ExportRunner::Progress&) {
        held.wait();
        return 1;
      },
      [](int) {});
  QString asked;
  {
    const test::ModalAnswer<QMessageBox> stay{[&](QMessageBox& box) {
      asked = box.informativeText();
      box.reject();
    }};
    EXPECT_FALSE(window_.close());
  }
  EXPECT_TRUE(test::has(asked, "a.json"));
  gate.set_value();
  ASSERT_TRUE(wait([&] { return !window_.exports().isBusy(); }));
  EXPECT_TRUE(window_.close());
}

}  // namespace
}  // namespace boresight::ui
