// SPDX-License-Identifier: Apache-2.0
// A full disk, a read-only folder, a program that was killed: what the window says and what it
// keeps.
#include <unistd.h>

#include "sessions/io/files/file_lock.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_file.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window/full_disk.h"
#include "tests/ui/window_test.h"
#include "ui/models/text.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

using test::FullDisk;

/// Answers message boxes by a button, and the file dialog after them by a name.
struct Answers {
  QString button;
  QString file = {};
  std::function<void()> before_file = [] {};
  QString text = {};  ///< of the boxes
  test::ModalAnswer<QMessageBox> boxes{[this](QMessageBox& box) {
    text +=
        QStringList{box.text(), box.informativeText(), box.detailedText()}.join(QLatin1Char('\n'));
    for (QAbstractButton* each : box.buttons())
      if (each->text().remove(QLatin1Char('&')) == button)
        return QTest::mouseClick(each, Qt::LeftButton);
    ADD_FAILURE() << "no button " << button.toStdString();
    box.reject();
  }};
  test::ModalAnswer<QFileDialog> dialogs{[this](QFileDialog& dialog) {
    before_file();
    auto* name = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
    name->setText(file);
    QTest::keyClick(name, Qt::Key_Return);
  }};
};

class TroubleTest : public test::WindowTest {
 protected:
  TroubleTest() { window_.setQuiet(false); }

  std::string savedBytes() const { return folder_.read("one.boresight.json"); }
  void setSeed(double x_m) {
    Pose pose = window_.state().currentCase()->source.camera_from_station_seed;
    pose.translation_m.x() = x_m;
    window_.cases().useAsSeed(pose);
  }
  double seedIn(const sessions::Session& session) {
    return session.findCase(window_.cases().caseId().toStdString())
        ->camera_from_station_seed.translation_m.x();
  }

  const test::TemporaryFolder other_;
  const std::filesystem::path elsewhere_ = other_ / "elsewhere.boresight.json";
};

/// A full disk while another has room: its limit goes when the person has read the message and is
/// asked for a file elsewhere.
struct RoomElsewhere {
  std::filesystem::path elsewhere;
  FullDisk disk{64};
  Answers answers{QStringLiteral("Save elsewhere..."), QString::fromStdString(elsewhere.string()),
                  [this] { disk.end(); }};
};

TEST_F(TroubleTest, AFullDiskIsToldAndTheEditIsSavedElsewhere) {
  openExample();
  const std::string before = savedBytes();
  RoomElsewhere room{elsewhere_};
  setSeed(0.123);
  EXPECT_TRUE(test::has(room.answers.text, "one.boresight.journal"));
  EXPECT_TRUE(test::has(room.answers.text, "all changes are still in this window"));
  EXPECT_EQ(savedBytes(), before) << "the old file is as it was";
  ASSERT_TRUE(std::filesystem::exists(elsewhere_));
  EXPECT_EQ(window_.document().file(), elsewhere_);
  EXPECT_EQ(seedIn(window_.document().session()), 0.123) << "the edit that did not fit is there";
  EXPECT_EQ(seedIn(sessions::readSessionFile(elsewhere_).session), 0.123);
  EXPECT_FALSE(window_.document().isModified());
}

TEST_F(TroubleTest, ARunThatDoesNotFitIsKeptAndStoredElsewhere) {
  openExample();
  RoomElsewhere room{elsewhere_};
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([this] { return !window_.document().session().runs.empty() && resting(); }))
      << room.answers.text.toStdString();
  EXPECT_FALSE(room.answers.text.isEmpty());
  EXPECT_TRUE(window_.store().unstored().isEmpty());
  const sessions::RunRecord& record = window_.document().session().runs.front();
  EXPECT_EQ(record.digest, window_.state().snapshot()->digest);
  EXPECT_TRUE(std::filesystem::exists(record.file));
  EXPECT_EQ(record.file.string().rfind(other_.path().string(), 0), 0u) << record.file;
  EXPECT_EQ(sessions::loadRun(record).digest, record.digest);
}

