// SPDX-License-Identifier: Apache-2.0
#include "ui/window/input_findings.h"

#include "sessions/session/input_check.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

namespace fs = std::filesystem;

/// A session whose inputs lie next to it, so that they can be moved and changed.
class InputFindingsTest : public test::WindowTest {
 protected:
  InputFindingsTest() {
    fs::copy(test::smallExampleFolder(), inputs_, fs::copy_options::recursive);
  }

  void open(const std::vector<std::string>& ids = {test::exampleSession().cases.front()->id}) {
    ASSERT_TRUE(
        window_.document().create(file_, sessions::makeSession(inputs_ / "dataset.json", ids)));
    settle();
  }
  void reopen() {
    window_.document().close();
    ASSERT_TRUE(window_.openSession(file_));
    settle();
  }
  void settle() {
    ASSERT_TRUE(wait([this] { return !window_.findings().isBusy() && !window_.tasks().isBusy(); }));
  }
  fs::path image() const { return inputs_ / "bc" / "image.png"; }

  fs::path inputs_ = folder_.path() / "inputs";
};

TEST_F(InputFindingsTest, AMovedImageIsMissedAtOnceAndFoundAgain) {
  open();
  EXPECT_TRUE(window_.findings().findings().empty());
  fs::create_directories(inputs_ / "elsewhere");
  fs::rename(image(), inputs_ / "elsewhere" / "image.png");
  reopen();
  ASSERT_EQ(window_.findings().findings().size(), 1u);
  EXPECT_EQ(window_.findings().findings()[0].kind, sessions::FindingKind::kMissing);
  EXPECT_EQ(window_.state().currentCase(), nullptr);
  window_.findings().repair();
  settle();
  EXPECT_TRUE(window_.findings().findings().empty());
  EXPECT_NE(window_.state().currentCase(), nullptr) << "the case that could not be read is read";
  EXPECT_TRUE(window_.document().canUndo());
}

TEST_F(InputFindingsTest, MissingImage_NotFoundBelowTheFolder_IsNamedWithWhatToDo) {
  open();
  fs::remove(image());
  reopen();
  const QString hint = window_.image().view().hint();
  EXPECT_TRUE(hint.contains(QString::fromStdString(image().string()))) << hint.toStdString();
  EXPECT_TRUE(test::has(hint, "Fix"));
  EXPECT_FALSE(hint.contains(QStringLiteral("Drop")));
  window_.findings().repair();
  settle();
  EXPECT_TRUE(test::has(window_.lastMessage(), "None of the missing files"));
  EXPECT_EQ(window_.findings().findings().size(), 1u);
}

TEST_F(InputFindingsTest, RestoredFile_IsFoundAndReadByFix) {
  open();
  fs::rename(image(), image().string() + ".away");
  reopen();
  ASSERT_EQ(window_.findings().findings().size(), 1u);
  fs::rename(image().string() + ".away", image());  // as the advice says
  window_.findings().repair();
  settle();
  EXPECT_FALSE(window_.lastMessage().contains(QStringLiteral("None of the missing files")));
  EXPECT_TRUE(window_.findings().findings().empty());
  ASSERT_TRUE(wait([this] { return window_.state().currentCase() != nullptr; }));
}

TEST_F(InputFindingsTest, AnotherFileInPlaceOfAMissingOne_EndsItsFinding) {
  open();
  fs::copy(image(), inputs_ / "bc" / "new.png");
  fs::remove(image());
  reopen();
  ASSERT_EQ(window_.findings().findings().size(), 1u);
  window_.cases().changeInput(window_.cases().caseId(), sessions::InputKind::kImage,
                              inputs_ / "bc" / "new.png", {});
  ASSERT_TRUE(wait([this] { return window_.document().canUndo(); }));
  settle();
  EXPECT_TRUE(window_.findings().findings().empty());
  EXPECT_TRUE(window_.findings().adviceFor(window_.cases().caseId()).isEmpty());
  EXPECT_NE(window_.state().currentCase(), nullptr);
}

TEST_F(InputFindingsTest, AnotherCasesImageIsNotShownUnderTheNameOfOneThatIsMissing) {
  open({});
  const QString first = window_.cases().caseId();
  fs::remove(inputs_ / "os" / "image.png");
  const std::string other = window_.document().session().cases.back()->id;
  ASSERT_NE(other, first.toStdString());
  window_.cases().chooseCase(QString::fromStdString(other));
  settle();
  EXPECT_EQ(window_.state().currentCase(), nullptr);
  EXPECT_TRUE(test::has(window_.image().view().hint(), "image.png"));
  window_.cases().chooseCase(first);
  settle();
  EXPECT_NE(window_.state().currentCase(), nullptr);
}

TEST_F(InputFindingsTest, ChangedFile_IsNotUsedUntilItIsAccepted) {
  open();
  const std::string id = window_.cases().caseId().toStdString();
  const auto hash = [&] { return window_.document().session().findCase(id)->image.source.sha256; };
  const std::string before = hash();
  fs::copy_file(inputs_ / "os" / "image.png", image(), fs::copy_options::overwrite_existing);
  reopen();
  ASSERT_EQ(window_.findings().findings().size(), 1u);
  EXPECT_EQ(window_.findings().findings()[0].kind, sessions::FindingKind::kChanged);
  ASSERT_EQ(window_.state().currentCase(), nullptr);
  EXPECT_TRUE(test::has(window_.image().view().hint(), "accept"));
  const test::ModalAnswer<QMessageBox> yes(
      [](QMessageBox& box) { QTest::mouseClick(box.button(QMessageBox::Yes), Qt::LeftButton); });
  for (auto* button : window_.findChildren<QToolButton*>(QStringLiteral("bannerAction")))
    if (button->isVisible() && button->text().startsWith(QStringLiteral("Fix")))
      QTest::mouseClick(button, Qt::LeftButton);
  settle();
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() != nullptr; }));
  EXPECT_TRUE(window_.findings().findings().empty());
  EXPECT_NE(hash(), before);
  EXPECT_EQ(hash(), sessions::inputSha256(image()));
  EXPECT_EQ(window_.document().undoText(), QStringLiteral("Accept changed files"));
  ASSERT_TRUE(window_.document().undo());
  EXPECT_EQ(hash(), before) << "and it can be taken back";
  settle();
}

}  // namespace
}  // namespace boresight::ui
