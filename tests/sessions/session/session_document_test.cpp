// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_document.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <limits>
#include <optional>
#include <thread>

#include "sessions/io/files/errors.h"
#include "sessions/session/session_file.h"
#include "tests/sessions/session/in_child.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/all_cases.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using namespace sessions;

Session sessionOf(const std::string& name) {
  Random random = randomFor(name);
  return withCase(withCase({}, randomCase(random, "a")), randomCase(random, "b"));
}

/// A session in which something has been done `number` times.
Session edited(const Session& session, int number) {
  Session next = session;
  next.view.case_id = "a";
  next.view.iteration = number;
  return next;
}

/// A session and the file that it is to be in.
struct SessionDocumentTest : testing::Test {
  const TemporaryFolder folder;
  const Session first = sessionOf("first");
  const std::filesystem::path file = folder / "s.json";

  /// Writes it and leaves a document of it that is killed after `edits` edits, unsaved.
  void leaveUnsaved(int edits) const {
    SessionDocument::create(file, first);
    const std::string said = inChild([&]() -> std::string {
      SessionDocument document = SessionDocument::open(file);
      for (int i = 1; i <= edits; ++i)
        document.apply(edited(document.session(), i), "Edit " + std::to_string(i));
      ::kill(::getpid(), SIGKILL);
      return "";
    });
    ASSERT_EQ(said, "the child did not end by itself");
  }
};

/// The line of a journal that precedes a save, after these lines.
std::string savedLine(const std::string& journal, const std::string& session_text) {
  const std::size_t last = journal.rfind('\n', journal.size() - 2) + 1;
  const std::string json = "{\"saved_sha256\": \"" + sha256Text(session_text) + "\"}";
  return sha256Text(journal.substr(last, 16) + json).substr(0, 16) + " " + json + "\n";
}

TEST_F(SessionDocumentTest, DiscardedChanges_AreNotRecovered) {
  {
    SessionDocument document = SessionDocument::create(file, first);
    for (const int number : {1, 2}) {
      document.apply(edited(first, number), "Edit");
      document.discardChanges();
      EXPECT_FALSE(document.modified());
    }
  }
  const SessionDocument again = SessionDocument::open(file);
  EXPECT_FALSE(again.recovery().has_value());
  EXPECT_NE(again.session().view.iteration, 1);
}

TEST_F(SessionDocumentTest, Save_WritesTheEditsAndRemovesTheJournal) {
  {
    SessionDocument document = SessionDocument::create(file, first);
    EXPECT_FALSE(document.modified());
    document.apply(edited(first, 1), "Edit");
    EXPECT_TRUE(document.modified());
    EXPECT_TRUE(std::filesystem::exists(folder / "s.journal"));
    document.save();
    EXPECT_FALSE(document.modified());
    EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
  }
  EXPECT_EQ(folder.fileCount(), 1u);
  const SessionDocument again = SessionDocument::open(file);
  EXPECT_TRUE(again.session() == edited(first, 1));
  EXPECT_FALSE(again.recovery());
  EXPECT_THAT(again.notices(), IsEmpty());
}

TEST_F(SessionDocumentTest, IsNotSavedOverAnInputAndMaySaveOverASession) {
  Random random = randomFor("inputs");
  SessionCase session_case = randomCase(random, "a");
  session_case.image.source.file = folder.write("image.png", "pixels");
  SessionDocument document = SessionDocument::create(file, withCase({}, session_case));
  EXPECT_THROW(document.saveAs(folder / "image.png"), OverwriteError);
  EXPECT_EQ(folder.read("image.png"), "pixels");
  document.saveAs(folder / "t.json");
  document.saveAs(file);
  EXPECT_TRUE(SessionDocument::open(folder / "t.json").session() == document.session());
}

