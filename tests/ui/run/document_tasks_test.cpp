// SPDX-License-Identifier: Apache-2.0
#include "ui/run/document_tasks.h"

#include <gtest/gtest.h>
#include <QSignalSpy>
#include <QStringList>
#include <QtTest/QTest>

#include <future>
#include <optional>

#include "sessions/session/session_document.h"
#include "tests/support/temporary_folder.h"
#include "tests/ui/patience.h"
#include "ui/state/document.h"

namespace boresight::ui {
namespace {

/// A session with an unsaved edit of an earlier program, and a task that begins before `event`.
class DocumentTasksTest : public testing::Test {
 protected:
  DocumentTasksTest() {
    sessions::SessionDocument::create(other_, {});
    auto earlier = sessions::SessionDocument::create(file_, {});
    sessions::Session edited = earlier.session();
    edited.robust_annotations = true;
    earlier.apply(edited, "Edit");
  }

  /// What became of the task: its value, or the sentence about it.
  template <class Event>
  QString resultAfter(const Event& event) {
    std::promise<void> gate;
    QString result;
    const QSignalSpy dropped(&of_document_, &DocumentTasks::failed);
    of_document_.ofDocument(
        {QStringLiteral("The task"), QStringLiteral("begin it again")},
        [held = gate.get_future().share()](const std::stop_token&) {
          held.wait();
          return QStringLiteral("used");
        },
        [&result](const QString& value) { result = value; },
        [&result](const QString& message) { result = message; });
    event();
    gate.set_value();
    EXPECT_TRUE(QTest::qWaitFor([this] { return !tasks_.isBusy(); }, test::kPatienceMs));
    return dropped.isEmpty() ? result : dropped.first().first().toString();
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "one.boresight.json";
  const std::filesystem::path other_ = folder_ / "two.boresight.json";
  Document document_;
  TaskRunner tasks_;
  DocumentTasks of_document_{document_, tasks_};
};

TEST_F(DocumentTasksTest, RecoveryOfTheSession_KeepsTheResult) {
  ASSERT_TRUE(document_.open(file_));
  ASSERT_NE(document_.recovery(), nullptr);
  EXPECT_EQ(resultAfter([this] { EXPECT_TRUE(document_.acceptRecovery()); }),
            QStringLiteral("used"));
}

TEST_F(DocumentTasksTest, DeclinedRecoveryAndReadingAgain_KeepTheResult) {
  ASSERT_TRUE(document_.open(file_));
  EXPECT_EQ(resultAfter([this] { EXPECT_TRUE(document_.declineRecovery()); }),
            QStringLiteral("used"));
  EXPECT_EQ(resultAfter([this] { EXPECT_TRUE(document_.open(file_, Former::kDiscard)); }),
            QStringLiteral("used"));
}

TEST_F(DocumentTasksTest, AnotherSession_DropsTheResultAndNamesTheFormer) {
  EXPECT_EQ(resultAfter([this] { EXPECT_TRUE(document_.open(file_)); }),
            QStringLiteral("The task was not used: another session was opened. To use it there, "
                           "begin it again."));
  EXPECT_EQ(resultAfter([this] { EXPECT_TRUE(document_.open(other_)); }),
            QStringLiteral("The task was not used: it belongs to %1, which is not open any more. "
                           "Open that session and begin it again.")
                .arg(QString::fromStdString(file_.string())));
}

}  // namespace
}  // namespace boresight::ui
