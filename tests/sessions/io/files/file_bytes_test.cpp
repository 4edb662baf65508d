// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/file_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <cstring>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "tests/sessions/io/folder_test.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

using FileBytes = FolderTest;

/// A socket with a name, as a program that listens has it.
void makeSocket(const std::filesystem::path& file) {
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(file.string().size(), sizeof(address.sun_path));
  std::strcpy(address.sun_path, file.c_str());
  ASSERT_EQ(::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  ::close(descriptor);
}

TEST_F(FileBytes, PipesSocketsAndDevicesAreRefusedWithoutReading) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  makeSocket(folder_ / "socket");
  for (const fs::path& file :
       {folder_ / "pipe", folder_ / "socket", fs::path("/dev/zero"), fs::path("/dev/null")}) {
    const std::string name =
        file.parent_path() == "/dev" ? file.string() : file.filename().string();
    const std::string expected = name + ": is a pipe, a socket or a device: give a regular file";
    EXPECT_EQ(folder_.message([&] { (void)readFileBytes(file, kMegabyte); }), expected);
    EXPECT_EQ(folder_.message([&] { (void)readBeginning(file, 8); }), expected);
  }
  EXPECT_EQ(folder_.message([&] { (void)readBeginning(folder_.path(), 8); }),
            folder_.path().string() + ": is a folder, not a file");
}

TEST_F(FileBytes, WholeFileOrAtMostTheBytesAskedFor_AreRead) {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += static_cast<char>(i * 7);
  const auto file = folder_.write("file", text);
  EXPECT_EQ(asText(readFileBytes(file, kMegabyte)), text);
  EXPECT_EQ(readFileBytes(file, 200000).size(), 200000u);
  EXPECT_EQ(asText(readBeginning(file, 6)), text.substr(0, 6));
  EXPECT_EQ(asText(readBeginning(file, 200100)), text);
}

TEST_F(FileBytes, UnreadableFile_IsReportedWithTheReason) {
  folder_.write("empty", "");
  folder_.write("large", std::string(1001, 'x'));
  const auto message = [&](const fs::path& file) {
    return folder_.message([&] { readFileBytes(file, 1000); });
  };
  EXPECT_EQ(message(folder_ / "no"), "no: no such file");
  EXPECT_EQ(message(folder_ / "empty"), "empty: the file is empty");
  EXPECT_EQ(folder_.message([&] { (void)readBeginning(folder_ / "empty", 6); }),
            "empty: the file is empty");
  EXPECT_EQ(message(folder_ / "large"), "large: larger than the limit of 0 MB");
  EXPECT_EQ(message(folder_.path()), folder_.path().string() + ": is a folder, not a file");
}

TEST_F(FileBytes, WhatADownloadLeavesInPlaceOfAFile_IsNamed) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n";
  const std::string lfs = ": is a Git LFS pointer instead of the file: run git lfs pull";
  const std::string html = ": is an HTML page instead of the file: download the file itself";
  const std::pair<std::string, std::string> files[] = {
      {pointer, lfs}, {"\n<!DOCTYPE html>\n<p>", html}, {"\xEF\xBB\xBF<HTML lang=en>", html}};
  for (const auto& [content, refusal] : files) {
    const fs::path file = folder_.write("a.png", content);
    EXPECT_EQ(folder_.message([&] { (void)readFileBytes(file, kMegabyte); }), "a.png" + refusal);
    EXPECT_EQ(folder_.message([&] { (void)readBeginning(file, 8); }), "a.png" + refusal);
  }
}

TEST_F(FileBytes, Text_HasNoByteOrderMark) {
  using namespace std::string_view_literals;
  EXPECT_EQ(unmarkedText("a", "\xEF\xBB\xBFkind"sv), "kind");
  EXPECT_EQ(unmarkedText("a", "kind"sv), "kind");
  for (const std::string_view text : {"\xFF\xFEk\0"sv, "\xFE\xFF\0k"sv, "\0\0\xFE\xFF"sv})
    EXPECT_EQ(folder_.message([&] { (void)unmarkedText("a.csv", text); }),
              "a.csv: is UTF-16 or UTF-32 text: save it as UTF-8");
}