TEST_F(SessionDocumentTest, CreateTouchesNoFileThatIsThere) {
  folder.write("s.json", "mine");
  EXPECT_THAT(folder.message([&] { SessionDocument::create(file, {}); }),
              HasSubstr("the file exists"));
  EXPECT_EQ(folder.read("s.json"), "mine");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST_F(SessionDocumentTest, JournalOfAKilledProgram_IsOffered) {
  leaveUnsaved(3);
  {
    SessionDocument document = SessionDocument::open(file);
    EXPECT_THAT(document.notices(), ElementsAre(HasSubstr("did not close it: process")));
    EXPECT_TRUE(document.session() == first);
    ASSERT_TRUE(document.recovery());
    EXPECT_TRUE(document.recovery()->session == edited(first, 3));
    EXPECT_THAT(document.recovery()->edits, ElementsAre("Edit 1", "Edit 2", "Edit 3"));
    EXPECT_THAT(folder.message([&] { document.apply(edited(first, 9), "x"); }),
                HasSubstr("must be recovered or declined"));
    EXPECT_THAT(folder.message([&] { document.save(); }), HasSubstr("must be recovered"));
  }
  // Neither accepted nor declined: they still wait. Accepted but not saved: they are kept.
  {
    SessionDocument document = SessionDocument::open(file);
    document.acceptRecovery();
    EXPECT_TRUE(document.session() == edited(first, 3));
    EXPECT_TRUE(document.modified());
    document.apply(edited(first, 4), "Edit 4");
  }
  {
    SessionDocument document = SessionDocument::open(file);
    ASSERT_TRUE(document.recovery());
    EXPECT_THAT(document.recovery()->edits,
                ElementsAre("Recover 3 edits: Edit 1, Edit 2, Edit 3", "Edit 4"));
    document.acceptRecovery();
    document.save();
  }
  const SessionDocument document = SessionDocument::open(file);
  EXPECT_FALSE(document.recovery());
  EXPECT_TRUE(document.session() == edited(first, 4));
}

/// In this program and, where it is killed before its journal is gone, in the next.
TEST_F(SessionDocumentTest, EditsThatAreUndone_LeaveNothingToRecover) {
  const std::filesystem::path journal = folder / "s.journal";
  SessionDocument::create(file, first);
  std::string left;
  {
    SessionDocument document = SessionDocument::open(file);
    const Session before = document.session();
    document.apply(edited(before, 1), "Edit");
    EXPECT_TRUE(std::filesystem::exists(journal));
    left = folder.read("s.journal");
    document.apply(before, "Undo: Edit");
    EXPECT_FALSE(document.modified());
    EXPECT_FALSE(std::filesystem::exists(journal));
    document.apply(edited(before, 2), "Edit");
    EXPECT_TRUE(document.modified());
  }
  EXPECT_TRUE(SessionDocument::open(file).recovery()) << "an edit after it";
  folder.write("s.journal", left);
  EXPECT_TRUE(SessionDocument::open(file).recovery());
}

TEST_F(SessionDocumentTest, ADeclinedJournalIsKeptAside) {
  leaveUnsaved(2);
  const std::string journal = folder.read("s.journal");
  SessionDocument document = SessionDocument::open(file);
  document.declineRecovery();
  EXPECT_TRUE(document.session() == first);
  EXPECT_FALSE(document.recovery());
  EXPECT_EQ(folder.read("s.journal.aside-1"), journal);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SessionDocumentTest, JournalDamagedInTheMiddle_IsRecoveredUpToThere) {
  leaveUnsaved(3);
  std::string journal = folder.read("s.journal");
  journal[journal.find("Edit 2")] = 'e';
  folder.write("s.journal", journal);
  SessionDocument document = SessionDocument::open(file);
  ASSERT_TRUE(document.recovery());
  EXPECT_TRUE(document.recovery()->session == edited(first, 1));
  EXPECT_THAT(document.notices(),
              Contains(HasSubstr("is damaged: line 3 is damaged; 1 edit before it")));
  document.acceptRecovery();
  EXPECT_TRUE(document.session() == edited(first, 1));
  EXPECT_EQ(folder.read("s.journal.aside-1"), journal) << "nothing is thrown away";
  document.save();
  EXPECT_TRUE(readSessionFile(file).session == edited(first, 1));
}

TEST_F(SessionDocumentTest, SetsADamagedJournalAside) {
  leaveUnsaved(3);
  folder.write("s.journal", "no journal\n");
  SessionDocument document = SessionDocument::open(file);
  EXPECT_FALSE(document.recovery());
  EXPECT_THAT(document.notices(), Contains(HasSubstr("cannot be used: no line of it is whole")));
  EXPECT_EQ(folder.read("s.journal.aside-1"), "no journal\n");
  document.apply(edited(first, 8), "Edit 8");
  { SessionDocument moved = std::move(document); }
  EXPECT_TRUE(SessionDocument::open(file).recovery()->session == edited(first, 8));
}

TEST_F(SessionDocumentTest, SetsAJournalOfAnotherStateAsideUnlessItsEditsWereSaved) {
  leaveUnsaved(3);
  const std::string journal = folder.read("s.journal");
  {
    // As if the program had ended between writing the file and removing the journal.
    SessionDocument document = SessionDocument::open(file);
    document.acceptRecovery();
    const std::string accepted = folder.read("s.journal");
    document.save();
    folder.write("s.journal", accepted + savedLine(accepted, folder.read("s.json")));
  }
  {
    const SessionDocument document = SessionDocument::open(file);
    EXPECT_FALSE(document.recovery());
    EXPECT_THAT(document.notices(), testing::Each(Not(HasSubstr("journal"))));
    EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
  }
  folder.write("s.journal", journal);
  writeSessionFile(file, sessionOf("another"));
  const SessionDocument document = SessionDocument::open(file);
  EXPECT_FALSE(document.recovery());
  EXPECT_THAT(document.notices(), Contains(HasSubstr("belongs to another state")));
  EXPECT_TRUE(std::filesystem::exists(folder / "s.journal.aside-1"));
}

TEST_F(SessionDocumentTest, KilledBeforeTheSavedFileHasItsName_OffersAllEdits) {
  leaveUnsaved(3);
  const std::string journal = folder.read("s.journal");
  folder.write("s.journal", journal + savedLine(journal, "never written"));
  const SessionDocument document = SessionDocument::open(file);
  ASSERT_TRUE(document.recovery());
  EXPECT_EQ(document.recovery()->edits.size(), 3u);
  EXPECT_TRUE(document.recovery()->session == edited(first, 3));
}

TEST_F(SessionDocumentTest, TheSecondToOpenItOnlyReads) {
  SessionDocument writer = SessionDocument::create(file, first);
  writer.apply(edited(first, 1), "Edit");
  SessionDocument second = SessionDocument::open(file);
  EXPECT_TRUE(second.readOnly());
  EXPECT_FALSE(second.recovery());
  EXPECT_THAT(second.readOnlyReason(),
              HasSubstr("it is open already: process " + std::to_string(::getpid())));
  EXPECT_THAT(folder.message([&] { second.apply(edited(second.session(), 2), "x"); }),
              HasSubstr("cannot write s.json: it is open already"));
  EXPECT_THAT(folder.message([&] { second.save(); }), HasSubstr("it is open already"));
  // The first one is not disturbed, and the second can go on under another name.
  writer.save();
  second.saveAs(folder / "copy.json");
  EXPECT_FALSE(second.readOnly());
  second.apply(edited(second.session(), 3), "x");
  EXPECT_THAT(folder.message([&] { second.saveAs(file); }), HasSubstr("it is open already"));
}

TEST_F(SessionDocumentTest, RefusesEditsThatCouldNotBeOpenedAgain) {
  SessionDocument document = SessionDocument::create(file, first);
  Session twice = first;
  twice.cases.push_back(twice.cases[0]);
  EXPECT_THAT(folder.message([&] { document.apply(twice, "x"); }), HasSubstr("is given twice"));
  Session option = first;
  option.options.emplace_back("loop.max_iterations", std::int64_t{0});
  EXPECT_THAT(folder.message([&] { document.apply(option, "x"); }), HasSubstr("max_iterations"));
  SessionCase nan = *first.cases[0];
  nan.camera_from_station_seed.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(document.apply(withCase(first, nan), "x"), std::logic_error);
  EXPECT_TRUE(document.session() == first);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SessionDocumentTest, Save_AfterAChangeByAnotherProgram_IsRefused) {
  SessionDocument document = SessionDocument::create(file, first);
  document.apply(edited(document.session(), 1), "Edit");
  folder.write("s.json", "by another program");
  EXPECT_THAT(folder.message([&] { document.save(); }), HasSubstr("another program has changed"));
  EXPECT_EQ(folder.read("s.json"), "by another program");
  document.saveAs(folder / "t.json");
  EXPECT_TRUE(SessionDocument::open(folder / "t.json", Access::kReadOnly).session() ==
              document.session());
}

TEST_F(SessionDocumentTest, SaysWhatCannotBeOpened) {
  EXPECT_EQ(folder.message([&] { SessionDocument::open(folder / "none.json"); }),
            "none.json: no such file");
  EXPECT_EQ(folder.message([&] { SessionDocument::open(folder.write("e.json", "")); }),
            "e.json: the file is empty");
  EXPECT_EQ(folder.message([&] { SessionDocument::open(folder.path()); }),
            folder.path().string() + ": is a folder, not a file");
  EXPECT_EQ(folder.fileCount(), 1u) << "no lock stays behind";
}

TEST_F(SessionDocumentTest, OpensInAReadOnlyFolderToBeRead) {
  SessionDocument::create(file, first);
  ::chmod(folder.path().c_str(), 0555);
  ::chmod(file.c_str(), 0444);
  const std::string said = inChild([&] {
    stopBeingRoot();
    SessionDocument document = SessionDocument::open(file);
    std::string text = document.readOnlyReason() + "; ";
    text += folder.message([&] { document.apply(edited(document.session(), 1), "x"); }) + "; ";
    return text + folder.message([&] { document.save(); });
  });
  ::chmod(folder.path().c_str(), 0755);
  const std::string reason = "nothing can be written next to it (Permission denied)";
  EXPECT_EQ(said, reason + "; cannot write s.json: " + reason + "; cannot write s.json: " + reason);
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST_F(SessionDocumentTest, UnsavedEditsInAReadOnlyFolder_AreSavedUnderAnotherName) {
  leaveUnsaved(2);
  const TemporaryFolder other;
  ::chmod(other.path().c_str(), 0777);
  ::chmod(folder.path().c_str(), 0555);
  const std::string said = inChild([&] {
    stopBeingRoot();
    SessionDocument document = SessionDocument::open(file, Access::kReadOnly);
    if (document.unsavedText().find("save in another folder (Save as)") == std::string::npos)
      return "advice: " + document.unsavedText();
    document = SessionDocument::open(file);
    document.acceptRecovery();
    if (!document.readOnly() || !document.modified()) return std::string("no recovered edits");
    document.discardChanges();
    if (document.modified()) return std::string("not discarded");
    document = SessionDocument::open(file);
    document.acceptRecovery();
    document.saveAs(other / "t.json");
    document.apply(edited(document.session(), 3), "x");
    document.save();
    return std::string("saved");
  });
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(said, "saved");
  EXPECT_TRUE(readSessionFile(other / "t.json").session == edited(first, 3));
  EXPECT_TRUE(readSessionFile(file).session == first);
  EXPECT_TRUE(std::filesystem::exists(folder / "s.journal"));
}

/// Names that differ in ".json" alone.
TEST_F(SessionDocumentTest, SessionsNextToEachOther_HaveTheirOwnCompanions) {
  for (const char* name : {"s", "s.boresight", "s.boresight.json"})
    (void)SessionDocument::create(folder / name, first);
  leaveUnsaved(2);
  for (const char* name : {"s", "s.boresight", "s.boresight.json"}) {
    SessionDocument document = SessionDocument::open(folder / name);
    document.apply(edited(first, 7), "x");
    for (const char* other : {"s", "s.boresight", "s.boresight.json"}) {
      if (other == std::string(name)) continue;
      const SessionDocument next = SessionDocument::open(folder / other);
      EXPECT_FALSE(next.readOnly()) << name << ", " << other;
      EXPECT_FALSE(next.recovery());
    }
    document.save();
  }
  EXPECT_EQ(SessionDocument::open(file).recovery()->edits.size(), 2u);
}

/// Journal and lock of a session without ".json" as former versions named them.
struct SessionOfAFormerVersion : SessionDocumentTest {
  const std::filesystem::path plain = folder / "s";
  SessionOfAFormerVersion() {
    SessionDocument::create(plain, first);
    { SessionDocument::open(plain).apply(edited(first, 1), "Edit 1"); }
    std::filesystem::rename(folder / "s-journal", folder / "s.journal");
  }
  void expectUntouched(const std::string& journal) const {
    EXPECT_EQ(folder.read("s.journal"), journal);
    EXPECT_FALSE(std::filesystem::exists(folder / "s-journal"));
    EXPECT_FALSE(std::filesystem::exists(folder / "s-lock"));
  }
};

TEST_F(SessionOfAFormerVersion, UnsavedEdits_AreOffered) {
  const std::string journal = folder.read("s.journal");
  const SessionDocument read = SessionDocument::open(plain, Access::kReadOnly);
  ASSERT_TRUE(read.recovery());
  EXPECT_THAT(read.unsavedText(), HasSubstr("never saved"));
  expectUntouched(journal);
  (void)inChild([&]() -> std::string {
    const FileLock lock(folder / "s.lock");
    ::kill(::getpid(), SIGKILL);
    return "";
  });
  SessionDocument document = SessionDocument::open(plain);
  EXPECT_THAT(document.notices(), ElementsAre(HasSubstr("did not close it: process"),
                                              HasSubstr("s.journal of a former version")));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.lock"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
  EXPECT_EQ(folder.read("s-journal"), journal);
  ASSERT_TRUE(document.recovery());
  document.acceptRecovery();
  document.save();
  EXPECT_TRUE(readSessionFile(plain).session == edited(first, 1));
  EXPECT_FALSE(std::filesystem::exists(folder / "s-journal"));
}

TEST_F(SessionOfAFormerVersion, LockThatItHolds_IsRespected) {
  const std::string journal = folder.read("s.journal");
  const FileLock lock(folder / "s.lock");
  const SessionDocument document = SessionDocument::open(plain);
  EXPECT_THAT(document.readOnlyReason(), HasSubstr("it is open already: process"));
  EXPECT_FALSE(document.recovery());
  expectUntouched(journal);
  EXPECT_THAT(SessionDocument::open(plain, Access::kReadOnly).unsavedText(),
              HasSubstr("save the session in the program that has it open"));
}

TEST_F(SessionOfAFormerVersion, FilesOfOthers_AreLeft) {
  std::string journal = folder.read("s.journal");
  folder.write("s.lock", "of another kind of program");
  writeSessionFile(file, first);  // s.json
  EXPECT_FALSE(SessionDocument::open(plain).recovery()) << "its journal is that of s.json";
  std::filesystem::remove(file);
  for (const char* text : {"no journal", journal.c_str()}) {
    folder.write("s.journal", text);
    writeSessionFile(plain, sessionOf("another"));
    const SessionDocument document = SessionDocument::open(plain);
    EXPECT_FALSE(document.readOnly());
    EXPECT_FALSE(document.recovery());
    EXPECT_EQ(folder.read("s.journal"), text);
  }
  EXPECT_EQ(folder.read("s.lock"), "of another kind of program");
}

TEST_F(SessionDocumentTest, SavedRecoveryOfADamagedJournal_KeepsOneCopyOfIt) {
  leaveUnsaved(3);
  std::string journal = folder.read("s.journal");
  journal[journal.find("Edit 2")] = 'e';
  folder.write("s.journal", journal);
  SessionDocument document = SessionDocument::open(file);
  const std::string before = folder.read("s.json");
  const auto said = document.notices();
  folder.write("s.json", before + " ");  // by another program
  for (int i = 0; i < 2; ++i) {
    EXPECT_THROW(document.saveRecovery(), OutputError);
    EXPECT_EQ(folder.read("s.journal"), journal);
    EXPECT_FALSE(std::filesystem::exists(folder / "s.journal.aside-1"));
    EXPECT_EQ(document.notices(), said);
  }
  folder.write("s.json", before);
  document.saveRecovery();
  EXPECT_THAT(document.notices().back(), HasSubstr("damaged journal is kept as"));
  EXPECT_EQ(folder.read("s.journal.aside-1"), journal);
  EXPECT_TRUE(readSessionFile(file).session == edited(first, 1));
}

/// Killed before the file has its name, and (as if) before the journal is removed.
TEST_F(SessionDocumentTest, KilledWhileItSavesARecovery_OffersItsEditsOrKnowsThemAsSaved) {
  leaveUnsaved(3);
  (void)inChild([&]() -> std::string {
    SessionDocument document = SessionDocument::open(file);
    limitFileSize(std::filesystem::file_size(file) - 1);
    std::signal(SIGXFSZ, SIG_DFL);  // at the writing of the file
    document.saveRecovery();
    return "";
  });
  {
    const SessionDocument document = SessionDocument::open(file);
    ASSERT_TRUE(document.recovery());
    EXPECT_TRUE(document.recovery()->session == edited(first, 3));
  }
  writeSessionFile(file, edited(first, 3));
  const SessionDocument document = SessionDocument::open(file);
  EXPECT_FALSE(document.recovery());
  EXPECT_THAT(document.notices(), testing::Each(Not(HasSubstr("journal"))));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SessionDocumentTest, SavedRecovery_IsWholeOrHasNotHappened) {
  leaveUnsaved(2);
  const std::string journal = folder.read("s.journal");
  SessionDocument document = SessionDocument::open(file);
  const std::string before = folder.read("s.json");
  folder.write("s.json", before + " ");  // by another program
  EXPECT_THROW(document.saveRecovery(), OutputError);
  EXPECT_EQ(folder.read("s.journal"), journal);
  EXPECT_EQ(document.recovery()->edits.size(), 2u);
  EXPECT_FALSE(document.modified());
  folder.write("s.json", before);
  document.saveRecovery();
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal.aside-1"));
  EXPECT_TRUE(readSessionFile(file).session == edited(first, 2));
  document.apply(edited(first, 3), "x");
  EXPECT_TRUE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SessionDocumentTest, AFullDiskLeavesFileAndSessionAsTheyWere) {
  SessionDocument::create(file, first);
  const std::string before = folder.read("s.json");
  const std::string said = inChild([&] {
    SessionDocument document = SessionDocument::open(file);
    document.apply(edited(first, 1), "Edit 1");
    limitFileSize(std::filesystem::file_size(folder / "s.journal") + 10);
    std::string text = folder.message([&] { document.apply(edited(first, 2), "Edit 2"); }) + "; ";
    text += document.session() == edited(first, 1) ? "as it was; " : "changed; ";
    text += folder.message([&] { document.save(); });
    return text;
  });
  EXPECT_EQ(
      said,
      "cannot write s.journal: File too large; as it was; cannot write s.json: File too large");
  EXPECT_EQ(folder.read("s.json"), before);
  const SessionDocument document = SessionDocument::open(file);
  EXPECT_TRUE(document.recovery()->session == edited(first, 1));
}

/// A session with random edits in its journal: the sessions after each, and the length of the
/// journal then.
struct EditedSession {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "s.json";
  std::vector<Session> sessions;
  std::vector<std::size_t> lengths = {0};
  std::string journal;
  SavedSession saved;

  EditedSession(Random& random, int edits) {
    SessionDocument document = SessionDocument::create(file, randomSession(random));
    saved = readSessionFile(file);
    sessions = {document.session()};
    for (int i = 0; i < edits; ++i) {
      document.apply(randomEdit(random, document.session()), "Edit \"" + std::to_string(i) + "\n");
      if (document.session() == sessions.back()) continue;
      if (document.session() == saved.session) {  // which has no journal
        sessions.resize(1);
        lengths.resize(1);
        continue;
      }
      sessions.push_back(document.session());
      lengths.push_back(std::filesystem::file_size(folder / "s.journal"));
    }
    journal = folder.read("s.journal");
  }
};

TEST(Journal, CutAtAnyByte_RecoversTheEditsBeforeTheCut) {
  Random random = randomFor("Journal");
  const EditedSession edited(random, test::allCases() ? 60 : 12);
  ASSERT_GT(edited.sessions.size(), 8u);
  std::size_t whole = 0;
  for (std::size_t length = 1; length <= edited.journal.size(); ++length) {
    if (whole + 1 < edited.lengths.size() && edited.lengths[whole + 1] == length) ++whole;
    // The header and the first edit are written as one file, whole or not at all.
    if (whole == 0) continue;
    const std::size_t next = edited.lengths[std::min(whole + 1, edited.lengths.size() - 1)];
    const bool near_end = length < edited.lengths[whole] + 20 || length + 2 >= next;
    if (!test::allCases() && !near_end && length % 101 != 0) continue;
    const auto cut = edited.folder.write("cut", edited.journal.substr(0, length));
    const Recovery read = readJournal(cut, edited.saved);
    ASSERT_EQ(read.edits.size(), whole) << length;
    ASSERT_TRUE(read.session == edited.sessions[whole]) << length;
    ASSERT_EQ(read.damage, "");
  }
  EXPECT_EQ(whole + 1, edited.sessions.size());
}

TEST(Journal, DamagedAtAnyByte_RecoversTheEditsBeforeIt) {
  Random random = randomFor("JournalDamage");
  const EditedSession edited(random, 12);
  for (int i = 0; i < 400; ++i) {
    const std::size_t place = indexBelow(random, edited.journal.size());
    std::string journal = edited.journal;
    journal[place] = static_cast<char>(journal[place] ^ (1 << random.below(7)));
    const auto after = std::ranges::upper_bound(edited.lengths, place);
    const auto whole = static_cast<std::size_t>(after - edited.lengths.begin()) - 1;
    const auto file = edited.folder.write("damaged", journal);
    try {
      const Recovery read = readJournal(file, edited.saved);
      ASSERT_EQ(read.edits.size(), whole) << place;
      ASSERT_TRUE(read.session == edited.sessions[whole]) << place;
      ASSERT_TRUE(read.damage != "" || place + 1 == journal.size()) << place;
    } catch (const InputError&) {
      ASSERT_EQ(whole, 0u) << "of the header " << place;
    }
  }
}

TEST(Journal, OfVersion1_IsOffered) {
  Random random = randomFor("Journal1");
  const EditedSession edited(random, 6);
  ASSERT_FALSE(edited.sessions.back() == edited.saved.session);
  const auto write = [&](const std::string& base_sha256) {
    edited.folder.write(
        "s.journal", R"({"format": "boresight-journal", "version": 1, "base_sha256": ")" +
                         base_sha256 +
                         R"(", "time": "2026-01-31T23:59:59Z", "edits": ["A", "B"], "session": )" +
                         sessionText(edited.sessions.back(), edited.file) + "}\n");
  };
  write(edited.saved.file_sha256);
  {
    SessionDocument document = SessionDocument::open(edited.file);
    ASSERT_TRUE(document.recovery());
    EXPECT_THAT(document.recovery()->edits, ElementsAre("A", "B"));
    document.acceptRecovery();
    EXPECT_TRUE(document.session() == edited.sessions.back());
  }
  {
    SessionDocument document = SessionDocument::open(edited.file);
    EXPECT_THAT(document.recovery()->edits, ElementsAre("Recover 2 edits: A, B"));
    document.acceptRecovery();
    document.save();
  }
  write(edited.saved.file_sha256);
  EXPECT_FALSE(SessionDocument::open(edited.file).recovery()) << "its edits are saved";
  EXPECT_FALSE(std::filesystem::exists(edited.folder / "s.journal"));
}

