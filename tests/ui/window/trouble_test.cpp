// SPDX-License-Identifier: Apache-2.0
// A full disk, a read-only folder, a program that was killed: what the window says and what it
// keeps.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include <QtTest/QTest>
#include <QtWidgets>

#include "sessions/session/case_run.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"
#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

constexpr int kPatienceMs = 60'000;

/// No file of this process may grow beyond so many bytes as long as it lives: a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit small{bytes, limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() { end(); }
  void end() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int) = nullptr;
};

/// Answers the next message box by a button, and the file dialog after it by a name.
class Answers {
 public:
  Answers(const QString& button, const QString& file) : button_(button), file_(file) {
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { look(); });
    timer_.start(10);
  }
  QString text() const { return text_; }

 private:
  void look() {
    QWidget* modal = QApplication::activeModalWidget();
    if (auto* box = qobject_cast<QMessageBox*>(modal)) {
      text_ += box->text() + QLatin1Char('\n') + box->informativeText() + QLatin1Char('\n') +
               box->detailedText();
      for (QAbstractButton* each : box->buttons()) {
        if (each->text().remove(QLatin1Char('&')) != button_) continue;
        QTest::mouseClick(each, Qt::LeftButton);
        return;
      }
      ADD_FAILURE() << "no button " << button_.toStdString();
      box->reject();
    } else if (auto* dialog = qobject_cast<QFileDialog*>(modal)) {
      auto* name = dialog->findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
      name->setText(file_);
      QTest::keyClick(name, Qt::Key_Return);
    }
  }

  QString button_;
  QString file_;
  QString text_;
  QTimer timer_;
};

class TroubleTest : public ::testing::Test {
 protected:
  TroubleTest() {
    QStandardPaths::setTestModeEnabled(true);
    window_.show();
  }

  std::filesystem::path file() const { return folder_ / "one.boresight.json"; }
  void open() {
    ASSERT_TRUE(window_.document().create(
        file(), sessions::makeSession(test::exampleFolder() / "dataset.json")));
    ASSERT_TRUE(QTest::qWaitFor(
        [this] { return window_.state().currentCase() && !window_.tasks().isBusy(); },
        kPatienceMs));
  }
  std::string savedBytes() const { return folder_.read("one.boresight.json"); }
  /// An edit as the pose panel orders it.
  void moveSeed(double x_m) {
    Pose pose = window_.state().currentCase()->source.camera_from_station_seed;
    pose.translation_m.x() = x_m;
    window_.cases().useAsSeed(pose);
  }
  double seedIn(const sessions::Session& session) {
    return session.findCase(window_.cases().caseId().toStdString())
        ->camera_from_station_seed.translation_m.x();
  }

  test::TemporaryFolder folder_;
  MainWindow window_;
};

TEST_F(TroubleTest, AFullDiskIsToldAndTheEditIsSavedElsewhere) {
  open();
  const std::string before = savedBytes();
  const test::TemporaryFolder other;
  const std::filesystem::path elsewhere = other / "elsewhere.boresight.json";
  FullDisk disk(64);
  Answers answers(QStringLiteral("Save elsewhere..."), QString::fromStdString(elsewhere.string()));
  // The other disk has room: the limit goes when the person has read the message.
  QTimer room;
  QObject::connect(&room, &QTimer::timeout, &room, [&] {
    if (qobject_cast<QFileDialog*>(QApplication::activeModalWidget())) disk.end();
  });
  room.start(1);
  moveSeed(0.123);
  EXPECT_TRUE(answers.text().contains(QStringLiteral("one.boresight.journal")))
      << answers.text().toStdString();
  EXPECT_TRUE(answers.text().contains(QStringLiteral("nothing is lost")));
  EXPECT_EQ(savedBytes(), before) << "the old file is as it was";
  ASSERT_TRUE(std::filesystem::exists(elsewhere));
  EXPECT_EQ(window_.document().file(), elsewhere);
  EXPECT_EQ(seedIn(window_.document().session()), 0.123) << "the edit that did not fit is there";
  EXPECT_EQ(seedIn(sessions::readSessionFile(elsewhere).session), 0.123);
  EXPECT_FALSE(window_.document().isModified());
}

