// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/file_lock.h"

#include <gtest/gtest.h>

#include <csignal>

#include "sessions/io/files/errors.h"
#include "tests/sessions/session/in_child.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::FileLock;

TEST(FileLock, IsHeldByOneAndSaysByWhom) {
  const TemporaryFolder folder;
  {
    const FileLock first(folder / "s.lock");
    EXPECT_TRUE(first.held());
    EXPECT_FALSE(first.stale());
    const FileLock second(folder / "s.lock");
    EXPECT_FALSE(second.held());
    ASSERT_TRUE(second.other());
    EXPECT_EQ(second.other()->process, ::getpid());
    EXPECT_FALSE(sessions::hasEnded(*second.other()));
    const std::string pid = std::to_string(::getpid());
    EXPECT_THAT(second.other()->text(), HasSubstr("process " + pid));
    EXPECT_EQ(inChild([&] {
                const FileLock third(folder / "s.lock");
                return third.held() ? "held" : std::to_string(third.other()->process);
              }),
              pid);
  }
  EXPECT_EQ(folder.fileCount(), 0u);
  EXPECT_TRUE(FileLock(folder / "s.lock").held());
}

TEST(FileLock, IsTakenOverFromAKilledProgram) {
  const TemporaryFolder folder;
  (void)inChild([&]() -> std::string {
    const FileLock lock(folder / "s.lock");
    ::kill(::getpid(), SIGKILL);
    return "";
  });
  ASSERT_EQ(folder.fileCount(), 1u);
  const FileLock lock(folder / "s.lock");
  EXPECT_TRUE(lock.held());
  ASSERT_TRUE(lock.stale());
  EXPECT_NE(lock.stale()->process, ::getpid());
  EXPECT_TRUE(sessions::hasEnded(*lock.stale()));
}

TEST(FileLock, Query_KnowsAHolderAndNeitherTakesNorChangesTheLock) {
  const TemporaryFolder folder;
  EXPECT_FALSE(sessions::isLocked(folder / "s.lock"));
  EXPECT_EQ(folder.fileCount(), 0u);
  {
    const FileLock lock(folder / "s.lock");
    const std::string named = folder.read("s.lock");
    EXPECT_TRUE(sessions::isLocked(folder / "s.lock"));
    EXPECT_EQ(folder.read("s.lock"), named);
  }
  (void)inChild([&]() -> std::string {
    const FileLock lock(folder / "s.lock");
    ::kill(::getpid(), SIGKILL);
    return "";
  });
  ASSERT_EQ(folder.fileCount(), 1u);
  EXPECT_FALSE(sessions::isLocked(folder / "s.lock")) << "its holder was killed";
  EXPECT_TRUE(FileLock(folder / "s.lock").stale());
}

TEST(FileLock, KnowsAProcessByItsStartToo) {
  const TemporaryFolder folder;
  const FileLock lock(folder / "s.lock");
  sessions::LockHolder holder = sessions::readLockFile(folder / "s.lock").value();
  EXPECT_FALSE(sessions::hasEnded(holder));
  holder.process_start += 1;  // the number was given to another process
  EXPECT_TRUE(sessions::hasEnded(holder));
  holder.host = "elsewhere";
  EXPECT_FALSE(sessions::hasEnded(holder));
}

TEST(FileLock, TakesARubbishFileAndSaysWhenItCannotBeWritten) {
  const TemporaryFolder folder;
  for (const char* text : {"", "{", "{}", "[1]", R"({"process": "x"})"}) {
    folder.write("s.lock", text);
    EXPECT_FALSE(sessions::readLockFile(folder / "s.lock")) << text;
    EXPECT_TRUE(FileLock(folder / "s.lock").held()) << text;
  }
  EXPECT_THAT(folder.message([&] { FileLock lock(folder / "none/s.lock"); }),
              HasSubstr("cannot write none/s.lock: No such file"));
}

}  // namespace
}  // namespace boresight::test
