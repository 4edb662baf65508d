// SPDX-License-Identifier: Apache-2.0
// A session is found again under the name that was typed, and what was discarded is gone.
#include "tests/ui/window_test.h"
#include "ui/review/pose_export.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

/// Answers the next dialog on its way.
class Answer {
 public:
  explicit Answer(std::function<bool(QWidget*)> answer) : answer_(std::move(answer)) {
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] {
      QWidget* modal = QApplication::activeModalWidget();
      if (modal && answer_(modal)) timer_.stop();
    });
    timer_.start(20);
  }

 private:
  std::function<bool(QWidget*)> answer_;
  QTimer timer_;
};

class SessionSavingTest : public test::WindowTest {
 protected:
  SessionFiles& files() { return *window_.findChild<SessionFiles*>(); }
};

TEST_F(SessionSavingTest, NameWithoutASuffixGetsTheOneThatIsListed) {
  EXPECT_EQ(sessionFileName("/a/sol"), "/a/sol.boresight.json");
  EXPECT_EQ(sessionFileName("/a/sol.412"), "/a/sol.412.boresight.json");
  EXPECT_EQ(sessionFileName("/a/sol.json"), "/a/sol.json");
  EXPECT_EQ(sessionFileName("/a/sol.boresight.json"), "/a/sol.boresight.json");
}

TEST_F(SessionSavingTest, DiscardedChangesAreNotOfferedAgain) {
  openExample();
  moveSeed(0.01);
  ASSERT_TRUE(window_.document().isModified());
  const Answer answer([](QWidget* modal) {
    auto* box = qobject_cast<QMessageBox*>(modal);
    if (!box) return false;
    box->button(QMessageBox::Discard)->click();
    return true;
  });
  ASSERT_TRUE(files().mayLeave());
  EXPECT_FALSE(window_.document().isModified());
  window_.document().close();
  ASSERT_TRUE(window_.document().open(file_));
  EXPECT_EQ(window_.document().recovery(), nullptr);
  ASSERT_TRUE(rests());
}

TEST_F(SessionSavingTest, ExportsOfAnUnnamedSessionAreNotProposedInAHiddenFolder) {
  ASSERT_TRUE(window_.document().createUntitled(
      sessions::makeSession(test::exampleFolder() / "dataset.json")));
  const QString proposed = inSessionFolder(window_.document(), QStringLiteral("pose.json"));
  EXPECT_FALSE(proposed.contains(QStringLiteral("untitled"))) << proposed.toStdString();
  EXPECT_FALSE(proposed.contains(QStringLiteral("/."))) << proposed.toStdString();
  ASSERT_TRUE(rests());
  window_.document().discardUntitled();
}

}  // namespace
}  // namespace boresight::ui