TEST_F(SessionDocumentTest, EditAndSave_LeavesTheJournalAsItWasUntilTheFileIsSaved) {
  leaveUnsaved(2);
  const std::string journal = folder.read("s.journal");
  {
    SessionDocument document = SessionDocument::open(file, Access::kEditAndSave);
    document.acceptRecovery();
    document.apply(edited(first, 3), "Edit 3");
    EXPECT_EQ(folder.read("s.journal"), journal);
    document.apply(first, "Back");
    EXPECT_EQ(folder.read("s.journal"), journal) << "the session is as saved, but its edits wait";
    document.apply(edited(first, 3), "Edit 3");
  }
  EXPECT_EQ(folder.read("s.journal"), journal);
  SessionDocument document = SessionDocument::open(file, Access::kEditAndSave);
  document.acceptRecovery();
  document.apply(edited(document.session(), 3), "Edit 3");
  document.save();
  EXPECT_TRUE(readSessionFile(file).session == edited(first, 3));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SessionDocumentTest, Save_WhenAnotherProgramChangedTheJournal_StillSaves) {
  SessionDocument document = SessionDocument::create(file, first);
  document.apply(edited(first, 1), "Edit 1");
  folder.write("s.journal", "by another program");
  EXPECT_THAT(folder.message([&] { document.apply(edited(first, 2), "Edit 2"); }),
              HasSubstr("another program has changed it"));
  EXPECT_EQ(folder.read("s.journal"), "by another program");
  document.save();
  document.apply(edited(first, 2), "Edit 2");
  EXPECT_TRUE(readSessionFile(file).session == edited(first, 1));
  { const SessionDocument moved = std::move(document); }
  EXPECT_TRUE(SessionDocument::open(file).recovery()->session == edited(first, 2));
}

