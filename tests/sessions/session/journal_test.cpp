// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/errors.h"
#include "sessions/session/session_file.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Journal;
using sessions::Recovery;
using sessions::Session;
using testing::HasSubstr;

const Journal kJournal = {
    std::string(64, '0'), "2026-01-31T23:59:59Z", {"Edit \"1\"\nsecond line", "Edit 2"}};

std::string write(const TemporaryFolder& folder, const Session& session) {
  sessions::writeJournal(folder / "j", kJournal, sessions::sessionText(session, folder / "j"));
  return folder.read("j");
}

TEST(Journal, ReadsBackWhatWasWritten) {
  Random random = randomFor("Journal");
  const TemporaryFolder folder;
  for (int i = 0; i < 20; ++i) {
    const Session session = randomSession(random);
    write(folder, session);
    const Recovery read = sessions::readJournal(folder / "j");
    EXPECT_EQ(read.base_sha256, kJournal.base_sha256);
    EXPECT_EQ(read.time, kJournal.time);
    EXPECT_EQ(read.edits, kJournal.edits);
    EXPECT_TRUE(read.session == session);
  }
}

TEST(Journal, ACutOneIsNotUsed) {
  const TemporaryFolder folder;
  const std::string whole = write(folder, {});
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    const auto cut = folder.write("cut", whole.substr(0, length));
    EXPECT_THROW((void)sessions::readJournal(cut), sessions::InputError) << length;
  }
}

TEST(Journal, SaysWhyItCannotBeUsed) {
  const TemporaryFolder folder;
  EXPECT_THAT(folder.message([&] { (void)sessions::readJournal(folder.write("j", "{}\n")); }),
              HasSubstr("j: format: missing"));
  EXPECT_THAT(folder.message([&] { (void)sessions::readJournal(folder / "none"); }),
              HasSubstr("none: no such file"));
}

}  // namespace
}  // namespace boresight::test
