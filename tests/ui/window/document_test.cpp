// SPDX-License-Identifier: Apache-2.0
#include "ui/state/document.h"

#include <gtest/gtest.h>

#include <QSignalSpy>

#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"

namespace boresight::ui {
namespace {

using test::exampleSession;

sessions::Session withoutFirst(const sessions::Session& session) {
  return sessions::withoutCase(session, session.cases.front()->id);
}

class DocumentTest : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "one.boresight.json";
};

TEST_F(DocumentTest, EditsAreUndoneAndRedone) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  EXPECT_FALSE(document.isModified());
  EXPECT_FALSE(document.canUndo());
  QSignalSpy changes(&document, &Document::changed);
  ASSERT_TRUE(document.edit(withoutFirst(document.session()), QStringLiteral("Remove a case")));
  EXPECT_EQ(changes.size(), 1);
  EXPECT_TRUE(document.isModified());
  EXPECT_EQ(document.undoText(), QStringLiteral("Remove a case"));
  ASSERT_TRUE(document.undo());
  EXPECT_EQ(document.session(), exampleSession());
  EXPECT_FALSE(document.isModified());
  ASSERT_TRUE(document.redo());
  EXPECT_EQ(document.session(), withoutFirst(exampleSession()));
  EXPECT_FALSE(document.redo());
}

TEST_F(DocumentTest, SecondProgram_OpensReadOnly) {
  Document first;
  ASSERT_TRUE(first.create(file_, exampleSession()));
  Document second;
  ASSERT_TRUE(second.open(file_));
  EXPECT_FALSE(second.readOnlyReason().isEmpty());
  QSignalSpy failures(&second, &Document::writeFailed);
  EXPECT_FALSE(second.edit(withoutFirst(exampleSession()), QStringLiteral("Remove a case")));
  EXPECT_EQ(failures.size(), 1);
  EXPECT_EQ(second.session(), exampleSession());
}

TEST_F(DocumentTest, UnreadableSession_IsReportedInOneSentence) {
  Document document;
  QSignalSpy failures(&document, &Document::failed);
  EXPECT_FALSE(document.open(folder_.path() / "nothing.json"));
  ASSERT_EQ(failures.size(), 1);
  EXPECT_TRUE(failures[0][0].toString().contains(QStringLiteral("nothing.json")));
  EXPECT_FALSE(document.isOpen());
  EXPECT_FALSE(document.save());
  EXPECT_FALSE(document.undo());
}

class UntitledDocument : public ::testing::Test {
  const test::OwnDataFolder data_;
};

TEST_F(UntitledDocument, IsOfferedUntilItIsDiscarded) {
  EXPECT_FALSE(Document::leftUntitled().has_value());
  Document document;
  ASSERT_TRUE(document.createUntitled(sessions::Session()));
  const std::filesystem::path file = document.file();
  EXPECT_FALSE(Document::leftUntitled().has_value()) << "another program has it open";
  document.close();
  EXPECT_EQ(Document::leftUntitled(), file);
  ASSERT_TRUE(document.open(file));
  EXPECT_TRUE(document.isUntitled());
  document.discardUntitled();
  EXPECT_FALSE(document.isOpen());
  EXPECT_FALSE(Document::leftUntitled().has_value());
  for (const auto& entry : std::filesystem::directory_iterator(Document::untitledFolder()))
    ADD_FAILURE() << entry.path() << " is left";
}

TEST_F(UntitledDocument, GivenANameItIsNotOfferedAgainAndNeverDiscarded) {
  const test::TemporaryFolder folder;
  const auto named = folder.path() / "named.boresight.json";
  Document document;
  ASSERT_TRUE(document.createUntitled(exampleSession()));
  ASSERT_TRUE(document.saveAs(named));
  EXPECT_FALSE(document.isUntitled());
  EXPECT_TRUE(std::filesystem::is_empty(Document::untitledFolder()));
  document.close();
  ASSERT_TRUE(document.open(named));
  EXPECT_EQ(document.session().cases.size(), exampleSession().cases.size());
  document.discardUntitled();
  EXPECT_TRUE(document.isOpen());
  EXPECT_TRUE(std::filesystem::exists(named));
}

}  // namespace
}  // namespace boresight::ui