TEST_F(TroubleTest, ARunThatDidNotFitIsStoredWhenThereIsRoomAgain) {
  openExample();
  {
    const FullDisk disk(64);
    Answers answers{QStringLiteral("Close")};
    QTest::keyClick(&window_, Qt::Key_F5);
    ASSERT_TRUE(wait([this] { return !window_.store().unstored().isEmpty(); }));
    EXPECT_TRUE(test::has(answers.text, "all changes are still in this window"));
    EXPECT_TRUE(window_.document().session().runs.empty());
  }
  {
    Answers answers{QStringLiteral("Cancel")};
    EXPECT_FALSE(window_.close()) << "the run would be lost";
    EXPECT_TRUE(test::has(answers.text, "are not stored"));
    const QString reason = window_.store().unstoredReason();
    EXPECT_FALSE(reason.isEmpty());
    EXPECT_TRUE(answers.text.contains(reason)) << "why";
  }
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  QTest::keySequence(&window_, QKeySequence::Save);
  ASSERT_TRUE(wait([this] { return window_.document().session().runs.size() == 1; }));
  EXPECT_TRUE(window_.store().unstored().isEmpty());
  ASSERT_TRUE(window_.document().save());
}

TEST_F(TroubleTest, BatchWhoseFirstRunIsStoredElsewhere_RunsEveryCaseOnce) {
  sessions::Session session = test::withoutSearch(test::exampleSession());
  QStringList ids;
  for (int i = 0; i < 4; ++i) {
    sessions::SessionCase copy = *session.cases[0];
    copy.id = "copy" + std::to_string(i);
    ids << QString::fromStdString(copy.id);
    session = sessions::withCase(session, copy);
  }
  open(session);
  RoomElsewhere room{elsewhere_};
  window_.cases().runAll(ids);
  ASSERT_TRUE(wait([&] { return !window_.cases().batch() && resting(); }));
  QStringList ran;
  for (const auto& run : window_.document().session().runs)
    ran << QString::fromStdString(run.case_id);
  ran.sort();
  EXPECT_EQ(ran, ids);
  ASSERT_TRUE(window_.cases().lastBatch());
  EXPECT_EQ(window_.cases().lastBatch()->count(), 4);
  EXPECT_EQ(window_.cases().lastBatch()->of, 4);
}

TEST_F(TroubleTest, AFullDiskWhileSavingLeavesTheOldFileAndTheEdits) {
  openExample();
  const std::string before = savedBytes();
  setSeed(0.25);
  ASSERT_TRUE(window_.document().isModified());
  {
    const FullDisk disk(64);
    Answers answers{QStringLiteral("Close")};
    QTest::keySequence(&window_, QKeySequence::Save);
    EXPECT_TRUE(test::has(answers.text, "cannot write"));
  }
  EXPECT_EQ(savedBytes(), before);
  EXPECT_TRUE(window_.document().isModified());
  EXPECT_EQ(seedIn(window_.document().session()), 0.25);
  ASSERT_TRUE(window_.document().save());
  EXPECT_EQ(seedIn(sessions::readSessionFile(file_).session), 0.25) << "there is room again";
}

/// Moves the first case's seed in the file, as a program that does not look at the lock.
void changeByAnotherProgram(const std::filesystem::path& file, double x_m) {
  std::filesystem::remove(sessions::lockFileOf(file));
  Document other;
  ASSERT_TRUE(other.open(file));
  const std::string id = other.session().cases[0]->id;
  const auto move = [x_m](sessions::SessionCase& changed) {
    changed.camera_from_station_seed.translation_m.x() = x_m;
  };
  ASSERT_TRUE(other.edit(sessions::withChanged(other.session(), id, move), QStringLiteral("Move")));
  ASSERT_TRUE(other.save());
}

TEST_F(TroubleTest, FileThatAnotherProgramHasChanged_IsKeptAndTheSessionSavedUnderAnotherName) {
  openExample();
  changeByAnotherProgram(file_, 0.75);
  const std::string theirs = savedBytes();
  setSeed(0.25);
  {
    Answers answers{QStringLiteral("Close")};
    QTest::keySequence(&window_, QKeySequence::Save);
    EXPECT_TRUE(test::has(answers.text, "another program has changed the file"));
    EXPECT_TRUE(test::has(answers.text, "the file is as the other program left it"));
    EXPECT_FALSE(answers.text.contains(QStringLiteral("last saved state")));
    EXPECT_FALSE(answers.text.contains(QStringLiteral("Free space")));
  }
  EXPECT_TRUE(window_.document().isModified());
  {
    Answers answers{QStringLiteral("Save as..."), fromText(elsewhere_.string())};
    window_.findChild<SessionFiles*>()->save();
  }
  EXPECT_EQ(savedBytes(), theirs);
  EXPECT_EQ(window_.document().file(), elsewhere_);
  EXPECT_EQ(seedIn(sessions::readSessionFile(elsewhere_).session), 0.25);
}

