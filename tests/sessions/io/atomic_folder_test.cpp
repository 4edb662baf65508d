// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/atomic_folder.h"

#include <gmock/gmock.h>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

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

TEST(AtomicFolder, LeavesNothingWhereWritingFails) {
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
  EXPECT_THAT(message("full"), HasSubstr("something of this name already"));
  EXPECT_THAT(message("full/a"), HasSubstr("something of this name already"));
  EXPECT_THAT(message("none/new"), HasSubstr("cannot write"));
  EXPECT_THROW(writeFolderAtomically("", fill), OutputError);
  EXPECT_EQ(folder.read("full/a"), "mine");
  EXPECT_EQ(folder.fileCount(), 2u);
}

}  // namespace
}  // namespace boresight::sessions
