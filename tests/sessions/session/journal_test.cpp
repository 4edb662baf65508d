// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/crc32.h"
#include "sessions/io/errors.h"
#include "sessions/session/session.h"
#include "tests/sessions/session/in_child.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Journal;
using sessions::JournalContents;
using sessions::JournalEntry;
using testing::HasSubstr;

const std::string kBase(64, '0');

JournalEntry entry(int number) {
  JournalEntry made;
  made.text = "Edit \"" + std::to_string(number) + "\"\nsecond line";
  made.time = "2026-01-31T23:59:59Z";
  made.after_sha256 = std::string(64, static_cast<char>('a' + number % 6));
  made.patch = "[[\"set\",[\"view\"]," + std::to_string(number) + "]]";
  return made;
}

JournalEntry written(int number) {
  JournalEntry made = entry(number);
  made.sequence = number;
  return made;
}

/// A journal of `count` entries in `folder`.
void writeJournal(const TemporaryFolder& folder, int count) {
  Journal journal(folder / "j", kBase);
  for (int i = 1; i <= count; ++i) journal.append(entry(i));
}

TEST(Crc32, HasTheCheckValueOfItsDefinition) {
  const std::string digits = "123456789";
  EXPECT_EQ(sessions::crc32({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}),
            0xcbf43926u);
}

TEST(Journal, ReadsBackWhatWasAppended) {
  const TemporaryFolder folder;
  { Journal journal(folder / "j", kBase, {entry(1), entry(2)}); }
  JournalContents contents = sessions::readJournal(folder / "j");
  EXPECT_EQ(contents.entries.size(), 2u);
  writeJournal(folder, 5);
  contents = sessions::readJournal(folder / "j");
  EXPECT_EQ(contents.problem, "");
  EXPECT_EQ(contents.base_sha256, kBase);
  EXPECT_EQ(contents.lost_lines, 0u);
  ASSERT_EQ(contents.entries.size(), 5u);
  for (int i = 1; i <= 5; ++i)
    EXPECT_EQ(contents.entries[static_cast<std::size_t>(i - 1)], written(i));
}

TEST(Journal, ATornEndLosesOnlyWhatIsTorn) {
  const TemporaryFolder folder;
  writeJournal(folder, 3);
  const std::string whole = folder.read("j");
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const std::string cut = whole.substr(0, length);
    const JournalContents contents = sessions::readJournal(folder.write("cut", cut));
    const auto lines = std::count(cut.begin(), cut.end(), '\n');
    if (lines == 0) {
      EXPECT_NE(contents.problem, "") << length;
      continue;
    }
    ASSERT_EQ(contents.problem, "") << length;
    ASSERT_EQ(contents.entries.size(), static_cast<std::size_t>(lines - 1)) << length;
    EXPECT_EQ(contents.lost_lines, cut.back() == '\n' ? 0u : 1u);
  }
}

TEST(Journal, AnyChangedByteEndsItThere) {
  const TemporaryFolder folder;
  writeJournal(folder, 4);
  const std::string whole = folder.read("j");
  Random random = randomFor("journal bytes");
  for (int i = 0; i < 400; ++i) {
    std::string bad = whole;
    const std::size_t at = indexBelow(random, bad.size());
    const char before = bad[at];
    bad[at] = static_cast<char>(random.below(256));
    if (bad[at] == before) continue;
    const JournalContents contents = sessions::readJournal(folder.write("bad", bad));
    const auto line =
        std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    if (line == 0) {
      EXPECT_NE(contents.problem, "");
    } else {
      EXPECT_EQ(contents.entries.size(), static_cast<std::size_t>(line - 1)) << at;
      EXPECT_GT(contents.lost_lines, 0u);
    }
  }
}

TEST(Journal, ALineCountsOnlyBehindItsOwn) {
  const TemporaryFolder folder;
  writeJournal(folder, 3);
  std::vector<std::string> lines;
  std::string line;
  std::istringstream stream(folder.read("j"));
  while (std::getline(stream, line)) lines.push_back(line + "\n");
  const auto entriesOf = [&](const std::string& text) {
    return sessions::readJournal(folder.write("x", text)).entries.size();
  };
  EXPECT_EQ(entriesOf(lines[0] + lines[1] + lines[2] + lines[3]), 3u);
  EXPECT_EQ(entriesOf(lines[0] + lines[1] + lines[3]), 1u);
  EXPECT_EQ(entriesOf(lines[0] + lines[2]), 0u);
  EXPECT_EQ(entriesOf(lines[0] + lines[1] + lines[1]), 1u);
}

TEST(Journal, SaysWhyItCannotBeUsed) {
  const TemporaryFolder folder;
  EXPECT_EQ(sessions::readJournal(folder.write("j", "")).problem, "the file is empty");
  EXPECT_THAT(sessions::readJournal(folder.write("j", "{}\n")).problem,
              HasSubstr("does not begin"));
  EXPECT_THAT(folder.message([&] { (void)sessions::readJournal(folder / "none"); }),
              HasSubstr("none: no such file"));
}

/// The size that leaves room for three entries and part of a fourth.
TEST(Journal, AFullDiskTakesAnEditBackAndTheNextOneStillFits) {
  const TemporaryFolder folder;
  writeJournal(folder, 3);
  const std::size_t limit = folder.read("j").size() + 40;
  const std::string said = inChild([&]() -> std::string {
    limitFileSize(limit);
    Journal journal(folder / "j", kBase);
    for (int i = 1; i <= 3; ++i) journal.append(entry(i));
    std::string errors;
    for (int i = 0; i < 2; ++i) {
      try {
        journal.append(entry(4));
        return "no error";
      } catch (const sessions::OutputError& error) {
        errors += error.reason() + ";";
      }
    }
    return errors;
  });
  EXPECT_EQ(said,
            "the file would become larger than is allowed;the file would become larger than is "
            "allowed;");
  const JournalContents contents = sessions::readJournal(folder / "j");
  EXPECT_EQ(contents.entries.size(), 3u);
  EXPECT_EQ(contents.lost_lines, 0u);
}

}  // namespace
}  // namespace boresight::test