class InputFiles : public FolderTest {
 protected:
  /// Whether an output of this name and use is refused, and the file is as it was.
  bool isRefused(const std::string& name, FileUse use = FileUse::kInput) const {
    const std::string before = folder_.read(name);
    try {
      writeFileAtomically(folder_ / name, std::string_view("output"), use);
    } catch (const OverwriteError&) {
      EXPECT_EQ(folder_.read(name), before);
      EXPECT_THROW(requireWritable(folder_ / name, use), OverwriteError);
      return true;
    }
    EXPECT_EQ(folder_.read(name), "output");
    return false;
  }

  const fs::path input_ = folder_.write("input.png", "pixels");
};

TEST_F(InputFiles, AreNotReplacedByAnOutputNorByAFileThatIsMovedThere) {
  EXPECT_EQ(readFileBytes(input_, 100).size(), 6u);
  EXPECT_TRUE(isRefused("input.png"));
  EXPECT_FALSE(isRefused("other.png"));
  EXPECT_EQ(folder_.message([&] { writeFileAtomically(input_, std::string_view("output")); }),
            "cannot write input.png: it is the input input.png, which would be overwritten; give "
            "another file");
  EXPECT_THROW(moveIntoPlace(folder_.write("made", "output"), input_), OverwriteError);
  EXPECT_EQ(folder_.read("input.png"), "pixels");
}

TEST_F(InputFiles, AreNotReplacedByAnyOfTheirNames) {
  fs::create_symlink("input.png", folder_ / "symbolic.png");
  fs::create_symlink("symbolic.png", folder_ / "twice.png");
  fs::create_hard_link(input_, folder_ / "hard.png");
  fs::create_directory_symlink(folder_.path(), folder_ / "folder");
  readFileBytes(folder_ / "twice.png", 100);
  for (const char* name :
       {"input.png", "symbolic.png", "twice.png", "hard.png", "folder/input.png", "./input.png"})
    EXPECT_TRUE(isRefused(name)) << name;
}

TEST_F(InputFiles, AreNamedByOthers) {
  const JsonDocument document(folder_.write("d.json", R"({"image": "input.png"})"));
  (void)document.root().at("image").path();
  EXPECT_TRUE(isRefused("input.png")) << "a named input is protected before it is read";
}

TEST_F(InputFiles, ThatTheProgramKeepsUpToDateAreReplacedByTheirOwnKind) {
  readFileBytes(input_, 100, FileUse::kSession);
  EXPECT_TRUE(isRefused("input.png"));
  EXPECT_TRUE(isRefused("input.png", FileUse::kLandmarks));
  EXPECT_FALSE(isRefused("input.png", FileUse::kSession));
}

TEST_F(InputFiles, OfTwoUsesAreNotReplacedByEither) {
  for (const FileUse use : {FileUse::kSession, FileUse::kInput, FileUse::kSession})
    readFileBytes(input_, 100, use);
  EXPECT_TRUE(isRefused("input.png", FileUse::kSession));
}

TEST_F(InputFiles, ThatWereOnlyLookedAtAreReplaced) {
  readFileBytes(input_, 100, FileUse::kFree);
  EXPECT_FALSE(isRefused("input.png"));
}

TEST_F(InputFiles, ThatThisProcessWroteAreReplaced) {
  EXPECT_FALSE(isRefused("made.json"));
  readFileBytes(folder_ / "made.json", 100);
  EXPECT_FALSE(isRefused("made.json"));
  EXPECT_FALSE(isRefused("session.json", FileUse::kSession));
  EXPECT_TRUE(isRefused("session.json")) << "by another kind of output";
}

TEST_F(InputFiles, ThatAreGoneLeaveTheirPlaceToOthers) {
  readFileBytes(input_, 100);
  fs::remove(input_);
  // A file system may give the new file what told the old one from all others.
  folder_.write("next.png", "next");
  EXPECT_FALSE(isRefused("next.png"));
  EXPECT_FALSE(isRefused("input.png"));
}

}  // namespace
}  // namespace boresight::sessions
