// SPDX-License-Identifier: Apache-2.0
// A session is found again under the name that was typed, and what was discarded is gone.
#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/review/pose_export.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

using BoxAnswer = test::ModalAnswer<QMessageBox>;

class SessionSavingTest : public test::WindowTest {
 protected:
  SessionFiles& files() { return *window_.findChild<SessionFiles*>(); }
};

TEST(SessionName, WithoutASuffixGetsTheOneThatIsListed) {
  EXPECT_EQ(sessionFileName("/a/sol"), "/a/sol.boresight.json");
  EXPECT_EQ(sessionFileName("/a/sol.412"), "/a/sol.412.boresight.json");
  EXPECT_EQ(sessionFileName("/a/sol.json"), "/a/sol.json");
  EXPECT_EQ(sessionFileName("/a/sol.boresight.json"), "/a/sol.boresight.json");
}

TEST_F(SessionSavingTest, DiscardedChangesAreNotOfferedAgain) {
  openExample();
  moveSeed(0.01);
  ASSERT_TRUE(window_.document().isModified());
  const BoxAnswer answer([](QMessageBox& box) { box.button(QMessageBox::Discard)->click(); });
  EXPECT_EQ(files().mayLeave(), Former::kDiscard);
  EXPECT_TRUE(window_.document().isModified()) << "until it is left";
  files().closeSession();
  EXPECT_FALSE(window_.document().isOpen());
  ASSERT_TRUE(window_.document().open(file_));
  EXPECT_EQ(window_.document().recovery(), nullptr);
  ASSERT_TRUE(rests());
}

/// Adds the four files of os to the open session, and answers what it asks.
TEST_F(SessionSavingTest, CaseOfAKnownName_IsNeverReplacedWithoutAnAnswer) {
  openExample();
  const std::filesystem::path os = test::exampleFolder() / "os";
  const auto add = [&](const char* button) {
    bool asked = false;
    const BoxAnswer answer([&asked, button](QMessageBox& box) {
      asked = true;
      auto* chosen = box.findChild<QAbstractButton*>(QString::fromUtf8(button));
      (chosen ? chosen : box.button(QMessageBox::Cancel))->click();
    });
    window_.takeFiles({os / "image.png", os / "camera.json", os / "model.ply"});
    files().setMeshUnit("m");
    window_.takeFiles({os / "seed.json"});
    EXPECT_TRUE(rests());
    return asked;
  };
  const auto count = [&] { return window_.document().session().cases.size(); };
  const std::size_t before = count();
  EXPECT_FALSE(add(""));
  EXPECT_EQ(count(), before + 1);
  const std::string id = window_.document().session().cases[before]->id;
  EXPECT_TRUE(add("cancel"));
  EXPECT_EQ(count(), before + 1);
  EXPECT_EQ(files().situation().added, 4) << "the slots are kept";
  EXPECT_TRUE(add("keepBoth"));
  EXPECT_EQ(count(), before + 2);
  EXPECT_EQ(window_.document().session().cases[before + 1]->id, id + "-2");
  EXPECT_EQ(files().situation().added, 0);
  EXPECT_TRUE(add("replaceCase"));
  EXPECT_EQ(count(), before + 2);
  window_.document().save();
}

/// The question was about the name as it was typed, without the suffix.
TEST_F(SessionSavingTest, ExportUnderANameWithoutSuffix_AsksBeforeItReplacesAFile) {
  folder_.write("points.json", "kept");
  bool asked = false;
  const BoxAnswer answer([&asked](QMessageBox& box) {
    asked = true;
    box.reject();
  });
  const test::ModalAnswer<QFileDialog> names([&asked, this](QFileDialog& dialog) {
    if (asked) return dialog.reject();
    auto* name = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
    name->setText(QString::fromStdString((folder_.path() / "points").string()));
    QTest::keyClick(name, Qt::Key_Return);
  });
  const auto proposed = QString::fromStdString((folder_.path() / "annotations.json").string());
  EXPECT_EQ(askForNewFile(window_, QStringLiteral("Export"), proposed, QStringLiteral("(*.json)")),
            std::filesystem::path());
  EXPECT_TRUE(asked);
}

TEST_F(SessionSavingTest, ExportsOfAnUnnamedSessionAreNotProposedInAHiddenFolder) {
  ASSERT_TRUE(window_.document().createUntitled(test::exampleSession()));
  const QString proposed = inSessionFolder(window_.document(), QStringLiteral("pose.json"));
  EXPECT_FALSE(proposed.contains(QStringLiteral("untitled"))) << proposed.toStdString();
  EXPECT_FALSE(proposed.contains(QStringLiteral("/."))) << proposed.toStdString();
  ASSERT_TRUE(rests());
  window_.document().close(Former::kDiscard);
}

}  // namespace
}  // namespace boresight::ui
