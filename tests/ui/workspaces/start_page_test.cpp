// SPDX-License-Identifier: Apache-2.0
#include "ui/window/start_page.h"

#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/window/session_files.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

class StartPageTest : public test::WindowTest {
 protected:
  void TearDown() override { window_.document().close(Former::kDiscard); }
  StartPage& page() { return window_.frame().start(); }
  SessionFiles& files() { return *window_.findChild<SessionFiles*>(); }
  bool caseIsMade() {
    return wait([this] { return window_.state().currentCase() && resting(); });
  }
  QStringList texts() {
    QStringList all;
    for (const QLabel* label : page().findChildren<QLabel*>())
      if (label->isVisibleTo(&page())) all << label->text();
    return all;
  }

  const std::filesystem::path os_ = test::exampleFolder() / "os";
};

TEST_F(StartPageTest, SlotsTellWhatIsMissing) {
  EXPECT_EQ(texts().count(QStringLiteral("+ still needed")), 4);
  window_.takeFiles({os_ / "image.png", os_ / "camera.json"});
  EXPECT_EQ(texts().count(QStringLiteral("+ still needed")), 2);
  EXPECT_EQ(texts().count(QStringLiteral("✓ added")), 2);
  EXPECT_TRUE(texts().contains(QStringLiteral("image.png")));
  EXPECT_TRUE(wait([&] {
    return window_.frame().verdict().verdict().head == QStringLiteral("2 of 4 files added");
  }));
}

/// What is wrong stands at its file, and no case is made of it.
TEST_F(StartPageTest, FilesAreJudgedAsTheyCome_AndRemoved) {
  const auto small = folder_.path() / "small.png";
  sessions::writePng(small, std::vector<std::uint8_t>(640 * 480, 9), 640, 480, 1);
  window_.takeFiles({small, os_ / "camera.json"});
  ASSERT_TRUE(wait([&] { return texts().contains(QStringLiteral("✗ not usable")); }));
  EXPECT_TRUE(texts().contains(QStringLiteral("640 x 480 px, 8 bit")));
  const auto& picture = find<QLabel>("slotPicture0");
  ASSERT_TRUE(picture.isVisibleTo(&page()));
  EXPECT_EQ(picture.sizeHint(), QSize(128, 96));
  const QString problem =
      QStringLiteral("The camera is for 1024 x 1024 px, the image is 640 x 480 px.");
  EXPECT_TRUE(texts().contains(problem));
  const auto& verdict = window_.frame().verdict();
  ASSERT_TRUE(wait([&] { return verdict.verdict().sentence == problem; }));
  EXPECT_EQ(verdict.verdict().step_text, QStringLiteral("Choose camera..."));
  files().setMeshUnit("m");
  window_.takeFiles({os_ / "model.ply"});
  files().setMeshUnit("m");
  window_.takeFiles({os_ / "seed.json"});
  ASSERT_TRUE(rests());
  EXPECT_TRUE(window_.document().session().cases.empty()) << "it could not be run";
  find<QToolButton>("slotRemove0").click();
  ASSERT_TRUE(rests());
  EXPECT_EQ(texts().count(QStringLiteral("✓ added")), 3);
  EXPECT_FALSE(picture.isVisibleTo(&page()));
  window_.takeFiles({os_ / "image.png"});
  ASSERT_TRUE(caseIsMade()) << window_.lastMessage().toStdString();
}

TEST_F(StartPageTest, UnreadableFile_IsShownAtItsSlotOnly) {
  const auto text = folder_.path() / "text.png";
  std::ofstream(text) << "no image";
  window_.takeFiles({text, os_ / "camera.json"});
  ASSERT_TRUE(wait([&] { return texts().contains(QStringLiteral("✗ not usable")); }));
  EXPECT_EQ(texts().count(QStringLiteral("✓ added")), 1) << "the camera";
}

/// Cancelling the question for the unit leaves all files; the unit's choice then makes the case.
TEST_F(StartPageTest, UnitChosenAtTheSlot_MakesTheCase) {
  {
    const test::ModalAnswer<QDialog> cancels([](QDialog& dialog) { dialog.reject(); });
    window_.takeFiles(
        {os_ / "image.png", os_ / "camera.json", os_ / "model.ply", os_ / "seed.json"});
    ASSERT_TRUE(rests());
  }
  EXPECT_EQ(texts().count(QStringLiteral("✓ added")), 4) << "they stay";
  EXPECT_TRUE(window_.document().session().cases.empty());
  ASSERT_TRUE(wait([&] { return !page().findChildren<QRadioButton*>().isEmpty(); }));
  page().findChildren<QRadioButton*>().front()->click();
  ASSERT_TRUE(caseIsMade()) << window_.lastMessage().toStdString();
}

