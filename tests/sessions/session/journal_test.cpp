// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/errors.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Journal;
using sessions::JournalContents;
using testing::HasSubstr;

Journal sampleJournal() {
  const std::string time = "2026-01-31T23:59:59Z";
  return {std::string(64, '0'),
          {{"Edit \"1\"\nsecond line", time, std::string(64, 'a')},
           {"Edit 2", time, std::string(64, 'b')}},
          "{\n  \"format\": \"boresight-session\"\n}\n"};
}

TEST(Journal, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Journal journal = sampleJournal();
  sessions::writeJournal(folder / "j", {});
  sessions::writeJournal(folder / "j", journal);
  const JournalContents contents = sessions::readJournal(folder / "j");
  EXPECT_EQ(contents.problem, "");
  EXPECT_EQ(contents.base_sha256, journal.base_sha256);
  EXPECT_EQ(contents.entries, journal.entries);
  EXPECT_EQ(contents.session_text, journal.session_text);
}

TEST(Journal, ACutOrChangedOneIsNotUsed) {
  const TemporaryFolder folder;
  sessions::writeJournal(folder / "j", sampleJournal());
  const std::string whole = folder.read("j");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(sessions::readJournal(folder.write("cut", whole.substr(0, length))).problem, "");
  Random random = randomFor("journal bytes");
  for (int i = 0; i < 400; ++i) {
    std::string bad = whole;
    const std::size_t at = indexBelow(random, bad.size());
    bad[at] = static_cast<char>(random.below(256));
    const bool same = bad == whole;
    EXPECT_EQ(sessions::readJournal(folder.write("bad", bad)).problem.empty(), same) << at;
  }
}

TEST(Journal, SaysWhyItCannotBeUsed) {
  const TemporaryFolder folder;
  EXPECT_EQ(sessions::readJournal(folder.write("j", "")).problem, "the file is empty");
  EXPECT_THAT(sessions::readJournal(folder.write("j", "{}\n")).problem, HasSubstr("is damaged"));
  EXPECT_THAT(folder.message([&] { (void)sessions::readJournal(folder / "none"); }),
              HasSubstr("none: no such file"));
}

}  // namespace
}  // namespace boresight::test