TEST_F(TroubleTest, FileThatAnotherProgramHasChanged_IsReadAgainWhereTheOperatorWantsThat) {
  openExample();
  changeByAnotherProgram(file_, 0.75);
  setSeed(0.25);
  Answers answers{QStringLiteral("Read again")};
  QTest::keySequence(&window_, QKeySequence::Save);
  EXPECT_EQ(seedIn(window_.document().session()), 0.75);
  EXPECT_FALSE(window_.document().isModified());
  ASSERT_TRUE(rests());
  setSeed(0.5);
  EXPECT_TRUE(window_.findChild<SessionFiles*>()->save());
  EXPECT_EQ(seedIn(sessions::readSessionFile(file_).session), 0.5);
}

TEST_F(TroubleTest, AReadOnlyFolderIsToldAndTheSessionIsSavedElsewhere) {
  if (::geteuid() == 0) GTEST_SKIP() << "to root no folder is read-only";
  openExample();
  window_.document().close();
  const std::string before = savedBytes();
  std::filesystem::permissions(
      folder_.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  ASSERT_TRUE(window_.openSession(file_));
  EXPECT_FALSE(window_.document().readOnlyReason().isEmpty());
  EXPECT_TRUE(test::has(window_.windowTitle(), "read only"));
  ASSERT_TRUE(wait([this] { return window_.state().currentCase() != nullptr; }));
  Answers answers{QStringLiteral("Save elsewhere..."), QString::fromStdString(elsewhere_.string())};
  setSeed(0.5);
  EXPECT_EQ(savedBytes(), before);
  EXPECT_EQ(seedIn(sessions::readSessionFile(elsewhere_).session), 0.5);
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_all);
}

TEST_F(TroubleTest, EditsOfAKilledProgram_AreOfferedAndRecoveredOrSetAside) {
  for (const bool recovers : {false, true}) {
    openExample();
    setSeed(0.25);
    window_.document().close();  // as a kill does it: nothing is saved
    Answers answers{QLatin1String(recovers ? "Recover" : "Set aside")};
    ASSERT_TRUE(window_.openSession(file_));
    EXPECT_TRUE(test::has(answers.text, file_.filename().c_str()));
    EXPECT_TRUE(test::has(answers.text, "unsaved work"));
    EXPECT_TRUE(test::has(answers.text, "Move the seed")) << "which they were";
    EXPECT_FALSE(window_.document().recovery());
    ASSERT_TRUE(wait([this] { return !window_.tasks().isBusy(); }));
    EXPECT_EQ(seedIn(window_.document().session()) == 0.25, recovers);
    EXPECT_EQ(window_.document().isModified(), recovers);
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "one.boresight.journal.aside-1"));
}

TEST_F(TroubleTest, ALaterSaveElsewhere_DoesNotPerformARefusedEdit) {
  openExample();
  const double before = seedIn(window_.document().session());
  {
    const FullDisk disk(64);
    Answers answers{QStringLiteral("Close")};
    setSeed(0.25);
  }
  ASSERT_TRUE(window_.document().saveAs(elsewhere_));
  EXPECT_EQ(seedIn(window_.document().session()), before);
}

TEST_F(TroubleTest, AJournalOfAnotherState_IsSetAsideWithAMessage) {
  folder_.write("one.boresight.journal", "{}");
  Answers answers{QStringLiteral("OK")};
  openExample();
  EXPECT_TRUE(test::has(answers.text, "one.boresight.journal.aside-1"));
}

TEST_F(TroubleTest, TheNewestRunIsShownAfterARecovery) {
  openRun();
  const auto shown = [this](const std::string& digest) {
    return wait(
        [&] { return window_.state().snapshot() && window_.state().snapshot()->digest == digest; });
  };
  const std::string first = window_.state().snapshot()->digest;
  LocalizerOptions options;
  options.search.enabled = false;
  options.pnp.seed = 2;
  window_.cases().setOptions(QStringLiteral("default"), options);
  window_.cases().reset();
  window_.cases().advance(sessions::StepUntil::kEnd);
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 2 && resting(); }));
  const std::string second = window_.state().snapshot()->digest;
  ASSERT_NE(first, second);
  window_.document().close();  // as a kill does it
  window_.setQuiet(true);      // no answer yet
  ASSERT_TRUE(window_.openSession(file_));
  ASSERT_TRUE(shown(first));
  ASSERT_TRUE(window_.document().acceptRecovery());
  EXPECT_TRUE(shown(second));
}

}  // namespace
}  // namespace boresight::ui