TEST_F(SessionDocumentTest, JournalThatAnotherProgramRemoved_IsWrittenAgainWithAllEdits) {
  {
    SessionDocument document = SessionDocument::create(file, first);
    for (const int number : {1, 2}) document.apply(edited(first, number), "Edit");
    std::filesystem::remove(folder / "s.journal");
    for (const int number : {3, 4})
      document.apply(edited(first, number), "Edit " + std::to_string(number));
  }
  const SessionDocument document = SessionDocument::open(file);
  ASSERT_TRUE(document.recovery());
  EXPECT_TRUE(document.recovery()->session == edited(first, 4));
  EXPECT_THAT(document.recovery()->edits,
              ElementsAre("Edits before the journal was removed", "Edit 3", "Edit 4"));
}

/// Another session, with unsaved edits of a killed program.
struct SaveAsOver : SessionDocumentTest {
  const std::filesystem::path source = folder / "source.json";
  const Session second = sessionOf("second");
  std::string file_text, journal;

  SaveAsOver() {
    leaveUnsaved(2);
    std::filesystem::remove(folder / "s.lock");
    file_text = folder.read("s.json");
    journal = folder.read("s.journal");
    SessionDocument::create(source, second);
  }
};

TEST_F(SaveAsOver, WhenItCannotBeWritten_LeavesFileAndJournalOfTheOther) {
  const std::string said = inChild([&] {
    SessionDocument document = SessionDocument::open(source);
    limitFileSize(file_text.size() / 2);
    return folder.message([&] { document.saveAs(file); });
  });
  EXPECT_EQ(said, "cannot write s.json: File too large");
  EXPECT_EQ(folder.read("s.json"), file_text);
  EXPECT_EQ(folder.read("s.journal"), journal);
  EXPECT_TRUE(SessionDocument::open(file).recovery()->session == edited(first, 2));
}

