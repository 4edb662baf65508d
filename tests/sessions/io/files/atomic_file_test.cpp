// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <string>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/files/unfinished_file.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

using AtomicFile = FolderTest;

TEST_F(AtomicFile, WritesANewFileAndNothingElse) {
  for (const char* text : {"hello\n", ""}) {
    writeFileAtomically(folder_ / "out.json", text);
    EXPECT_EQ(folder_.read("out.json"), text);
    EXPECT_EQ(folder_.fileCount(), 1u);
    fs::remove(folder_ / "out.json");
  }
}

TEST_F(AtomicFile, ReplacesAFileKeepsItsPermissionsAndFollowsASymbolicLink) {
  const fs::path file = folder_.write("real/out", "a much longer text that was there before");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real/out", folder_ / "link");
  for (const char* name : {"real/out", "link"}) {
    writeFileAtomically(folder_ / name, name);
    EXPECT_EQ(folder_.read("real/out"), name);
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(AtomicFile, MissingFolderOrAFolderAsTarget_IsRefusedBeforeTheRun) {
  fs::create_directory(folder_ / "out");
  folder_.write("plain", "x");
  for (const auto& [name, refusal] : {std::pair("no/out", "no such folder"),
                                      {"out", "is a folder"},
                                      {"plain/out", "Not a directory"}}) {
    const std::string expected = std::string("cannot write ") + name + ": " + refusal;
    EXPECT_EQ(folder_.message([&] { requireWritable(folder_ / name); }), expected);
    if (refusal == std::string("Not a directory")) continue;
    EXPECT_EQ(folder_.message([&] { writeFileAtomically(folder_ / name, "x"); }), expected);
  }
  EXPECT_EQ(folder_.message([&] { requireWritable(folder_ / "new"); }), "(nothing)");
  EXPECT_EQ(folder_.fileCount(), 2u);
}

TEST_F(AtomicFile, ReportsAFullDeviceAndLeavesItAlone) {
  const fs::path full = "/dev/full";
  if (!fs::exists(full)) GTEST_SKIP() << "there is no /dev/full here";
  EXPECT_EQ(folder_.message([&] { writeFileAtomically(full, "x"); }),
            "cannot write /dev/full: no space left on the device");
  EXPECT_TRUE(fs::is_character_file(full));
  fs::create_symlink(full, folder_ / "link");
  EXPECT_EQ(folder_.message([&] { writeFileAtomically(folder_ / "link", "x"); }),
            "cannot write link: no space left on the device");
}

/// As /dev/stdout, which may be a pipe, or a file that holds what was printed before.
TEST_F(AtomicFile, OpenFileOfTheProcess_IsWrittenAtItsPlace) {
  const fs::path file = folder_.write("o.txt", std::string_view(""));
  const int open = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::write(open, "first ", 6), 6);
  fs::create_symlink("/proc/self/fd/" + std::to_string(open), folder_ / "link");
  requireWritable(folder_ / "link");
  writeFileAtomically(folder_ / "link", std::string_view("second"));
  ASSERT_EQ(::write(open, " third", 6), 6);
  ::close(open);
  EXPECT_EQ(folder_.read("o.txt"), "first second third");
  int ends[2] = {};
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  writeFileAtomically("/dev/fd/" + std::to_string(ends[1]), std::string_view("piped"));
  char text[8] = {};
  EXPECT_EQ(::read(ends[0], text, sizeof(text)), 5);
  EXPECT_STREQ(text, "piped");
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(AtomicFile, KeepsTheOldFileWhenWritingFailsHalfWay) {
  folder_.write("out", "old");
  // A limit on file sizes fails the write after its first bytes, as a full disk would.
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message =
      folder_.message([&] { writeFileAtomically(folder_ / "out", std::string(5000, 'x')); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, StartsWith("cannot write out: "));
  EXPECT_EQ(folder_.read("out"), "old");
  EXPECT_EQ(folder_.fileCount(), 1u);
}

TEST_F(AtomicFile, RespectsReadOnlyFoldersAndFiles) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const fs::path file = folder_.write("locked/out", "old");
  fs::permissions(file, fs::perms::owner_read);
  EXPECT_EQ(folder_.message([&] { writeFileAtomically(file, "x"); }),
            "cannot write locked/out: permission denied");
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  const std::string denied = "cannot write locked/new: permission denied";
  EXPECT_EQ(folder_.message([&] { writeFileAtomically(folder_ / "locked/new", "x"); }), denied);
  EXPECT_EQ(folder_.message([&] { requireWritable(folder_ / "locked/new"); }), denied);
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
  EXPECT_EQ(folder_.read("locked/out"), "old");
}

TEST(Sha256Text, HashesTheExampleOfTheStandard) {
  const std::string text = "abc";
  EXPECT_EQ(sha256Text(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), 3)),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(FileErrors, AreOneLine) {
  EXPECT_STREQ(InputError("a.json", "x.y", "bad\n\tthing").what(), "a.json: x.y: bad thing");
  EXPECT_STREQ(InputError("a.json", "bad").what(), "a.json: bad");
  EXPECT_STREQ(OutputError("a\nb", "full").what(), "cannot write a b: full");
}

void fill(const fs::path& path) {
  writeFileAtomically(path / "a", std::string_view("1"));
  fs::create_directory(path / "deep");
  writeFileAtomically(path / "deep/b", std::string_view("2"));
}

TEST_F(AtomicFile, FolderAppearsWithAllItsFiles) {
  writeFolderAtomically(folder_ / "new", fill);
  EXPECT_EQ(folder_.read("new/a"), "1");
  EXPECT_EQ(folder_.read("new/deep/b"), "2");
  EXPECT_EQ(folder_.fileCount(), 4u);
  // An empty folder may stand there already, and a slash at the end changes nothing.
  fs::create_directory(folder_ / "empty");
  writeFolderAtomically(folder_ / "empty/", fill);
  EXPECT_EQ(folder_.read("empty/a"), "1");
}

TEST_F(AtomicFile, FailedWriteOfAFolder_LeavesNoFolder) {
  const auto failing = [](const fs::path& to) {
    fill(to);
    throw std::runtime_error("broken off");
  };
  EXPECT_THROW(writeFolderAtomically(folder_ / "new", failing), std::runtime_error);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(AtomicFile, FolderReplacesNothing) {
  folder_.write("full/a", std::string_view("mine"));
  const auto message = [&](const char* name) {
    return folder_.message([&] { writeFolderAtomically(folder_ / name, fill); });
  };
  EXPECT_THAT(message("full"), HasSubstr("the name exists"));
  EXPECT_THAT(message("full/a"), HasSubstr("the name exists"));
  EXPECT_THAT(message("none/new"), HasSubstr("cannot write"));
  EXPECT_THROW(writeFolderAtomically("", fill), OutputError);
  EXPECT_EQ(folder_.read("full/a"), "mine");
  EXPECT_EQ(folder_.fileCount(), 2u);
}

/// A signal that ends the program while it writes.
TEST_F(AtomicFile, UnfinishedWhenTheProgramEnds_IsRemoved) {
  const pid_t child = ::fork();
  if (child == 0) {
    writeFolderAtomically(folder_ / "out", [](const fs::path& temporary) {
      fs::create_directory(temporary / "inside");
      removeUnfinishedFiles();
      ::_exit(0);
    });
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

}  // namespace
}  // namespace boresight::sessions
