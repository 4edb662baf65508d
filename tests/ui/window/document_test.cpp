// SPDX-License-Identifier: Apache-2.0
#include "ui/state/document.h"

#include <gtest/gtest.h>

#include <fstream>
#include <new>
#include <utility>

#include <QSignalSpy>

#include "sessions/session/session_file.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window/full_disk.h"
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

/// The same with another seed of the last case.
sessions::Session withSeed(const sessions::Session& session, double x_m) {
  return sessions::withChanged(session, session.cases.back()->id, [x_m](auto& session_case) {
    session_case.camera_from_station_seed.translation_m.x() = x_m;
  });
}

sessions::Session withView(sessions::Session session) {
  session.view.case_id = session.cases.back()->id;
  return session;
}

TEST_F(DocumentTest, RefusedEdit_IsPerformedWhereItsReportSavesTheSession) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  const auto elsewhere = folder_.path() / "two.boresight.json";
  bool reported = false;
  QObject::connect(&document, &Document::writeFailed, [&] {
    std::filesystem::remove(folder_.path() / "one.boresight.journal");
    if (std::exchange(reported, true)) return;
    EXPECT_TRUE(document.note(withView, QStringLiteral("Show")));  // as a run that ends meanwhile
    EXPECT_TRUE(document.saveAs(elsewhere));
  });
  std::filesystem::create_directory(folder_.path() / "one.boresight.journal");
  EXPECT_TRUE(document.edit(withSeed(document.session(), 0.5), QStringLiteral("Move")));
  EXPECT_TRUE(reported);
  EXPECT_EQ(document.session(), withView(withSeed(exampleSession(), 0.5)));
  EXPECT_EQ(sessions::readSessionFile(elsewhere).session, document.session());
  EXPECT_TRUE(document.canUndo());
}

TEST_F(DocumentTest, RefusedEdit_IsDroppedAfterItsReport) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  std::filesystem::create_directory(folder_.path() / "one.boresight.journal");
  EXPECT_FALSE(document.edit(withSeed(document.session(), 0.5), QStringLiteral("Move")));
  std::filesystem::remove(folder_.path() / "one.boresight.journal");
  ASSERT_TRUE(document.note(withView, QStringLiteral("Show")));
  ASSERT_TRUE(document.saveAs(folder_.path() / "two.boresight.json"));
  EXPECT_EQ(document.session(), withView(exampleSession()));
}

TEST_F(DocumentTest, EventWithoutAChange_IsNoChange) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  QSignalSpy changes(&document, &Document::changed);
  EXPECT_TRUE(document.note([](const auto& session) { return session; }, QStringLiteral("Run")));
  EXPECT_EQ(changes.size(), 0);
}

TEST_F(DocumentTest, ExceptionOfAnyKind_EndsInASentence) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  QSignalSpy failures(&document, &Document::failed);
  EXPECT_FALSE(document.note([](const auto&) -> sessions::Session { throw std::bad_alloc(); },
                             QStringLiteral("Run")));
  ASSERT_EQ(failures.size(), 1);
  EXPECT_TRUE(test::has(failures[0][0].toString(), "memory"));
  EXPECT_EQ(document.session(), exampleSession());
}

TEST_F(DocumentTest, GoToEditThatFailsHalfWay_ShowsTheStateThatItReached) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  ASSERT_TRUE(document.edit(withoutFirst(document.session()), QStringLiteral("Remove")));
  const auto journal_bytes = [this] {
    return std::filesystem::file_size(folder_.path() / "one.boresight.journal");
  };
  const auto before_move = journal_bytes();
  ASSERT_TRUE(document.edit(withSeed(document.session(), 0.5), QStringLiteral("Move")));
  const auto move = journal_bytes() - before_move;
  QSignalSpy changes(&document, &Document::changed);
  QSignalSpy failures(&document, &Document::writeFailed);
  {
    const test::FullDisk disk(journal_bytes() + move + 100);  // room for the first step alone
    EXPECT_FALSE(document.goToEdit(0));
  }
  EXPECT_EQ(document.editsDone(), 1u);
  EXPECT_EQ(document.session(), withoutFirst(exampleSession()));
  EXPECT_EQ(changes.size(), 1);
  EXPECT_EQ(failures.size(), 1);
}