TEST_F(SaveAsOver, SetsTheJournalOfTheOtherAside) {
  SessionDocument document = SessionDocument::open(source);
  document.saveAs(file);
  EXPECT_TRUE(document.session() == second);
  EXPECT_EQ(folder.read("s.journal.aside-1"), journal);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.journal"));
}

TEST_F(SaveAsOver, KilledBeforeTheJournalIsSetAside_IsTheNewSession) {
  writeSessionFile(file, second);
  const SessionDocument document = SessionDocument::open(file);
  EXPECT_TRUE(document.session() == second);
  EXPECT_FALSE(document.recovery());
  EXPECT_EQ(folder.read("s.journal.aside-1"), journal);
}

/// Two programs create the same file; while the second waits for the lock, the first ends.
TEST_F(SessionDocumentTest, Create_WhileAnotherProgramCreatesTheFile_LeavesItsSession) {
  const std::string text = sessionText(sessionOf("other"), file);
  for (int round = 0; round < 20; ++round) {
    std::filesystem::remove(file);
    auto lock = std::make_unique<FileLock>(lockFileOf(file));
    std::string said;
    std::thread second(
        [&] { said = folder.message([&] { SessionDocument::create(file, first); }); });
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    folder.write("s.json", text);
    lock.reset();
    second.join();
    EXPECT_THAT(said, testing::AnyOf(HasSubstr("the file exists"), HasSubstr("is open already")));
    ASSERT_EQ(folder.read("s.json"), text) << "round " << round;
  }
}