TEST_F(StartPageTest, ThreeFilesMakeACaseToBeAnnotated) {
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  auto& make = find<QPushButton>("makeSeedless");
  ASSERT_TRUE(make.isVisibleTo(&window_));
  make.click();
  ASSERT_TRUE(caseIsMade()) << window_.lastMessage().toStdString();
  EXPECT_FALSE(window_.state().currentCase()->source.has_seed);
}

TEST_F(StartPageTest, MeshIsMeasuredInEachUnit) {
  window_.takeFiles({test::exampleFolder() / "bc" / "model.ply"});
  ASSERT_TRUE(wait([&] { return !page().findChildren<QRadioButton*>().isEmpty(); }));
  const auto choices = page().findChildren<QRadioButton*>();
  ASSERT_EQ(choices.size(), 5);
  EXPECT_TRUE(test::has(choices[0]->text(), "m: "));
  EXPECT_TRUE(test::has(choices[0]->text(), "mm across"));
  choices[1]->click();
  EXPECT_EQ(files().collected().one.parts.front().mesh_unit, "mm");
}

TEST_F(StartPageTest, OneClickOpensAnExampleAndRunsIt) {
  find<QPushButton>("openExample").click();
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 1 && resting(); }))
      << window_.lastMessage().toStdString();
  EXPECT_TRUE(window_.state().snapshot()->converged());
  EXPECT_TRUE(window_.document().isUntitled()) << "the shipped file stays as it is";
  EXPECT_EQ(window_.workspaces().current(), Workspace::kRun);
}

TEST_F(StartPageTest, FilesMakeACaseOfTheOpenSession) {
  openExample();
  window_.workspaces().show(Workspace::kStart);
  EXPECT_TRUE(test::has(find<QLabel>("newCase").text(), "New case of one.boresight.json"));
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  find<QPushButton>("makeSeedless").click();
  ASSERT_TRUE(wait([&] { return window_.document().session().cases.size() == 3 && resting(); }));
  EXPECT_EQ(window_.workspaces().current(), Workspace::kRun);
  EXPECT_FALSE(window_.state().currentCase()->source.has_seed);
  EXPECT_EQ(window_.document().file(), file_);
}

/// The second click asked whether to replace the case of the first.
TEST_F(StartPageTest, DoubleClick_MakesOneCase) {
  openExample();
  window_.workspaces().show(Workspace::kStart);
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  int questions = 0;
  const test::ModalAnswer<QMessageBox> cancels([&questions](QMessageBox& box) {
    ++questions;
    box.reject();
  });
  auto& make = find<QPushButton>("makeSeedless");
  make.click();
  make.click();
  ASSERT_TRUE(wait([&] { return window_.document().session().cases.size() == 3 && resting(); }));
  EXPECT_EQ(questions, 0);
}

TEST_F(StartPageTest, SessionThatIsReadAgainWhileACaseIsMade_GetsTheCase) {
  openExample();
  window_.workspaces().show(Workspace::kStart);
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  find<QPushButton>("makeSeedless").click();
  ASSERT_TRUE(files().open(file_, Former::kDiscard));
  ASSERT_TRUE(wait([&] { return window_.document().session().cases.size() == 3 && resting(); }));
}

TEST_F(StartPageTest, RequestThatIsWithdrawn_LeavesNoNoteOfItsReading) {
  QStringList notes;
  QObject::connect(&files(), &SessionFiles::noted, &window_,
                   [&notes](const QString& text) { notes << text; });
  openExample();
  window_.workspaces().show(Workspace::kStart);
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  QObject::connect(&files(), &SessionFiles::noted, &window_, [this](const QString& text) {
    if (text.startsWith(QStringLiteral("Reading"))) files().removeFile(InputKind::kCamera);
  });
  find<QPushButton>("makeSeedless").click();
  ASSERT_TRUE(wait([&] { return files().collected().count() == 2 && resting(); }));
  ASSERT_FALSE(notes.isEmpty());
  EXPECT_EQ(notes.back(), QString());
  EXPECT_EQ(window_.document().session().cases.size(), 2u);
}

/// The case of the files before the correction was added.
TEST_F(StartPageTest, CorrectedFilesAndUnit_ReplaceTheRequestBefore) {
  int questions = 0;
  const test::ModalAnswer<QMessageBox> cancels([&questions](QMessageBox& box) {
    ++questions;
    box.reject();
  });
  const auto bc = test::exampleFolder() / "bc";
  const auto better = folder_.path() / "better_seed.json";
  std::filesystem::copy_file(bc / "truth.json", better);
  window_.takeFiles({bc / "image.png", bc / "camera.json", bc / "model.ply"});
  files().setMeshUnit("mm");
  window_.takeFiles({bc / "seed.json"});
  files().setMeshUnit("m");
  folder_.write("notes.txt", "hello");
  window_.takeFiles({folder_.path() / "notes.txt"});
  window_.takeFiles({better});
  const sessions::CaseFiles wanted = files().collected().one;
  EXPECT_EQ(wanted.seed, better);
  ASSERT_TRUE(caseIsMade());
  ASSERT_TRUE(rests());
  ASSERT_EQ(window_.document().session().cases.size(), 1u);
  const sessions::SessionCase& made = *window_.document().session().cases.front();
  EXPECT_EQ(made.parts.front().source.mesh_unit, "m");
  EXPECT_EQ(made.camera_from_station_seed,
            sessions::makeCase(wanted).made.camera_from_station_seed);
  EXPECT_EQ(questions, 0);
}