TEST_F(DocumentTest, OpeningTheOpenSession_KeepsItEditable) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  ASSERT_TRUE(document.open(file_));
  EXPECT_TRUE(document.isEditable());
  const sessions::Session edited = withSeed(exampleSession(), 0.5);
  ASSERT_TRUE(document.edit(edited, QStringLiteral("Move")));
  ASSERT_TRUE(document.open(file_));
  EXPECT_EQ(document.session(), edited) << "its changes are kept";
  ASSERT_TRUE(document.open(file_, Former::kDiscard));
  EXPECT_EQ(document.session(), exampleSession());
  EXPECT_FALSE(document.canUndo());
  sessions::writeSessionFile(file_, edited);
  ASSERT_TRUE(document.open(file_));
  EXPECT_EQ(document.session(), edited) << "the file is read again";
  EXPECT_TRUE(document.edit(exampleSession(), QStringLiteral("Move back")));
  EXPECT_TRUE(document.save());
}

TEST_F(DocumentTest, DiscardWithASessionThatDoesNotOpen_KeepsTheChanges) {
  Document document;
  ASSERT_TRUE(document.create(file_, exampleSession()));
  ASSERT_TRUE(document.edit(withoutFirst(document.session()), QStringLiteral("Remove a case")));
  EXPECT_FALSE(document.open(folder_.write("bad.boresight.json", "{}"), Former::kDiscard));
  EXPECT_EQ(document.session(), withoutFirst(exampleSession()));
  EXPECT_TRUE(document.canUndo());
  const auto two = folder_.path() / "two.boresight.json";
  sessions::writeSessionFile(two, exampleSession());
  ASSERT_TRUE(document.open(two, Former::kDiscard));
  ASSERT_TRUE(document.open(file_));
  EXPECT_EQ(document.recovery(), nullptr);
  EXPECT_EQ(document.session(), exampleSession());
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
  document.close(Former::kDiscard);
  EXPECT_FALSE(document.isOpen());
  EXPECT_FALSE(Document::leftUntitled().has_value());
  for (const auto& entry : std::filesystem::directory_iterator(Document::untitledFolder()))
    ADD_FAILURE() << entry.path() << " is left";
}

TEST_F(UntitledDocument, ThatAProgramHasOpen_IsNotRemoved) {
  Document document;
  ASSERT_TRUE(document.createUntitled(exampleSession()));
  EXPECT_FALSE(Document::removeUntitled(document.file()));
  EXPECT_TRUE(std::filesystem::exists(document.file()));
  document.close(Former::kDiscard);
}

TEST_F(UntitledDocument, Listing_LeavesItsJournalAsItIs) {
  Document document;
  ASSERT_TRUE(document.createUntitled(exampleSession()));
  const std::filesystem::path file = document.file();
  document.close();
  const std::filesystem::path journal = sessions::journalFileOf(file);
  std::ofstream(journal) << "of another state";
  EXPECT_EQ(Document::leftUntitled(), file);
  EXPECT_TRUE(std::filesystem::exists(journal));
  EXPECT_TRUE(Document::removeUntitled(file));
  EXPECT_TRUE(std::filesystem::is_empty(Document::untitledFolder()));
}

TEST_F(UntitledDocument, DiscardedForAnotherSession_IsDeletedOnceThatIsOpen) {
  const test::TemporaryFolder folder;
  Document document;
  ASSERT_TRUE(document.createUntitled(exampleSession()));
  EXPECT_FALSE(document.open(folder.path() / "nothing.json", Former::kDiscard));
  EXPECT_TRUE(document.isUntitled());
  const auto named = folder.path() / "named.boresight.json";
  sessions::writeSessionFile(named, exampleSession());
  ASSERT_TRUE(document.open(named, Former::kDiscard));
  EXPECT_TRUE(std::filesystem::is_empty(Document::untitledFolder()));
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
  document.close(Former::kDiscard);
  EXPECT_TRUE(std::filesystem::exists(named));
}

}  // namespace
}  // namespace boresight::ui
