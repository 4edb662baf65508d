// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <string>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

namespace fs = std::filesystem;

TEST(WriteFileAtomically, WritesANewFileAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* text : {"hello\n", ""}) {
    writeFileAtomically(folder / "out.json", text);
    EXPECT_EQ(folder.read("out.json"), text);
    EXPECT_EQ(folder.fileCount(), 1u);
    std::filesystem::remove(folder / "out.json");
  }
}

TEST(WriteFileAtomically, ReplacesAFileKeepsItsPermissionsAndFollowsASymbolicLink) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("real/out", "a much longer text that was there before");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real/out", folder / "link");
  for (const char* name : {"real/out", "link"}) {
    writeFileAtomically(folder / name, name);
    EXPECT_EQ(folder.read("real/out"), name);
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
}

TEST(WriteFileAtomically, MissingFolderOrAFolderAsTarget_IsRefusedBeforeTheRun) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  folder.write("plain", "x");
  for (const auto& [name, refusal] : {std::pair("no/out", "no such folder"),
                                      {"out", "is a folder"},
                                      {"plain/out", "Not a directory"}}) {
    const std::string expected = std::string("cannot write ") + name + ": " + refusal;
    EXPECT_EQ(folder.message([&] { requireWritable(folder / name); }), expected);
    if (refusal == std::string("Not a directory")) continue;
    EXPECT_EQ(folder.message([&] { writeFileAtomically(folder / name, "x"); }), expected);
  }
  EXPECT_EQ(folder.message([&] { requireWritable(folder / "new"); }), "(nothing)");
  EXPECT_EQ(folder.fileCount(), 2u);
}

TEST(WriteFileAtomically, ReportsAFullDeviceAndLeavesItAlone) {
  const fs::path full = "/dev/full";
  if (!fs::exists(full)) GTEST_SKIP() << "there is no /dev/full here";
  const TemporaryFolder folder;
  EXPECT_EQ(folder.message([&] { writeFileAtomically(full, "x"); }),
            "cannot write /dev/full: no space left on the device");
  EXPECT_TRUE(fs::is_character_file(full));
  fs::create_symlink(full, folder / "link");
  EXPECT_EQ(folder.message([&] { writeFileAtomically(folder / "link", "x"); }),
            "cannot write link: no space left on the device");
}

TEST(WriteFileAtomically, KeepsTheOldFileWhenWritingFailsHalfWay) {
  const TemporaryFolder folder;
  folder.write("out", "old");
  // A limit on file sizes fails the write after its first bytes, as a full disk would.
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message =
      folder.message([&] { writeFileAtomically(folder / "out", std::string(5000, 'x')); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, ::testing::StartsWith("cannot write out: "));
  EXPECT_EQ(folder.read("out"), "old");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteFileAtomically, RespectsReadOnlyFoldersAndFiles) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  const fs::path file = folder.write("locked/out", "old");
  fs::permissions(file, fs::perms::owner_read);
  EXPECT_EQ(folder.message([&] { writeFileAtomically(file, "x"); }),
            "cannot write locked/out: permission denied");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(folder.message([&] { writeFileAtomically(folder / "locked/new", "x"); }),
            "cannot write locked/new: permission denied");
  EXPECT_EQ(folder.message([&] { requireWritable(folder / "locked/new"); }),
            "cannot write locked/new: permission denied");
  fs::permissions(folder / "locked", fs::perms::owner_all);
  EXPECT_EQ(folder.read("locked/out"), "old");
}

TEST(ReadFileBytes, ReadsWhatIsThere) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 200000; ++i) text += static_cast<char>(i * 7);
  const auto bytes = readFileBytes(folder.write("file", text), kMegabyte);
  EXPECT_EQ(asText(bytes), text);
  EXPECT_EQ(readFileBytes(folder / "file", 200000).size(), 200000u);
}

TEST(ReadFileBytes, UnreadableFile_IsReportedWithTheReason) {
  const TemporaryFolder folder;
  folder.write("empty", "");
  folder.write("large", std::string(1001, 'x'));
  const auto message = [&](const fs::path& file) {
    return folder.message([&] { readFileBytes(file, 1000); });
  };
  EXPECT_EQ(message(folder / "no"), "no: no such file");
  EXPECT_EQ(message(folder / "empty"), "empty: the file is empty");
  EXPECT_EQ(message(folder / "large"), "large: larger than the limit of 0 MB");
  EXPECT_EQ(message(folder.path()), folder.path().string() + ": is a folder, not a file");
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

void fill(const std::filesystem::path& folder) {
  writeFileAtomically(folder / "a", std::string_view("1"));
  std::filesystem::create_directory(folder / "deep");
  writeFileAtomically(folder / "deep/b", std::string_view("2"));
}

TEST(AtomicFolder, AppearsWithAllItsFiles) {
  const TemporaryFolder folder;
  writeFolderAtomically(folder / "new", fill);
  EXPECT_EQ(folder.read("new/a"), "1");
  EXPECT_EQ(folder.read("new/deep/b"), "2");
  EXPECT_EQ(folder.fileCount(), 4u);
  // An empty folder may stand there already, and a slash at the end changes nothing.
  std::filesystem::create_directory(folder / "empty");
  writeFolderAtomically(folder / "empty/", fill);
  EXPECT_EQ(folder.read("empty/a"), "1");
}

TEST(AtomicFolder, FailedWrite_LeavesNoFolder) {
  const TemporaryFolder folder;
  const auto failing = [](const std::filesystem::path& to) {
    fill(to);
    throw std::runtime_error("broken off");
  };
  EXPECT_THROW(writeFolderAtomically(folder / "new", failing), std::runtime_error);
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(AtomicFolder, ReplacesNothing) {
  const TemporaryFolder folder;
  folder.write("full/a", std::string_view("mine"));
  const auto message = [&](const char* name) {
    return folder.message([&] { writeFolderAtomically(folder / name, fill); });
  };
  EXPECT_THAT(message("full"), HasSubstr("the name exists"));
  EXPECT_THAT(message("full/a"), HasSubstr("the name exists"));
  EXPECT_THAT(message("none/new"), HasSubstr("cannot write"));
  EXPECT_THROW(writeFolderAtomically("", fill), OutputError);
  EXPECT_EQ(folder.read("full/a"), "mine");
  EXPECT_EQ(folder.fileCount(), 2u);
}

}  // namespace
}  // namespace boresight::sessions