/// They were forgotten with those of the case that was being made.
TEST_F(StartPageTest, FilesDroppedWhileACaseIsMade_Stay) {
  openExample();
  window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
  files().setMeshUnit("m");
  files().makeSeedless();
  const auto bc = test::exampleFolder() / "bc";
  window_.takeFiles({bc / "image.png", bc / "camera.json"});
  ASSERT_TRUE(wait([&] { return window_.document().session().cases.size() == 3 && resting(); }));
  EXPECT_EQ(files().collected().one.image, bc / "image.png");
  EXPECT_EQ(files().collected().count(), 2);
}

/// The answer was taken for the session that was open by then.
TEST_F(StartPageTest, CaseThatIsAskedAbout_DoesNotReachAnotherSession) {
  openExample();
  const auto make = [&] {
    window_.takeFiles({os_ / "image.png", os_ / "camera.json", os_ / "model.ply"});
    files().setMeshUnit("m");
    files().makeSeedless();
  };
  make();
  ASSERT_TRUE(wait([&] { return window_.document().session().cases.size() == 3 && resting(); }));
  bool asked = false;
  const test::ModalAnswer<QMessageBox> keeps_both([&](QMessageBox& box) {
    auto* both = box.findChild<QAbstractButton*>(QStringLiteral("keepBoth"));
    if (both == nullptr || std::exchange(asked, true)) return box.reject();
    ASSERT_TRUE(
        window_.document().create(folder_ / "other.boresight.json", window_.document().session()));
    both->click();
  });
  make();
  ASSERT_TRUE(wait([&] { return asked && resting(); }));
  EXPECT_EQ(window_.document().session().cases.size(), 3u);
  EXPECT_TRUE(test::has(window_.lastMessage(), "another session was opened"));
}

TEST(LeftWork, IsOfferedAndRecoveredOrDiscarded) {
  const test::OwnDataFolder data;
  for (const char* button : {"recoverLeft", "discardLeft"}) {
    {
      Document left;
      const sessions::Session& session = test::exampleSession();
      ASSERT_TRUE(left.createUntitled(session));
      left.edit(sessions::withoutCase(session, session.cases.front()->id), QStringLiteral("Edit"));
    }
    MainWindow window;
    window.setQuiet(true);
    window.show();
    auto* card = window.findChild<QFrame*>(QStringLiteral("leftWork"));
    ASSERT_TRUE(card->isVisibleTo(&window));
    window.findChild<QPushButton*>(QLatin1String(button))->click();
    const bool recovers = std::string(button) == "recoverLeft";
    if (!recovers) {
      EXPECT_TRUE(Document::leftUntitled().has_value()) << "one click deletes nothing";
      window.findChild<QPushButton*>(QLatin1String(button))->click();
    }
    EXPECT_EQ(window.document().isUntitled(), recovers);
    EXPECT_EQ(window.document().session().cases.size(), recovers ? 1u : 0u);
    EXPECT_FALSE(window.document().recovery()) << "it is not asked for again";
    if (recovers) window.document().close(Former::kDiscard);
    EXPECT_FALSE(Document::leftUntitled().has_value());
  }
}

TEST(LeftWork, AnotherSession_NeedsItsOwnFirstClickToBeDeleted) {
  const test::OwnDataFolder data;
  for (int i = 0; i < 2; ++i) {
    Document left;
    ASSERT_TRUE(left.createUntitled(test::exampleSession()));
    QTest::qWait(2);  // names hold the time
  }
  MainWindow window;
  window.setQuiet(true);
  window.show();
  auto* discard = window.findChild<QPushButton*>(QStringLiteral("discardLeft"));
  discard->click();
  window.findChild<QPushButton*>(QStringLiteral("recoverLeft"))->click();
  ASSERT_TRUE(window.document().isUntitled());
  const test::TemporaryFolder folder;
  ASSERT_TRUE(window.document().saveAs(folder.path() / "named.boresight.json"));
  window.workspaces().show(Workspace::kStart);
  ASSERT_TRUE(discard->isVisibleTo(&window));
  EXPECT_EQ(discard->text(), QStringLiteral("Discard"));
  discard->click();
  EXPECT_TRUE(Document::leftUntitled().has_value());
  discard->click();
  EXPECT_FALSE(Document::leftUntitled().has_value());
}

}  // namespace
}  // namespace boresight::ui
