// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/file_bytes.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;

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

TEST(FileBytes, PipesSocketsAndDevicesAreRefusedWithoutReading) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  makeSocket(folder / "socket");
  for (const std::filesystem::path& file :
       {folder / "pipe", folder / "socket", std::filesystem::path("/dev/zero"),
        std::filesystem::path("/dev/null")}) {
    const std::string name =
        file.parent_path() == "/dev" ? file.string() : file.filename().string();
    const std::string expected = name + ": is a pipe, a socket or a device: give a regular file";
    EXPECT_EQ(folder.message([&] { (void)readFileBytes(file, kMegabyte); }), expected);
    EXPECT_EQ(folder.message([&] { (void)readBeginning(file, 8); }), expected);
  }
  EXPECT_EQ(folder.message([&] { (void)readBeginning(folder.path(), 8); }),
            folder.path().string() + ": is a folder, not a file");
}

TEST(FileBytes, BeginningHoldsAtMostTheBytesAskedFor) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "twelve bytes");
  EXPECT_EQ(asText(readBeginning(file, 6)), "twelve");
  EXPECT_EQ(asText(readBeginning(file, 100)), "twelve bytes");
  EXPECT_EQ(folder.message([&] { (void)readBeginning(folder.write("empty", ""), 6); }),
            "empty: the file is empty");
}

}  // namespace
}  // namespace boresight::sessions