/// The same session by another name.
struct LinkedSession : SessionDocumentTest {
  const std::filesystem::path link = folder / "elsewhere/link.json";
  LinkedSession() {
    SessionDocument::create(file, first);
    std::filesystem::create_directory(link.parent_path());
    std::filesystem::create_symlink("../s.json", link);
  }
};

TEST_F(LinkedSession, IsOpenForOneProgramByBothNames) {
  SessionDocument document = SessionDocument::open(link);
  EXPECT_EQ(document.file(), std::filesystem::canonical(file));
  EXPECT_TRUE(document.session() == first) << "its inputs are where the file is";
  EXPECT_THAT(SessionDocument::open(file).readOnlyReason(), HasSubstr("it is open already"));
  EXPECT_THAT(SessionDocument::open(link).readOnlyReason(), HasSubstr("it is open already"));
  document.apply(edited(first, 1), "Edit");
  EXPECT_TRUE(std::filesystem::exists(folder / "s.journal"));
  document.saveAs(file);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_FALSE(document.modified());
  EXPECT_TRUE(readSessionFile(link).session == edited(first, 1));
}

TEST_F(LinkedSession, UnsavedEdits_AreOfferedByBothNames) {
  { SessionDocument::open(link).apply(edited(first, 1), "Edit"); }
  EXPECT_TRUE(SessionDocument::open(file).recovery());
  EXPECT_TRUE(SessionDocument::open(link).recovery());
}