TEST_F(TroubleTest, ARunThatDoesNotFitIsKeptAndStoredElsewhere) {
  open();
  const test::TemporaryFolder other;
  const std::filesystem::path elsewhere = other / "elsewhere.boresight.json";
  FullDisk disk(64);
  Answers answers(QStringLiteral("Save elsewhere..."), QString::fromStdString(elsewhere.string()));
  QTimer room;
  QObject::connect(&room, &QTimer::timeout, &room, [&] {
    if (qobject_cast<QFileDialog*>(QApplication::activeModalWidget())) disk.end();
  });
  room.start(1);
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(QTest::qWaitFor(
      [this] { return !window_.document().session().runs.empty() && !window_.tasks().isBusy(); },
      kPatienceMs))
      << answers.text().toStdString();
  EXPECT_FALSE(answers.text().isEmpty());
  EXPECT_TRUE(window_.cases().unstoredRuns().isEmpty());
  const sessions::RunRecord& record = window_.document().session().runs.front();
  EXPECT_EQ(record.digest, window_.state().snapshot()->digest);
  EXPECT_TRUE(std::filesystem::exists(record.file));
  EXPECT_EQ(record.file.string().rfind(other.path().string(), 0), 0u) << record.file;
  EXPECT_EQ(sessions::loadRun(record).digest, record.digest);
}

TEST_F(TroubleTest, ARunThatDidNotFitIsStoredWhenThereIsRoomAgain) {
  open();
  {
    const FullDisk disk(64);
    Answers answers(QStringLiteral("Close"), {});
    QTest::keyClick(&window_, Qt::Key_F5);
    ASSERT_TRUE(
        QTest::qWaitFor([this] { return !window_.cases().unstoredRuns().isEmpty(); }, kPatienceMs));
    EXPECT_TRUE(answers.text().contains(QStringLiteral("nothing is lost")));
    EXPECT_TRUE(window_.document().session().runs.empty());
  }
  {
    Answers answers(QStringLiteral("Cancel"), {});
    EXPECT_FALSE(window_.close()) << "the run would be lost";
    EXPECT_TRUE(answers.text().contains(QStringLiteral("no room")));
  }
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  QTest::keySequence(&window_, QKeySequence::Save);
  ASSERT_TRUE(QTest::qWaitFor([this] { return window_.document().session().runs.size() == 1; },
                              kPatienceMs));
  EXPECT_TRUE(window_.cases().unstoredRuns().isEmpty());
  ASSERT_TRUE(window_.document().save());
}

TEST_F(TroubleTest, AFullDiskWhileSavingLeavesTheOldFileAndTheEdits) {
  open();
  const std::string before = savedBytes();
  moveSeed(0.25);
  ASSERT_TRUE(window_.document().isModified());
  {
    const FullDisk disk(64);
    Answers answers(QStringLiteral("Close"), {});
    QTest::keySequence(&window_, QKeySequence::Save);
    EXPECT_TRUE(answers.text().contains(QStringLiteral("cannot write")))
        << answers.text().toStdString();
  }
  EXPECT_EQ(savedBytes(), before);
  EXPECT_TRUE(window_.document().isModified());
  EXPECT_EQ(seedIn(window_.document().session()), 0.25);
  ASSERT_TRUE(window_.document().save());
  EXPECT_EQ(seedIn(sessions::readSessionFile(file()).session), 0.25) << "there is room again";
}

TEST_F(TroubleTest, AReadOnlyFolderIsToldAndTheSessionIsSavedElsewhere) {
  if (::geteuid() == 0) GTEST_SKIP() << "to root no folder is read-only";
  open();
  window_.document().close();
  const std::string before = savedBytes();
  std::filesystem::permissions(
      folder_.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  ASSERT_TRUE(window_.openSession(file()));
  EXPECT_FALSE(window_.document().readOnlyReason().isEmpty());
  EXPECT_TRUE(window_.windowTitle().contains(QStringLiteral("read only")));
  ASSERT_TRUE(
      QTest::qWaitFor([this] { return window_.state().currentCase() != nullptr; }, kPatienceMs));
  const test::TemporaryFolder other;
  const std::filesystem::path elsewhere = other / "elsewhere.boresight.json";
  Answers answers(QStringLiteral("Save elsewhere..."), QString::fromStdString(elsewhere.string()));
  moveSeed(0.5);
  EXPECT_EQ(savedBytes(), before);
  EXPECT_EQ(seedIn(sessions::readSessionFile(elsewhere).session), 0.5);
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_all);
}

TEST_F(TroubleTest, EditsOfAKilledProgramAreOfferedAndTaken) {
  open();
  moveSeed(0.25);
  window_.document().close();  // as a kill does it: nothing is saved
  Answers answers(QStringLiteral("Recover"), {});
  ASSERT_TRUE(window_.openSession(file()));
  EXPECT_TRUE(answers.text().contains(QStringLiteral("one.boresight.json")))
      << answers.text().toStdString();
  EXPECT_TRUE(answers.text().contains(QStringLiteral("not saved")));
  EXPECT_TRUE(answers.text().contains(QStringLiteral("Move the seed"))) << "which they were";
  EXPECT_FALSE(window_.document().recovery());
  ASSERT_TRUE(QTest::qWaitFor([this] { return !window_.tasks().isBusy(); }, kPatienceMs));
  EXPECT_EQ(seedIn(window_.document().session()), 0.25);
  EXPECT_TRUE(window_.document().isModified());
}

TEST_F(TroubleTest, TheNewestRunIsShownAfterARecovery) {
  open();
  const auto run = [this](std::uint32_t seed) {
    LocalizerOptions options;
    options.pnp.seed = seed;
    window_.cases().setOptions(QStringLiteral("default"), options);
    window_.cases().reset();
    window_.cases().advance(sessions::StepUntil::kEnd);
    EXPECT_TRUE(QTest::qWaitFor(
        [this] {
          return window_.run().state() != RunState::kWorking && !window_.tasks().isBusy() &&
                 window_.state().snapshot() && window_.state().snapshot()->finished;
        },
        kPatienceMs));
    return window_.state().snapshot()->digest;
  };
  const auto shown = [this](const std::string& digest) {
    return QTest::qWaitFor(
        [&] { return window_.state().snapshot() && window_.state().snapshot()->digest == digest; },
        kPatienceMs);
  };
  const std::string first = run(1);
  ASSERT_TRUE(window_.document().save());
  const std::string second = run(2);
  ASSERT_NE(first, second);
  window_.document().close();  // as a kill does it
  window_.setQuiet(true);      // nobody answers yet
  ASSERT_TRUE(window_.openSession(file()));
  ASSERT_TRUE(shown(first));
  ASSERT_TRUE(window_.document().acceptRecovery());
  EXPECT_TRUE(shown(second));
}

TEST_F(TroubleTest, EditsOfAKilledProgramCanBeSetAside) {
  open();
  moveSeed(0.25);
  window_.document().close();
  Answers answers(QStringLiteral("Set aside"), {});
  ASSERT_TRUE(window_.openSession(file()));
  EXPECT_FALSE(answers.text().isEmpty());
  ASSERT_TRUE(QTest::qWaitFor([this] { return !window_.tasks().isBusy(); }, kPatienceMs));
  EXPECT_NE(seedIn(window_.document().session()), 0.25);
  EXPECT_FALSE(window_.document().isModified());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "one.boresight.journal.aside-1"));
}

}  // namespace
}  // namespace boresight::ui