TEST_F(LinkedSession, LinkWithoutAFile_IsTheNameOfItsTarget) {
  std::filesystem::create_symlink("t.json", folder / "link-to-t.json");
  SessionDocument document = SessionDocument::open(file);
  document.saveAs(folder / "link-to-t.json");
  EXPECT_EQ(document.file(), std::filesystem::canonical(folder / "t.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "t.lock"));
}

TEST_F(SessionDocumentTest, AnEditWritesWhatItChangesAlone) {
  Random random = randomFor("large");
  Session session = first;
  for (int i = 0; i < 300; ++i) session = withCase(session, randomCase(random, std::to_string(i)));
  SessionDocument document = SessionDocument::create(file, session);
  document.apply(withChanged(session, "7", [](SessionCase& changed) { changed.tags = {"dusty"}; }),
                 "Tag");
  EXPECT_LT(std::filesystem::file_size(folder / "s.journal"), 20000u);
  EXPECT_GT(std::filesystem::file_size(file), 300000u);
}

TEST(SessionHistory, UndoesAndRedoesEveryStep) {
  Random random = randomFor("SessionHistory");
  const TemporaryFolder folder;
  SessionDocument document = SessionDocument::create(folder / "s.json", randomSession(random));
  SessionHistory history(document);
  std::vector<Session> states = {document.session()};
  for (int i = 0; i < 30; ++i) {
    history.perform(randomEdit(random, document.session()), "Edit " + std::to_string(i));
    if (states.size() <= history.done()) states.push_back(document.session());
  }
  const auto withoutRuns = [](Session session) {
    session.runs.clear();
    session.view = {};
    return session;
  };
  const auto expectEdits = [&](std::size_t i) {
    ASSERT_TRUE(withoutRuns(states[i]) == withoutRuns(document.session())) << i;
  };
  const std::size_t count = history.done();
  ASSERT_EQ(states.size(), count + 1);
  for (std::size_t i = count; i > 0; --i) {
    expectEdits(i);
    EXPECT_TRUE(history.canUndo());
    history.undo();
  }
  expectEdits(0);
  EXPECT_FALSE(history.canUndo());
  history.undo();
  for (std::size_t i = 1; i <= count; ++i) {
    history.redo();
    expectEdits(i);
  }
  EXPECT_FALSE(history.canRedo());
}

TEST(SessionHistory, ANewEditForgetsWhatWasUndone) {
  Random random = randomFor("forget");
  const TemporaryFolder folder;
  SessionDocument document = SessionDocument::create(folder / "s.json", {});
  SessionHistory history(document);
  history.perform(withCase(document.session(), randomCase(random, "a")), "Add a");
  history.perform(withCase(document.session(), randomCase(random, "b")), "Add b");
  history.perform(document.session(), "Nothing");
  EXPECT_EQ(history.undoText(), "Add b");
  history.undo();
  EXPECT_EQ(history.redoText(), "Add b");
  history.perform(withCase(document.session(), randomCase(random, "c")), "Add c");
  EXPECT_EQ(history.redoText(), "");
  EXPECT_EQ(document.session().cases.size(), 2u);
}

TEST(SessionHistory, ARemovedCaseComesBackWithItsRunAndLaterRunsAndTheViewStay) {
  Random random = randomFor("removed");
  const TemporaryFolder folder;
  Session session = withCase(withCase({}, randomCase(random, "a")), randomCase(random, "b"));
  for (const char* id : {"a", "b"}) session.runs.push_back(randomRun(random, id));
  SessionDocument document = SessionDocument::create(folder / "s.json", session);
  SessionHistory history(document);
  history.perform(withoutCase(document.session(), "b"), "Remove b");
  Session again = document.session();
  again.runs.push_back(randomRun(random, "a"));
  again.view.case_id = "a";
  document.apply(again, "Run a");
  history.undo();
  ASSERT_NE(document.session().lastRunOf("b"), nullptr);
  EXPECT_EQ(*document.session().lastRunOf("b"), session.runs[1]);
  EXPECT_EQ(*document.session().lastRunOf("a"), again.runs.back());
  EXPECT_EQ(document.session().view.case_id, "a");
  history.redo();
  EXPECT_EQ(document.session().lastRunOf("b"), nullptr);
}

/// A session of two cases with a run each, whose traces are in its folder of runs.
struct SessionWithTraces : testing::Test {
  Random random = randomFor("traces");
  const TemporaryFolder folder;
  const std::filesystem::path untitled = folder / "untitled/u.json";
  const std::filesystem::path named = folder / "named/s.json";
  std::optional<SessionDocument> document;

  SessionWithTraces() {
    std::filesystem::create_directories(named.parent_path());
    std::filesystem::create_directories(untitled.parent_path());
    Session session = withCase(withCase({}, randomCase(random, "a")), randomCase(random, "b"));
    for (const char* id : {"a", "b"}) session.runs.push_back(storedRun(id));
    document = SessionDocument::create(untitled, session);
  }

  RunRecord storedRun(const std::string& id) {
    RunRecord run = randomRun(random, id);
    run.file = runFileOf(document ? document->file() : untitled, run.digest);
    folder.write(run.file.lexically_relative(folder.path()).string(), "trace " + run.digest);
    return run;
  }
  void removeCase(SessionHistory& history, const std::string& id) const {
    history.perform(withoutCase(document->session(), id), "Remove " + id);
  }
  void removeUntitled() const { std::filesystem::remove_all(untitled.parent_path()); }

  /// The traces of the session's runs, in its own folder: "a b".
  std::string casesWithTraces() const {
    std::string cases;
    for (const RunRecord& run : document->session().runs) {
      EXPECT_EQ(run.file, runFileOf(document->file(), run.digest));
      const std::string name = run.file.lexically_relative(folder.path()).string();
      if (folder.read(name) == "trace " + run.digest)
        cases += (cases.empty() ? "" : " ") + run.case_id;
    }
    return cases;
  }
};

TEST_F(SessionWithTraces, UndoAfterSaveAs_RestoresRunsWithTheirTraces) {
  SessionHistory history(*document);
  removeCase(history, "b");
  history.saveAs(named);
  removeUntitled();
  EXPECT_EQ(casesWithTraces(), "a");
  history.undo();
  EXPECT_EQ(casesWithTraces(), "a b");
  history.redo();
  EXPECT_EQ(casesWithTraces(), "a");
}

TEST_F(SessionWithTraces, UndoAfterSaveAsTwice_RestoresRunsWithTheirTraces) {
  SessionHistory history(*document);
  removeCase(history, "b");
  history.saveAs(named);
  removeUntitled();
  const std::filesystem::path again = folder / "again/s.json";
  std::filesystem::create_directories(again.parent_path());
  history.saveAs(again);
  history.undo();
  EXPECT_EQ(casesWithTraces(), "a b");
}

TEST_F(SessionWithTraces, UndoAfterSaveAs_OfAnEditBefore_RestoresRunsWithTheirTraces) {
  SessionHistory history(*document);
  removeCase(history, "a");
  history.undo();
  removeCase(history, "b");
  removeCase(history, "a");
  history.undo();
  history.saveAs(named);
  removeUntitled();
  EXPECT_EQ(casesWithTraces(), "a");
  removeCase(history, "a");
  EXPECT_EQ(casesWithTraces(), "");
  history.undo();
  history.undo();
  EXPECT_EQ(casesWithTraces(), "a b");
}

TEST_F(SessionWithTraces, RedoAfterSaveAs_RestoresRunsWithTheirTraces) {
  SessionHistory history(*document);
  history.perform(withCase(document->session(), randomCase(random, "c")), "Add c");
  Session session = document->session();
  session.runs.push_back(storedRun("c"));
  document->apply(session, "Run c");
  history.undo();
  history.saveAs(named);
  removeUntitled();
  EXPECT_EQ(casesWithTraces(), "a b");
  history.redo();
  EXPECT_EQ(casesWithTraces(), "a b c");
}

TEST_F(SessionWithTraces, UndoAndRedoOfAnotherEdit_KeepLaterRuns) {
  SessionHistory history(*document);
  const auto tag = [](SessionCase& changed) { changed.tags = {"dusty"}; };
  history.perform(withChanged(document->session(), "a", tag), "Tag a");
  Session session = document->session();
  session.runs.push_back(storedRun("a"));
  document->apply(session, "Run a");
  history.undo();
  EXPECT_EQ(casesWithTraces(), "a b a");
  history.redo();
  EXPECT_EQ(casesWithTraces(), "a b a");
}

TEST_F(SessionWithTraces, SaveAs_NamesTheCopiesOfItsTraces) {
  const std::filesystem::path first = document->session().runs[0].file;
  document->saveAs(named);
  EXPECT_TRUE(std::filesystem::equivalent(first, document->session().runs[0].file))
      << "linked in one file system";
  removeUntitled();
  EXPECT_EQ(casesWithTraces(), "a b");
  document->saveAs(folder / "named/t.json");
  std::filesystem::remove_all(folder / "named/s.runs");
  EXPECT_EQ(casesWithTraces(), "a b");
}

TEST(SessionHistory, AStepThatCannotBeWrittenHasNotHappened) {
  Random random = randomFor("unwritten");
  const TemporaryFolder folder;
  { SessionDocument::create(folder / "s.json", withCase({}, randomCase(random, "a"))); }
  SessionDocument document = SessionDocument::open(folder / "s.json", Access::kReadOnly);
  SessionHistory history(document);
  const Session next = withAnnotations(document.session(), "a", randomAnnotations(random));
  EXPECT_NE(folder.message([&] { history.perform(next, "Mark"); }), "(nothing)");
  EXPECT_FALSE(history.canUndo());
  EXPECT_TRUE(document.session().annotations.empty());
}

/// The number of the last edit is kept in the session's view; the rest is random.
Session numberedEdit(Random& random, const Session& session, std::int32_t number) {
  Session next = random.below(4) == 0 ? randomEdit(random, session) : session;
  next.view.iteration = number;
  return next;
}

/// Opens, recovers, edits in a loop and confirms each edit on the pipe; saves now and then.
[[noreturn]] void editForEver(const std::filesystem::path& file, int confirm, std::uint64_t round) {
  Random random = randomFor("kill " + std::to_string(round));
  SessionDocument document = SessionDocument::open(file);
  document.acceptRecovery();
  for (std::int32_t number = document.session().view.iteration + 1;; ++number) {
    document.apply(numberedEdit(random, document.session(), number), "Edit");
    if (::write(confirm, &number, sizeof(number)) != sizeof(number)) ::_exit(1);
    if (random.below(8) == 0) document.save();
  }
}

TEST(Kill, NothingConfirmedIsLost) {
  const TemporaryFolder folder;
  Random random = randomFor("Kill");
  { SessionDocument::create(folder / "s.json", randomSession(random)); }
  std::int32_t confirmed = -1;
  for (std::uint64_t round = 0; round < 50; ++round) {
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      ::close(pipe_ends[0]);
      try {
        editForEver(folder / "s.json", pipe_ends[1], round);
      } catch (const std::exception& error) {
        ::_exit(2);
      }
    }
    ::close(pipe_ends[1]);
    const auto read = [&] { return ::read(pipe_ends[0], &confirmed, sizeof(confirmed)) > 0; };
    for (std::uint32_t left = random.below(30); left > 0; --left) ASSERT_TRUE(read());
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(6000)));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    while (read()) {
    }
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself, with " << WEXITSTATUS(status);

    const SessionDocument document = SessionDocument::open(folder / "s.json");
    ASSERT_FALSE(document.readOnly());
    const Session& session =
        document.recovery() ? document.recovery()->session : document.session();
    // The last edit may be on the disk although it was not confirmed any more.
    ASSERT_GE(session.view.iteration, confirmed) << "round " << round;
    ASSERT_LE(session.view.iteration, confirmed + 1) << "round " << round;
    EXPECT_THAT(document.notices(), testing::Each(Not(HasSubstr("set aside"))));
  }
  EXPECT_GT(confirmed, 50);
}

}  // namespace
}  // namespace boresight::test
