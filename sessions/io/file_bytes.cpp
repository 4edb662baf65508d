// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/digest.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

constexpr const char* kSpecial = "is a pipe, a socket or a device: give a regular file";

std::string readReason(int error) {
  if (error == ENOENT) return "no such file";
  if (error == EISDIR) return "is a folder, not a file";
  if (error == ENXIO) return kSpecial;  // a socket
  if (error == EACCES) return "permission denied";
  return std::strerror(error);
}

/// An open regular file. Opening does not wait for the other end of a pipe.
class RegularFile {
 public:
  explicit RegularFile(const std::filesystem::path& file)
      : file_(file), number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (number_ < 0) throw InputError(file, readReason(errno));
  }
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  ~RegularFile() { ::close(number_); }

  std::size_t size() const {
    struct stat info {};
    if (::fstat(number_, &info) != 0) throw InputError(file_, readReason(errno));
    if (S_ISDIR(info.st_mode)) throw InputError(file_, readReason(EISDIR));
    if (!S_ISREG(info.st_mode)) throw InputError(file_, kSpecial);
    return static_cast<std::size_t>(info.st_size);
  }

  /// The first `count` bytes, or as many as there are; InputError when there is none.
  std::vector<std::uint8_t> beginning(std::size_t count) const {
    std::vector<std::uint8_t> bytes(count);
    std::size_t used = 0;
    while (used < count) {
      const ssize_t got = ::read(number_, bytes.data() + used, count - used);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw InputError(file_, readReason(errno));
      if (got == 0) break;
      used += static_cast<std::size_t>(got);
    }
    if (used == 0) throw InputError(file_, "the file is empty");
    bytes.resize(used);
    return bytes;
  }

 private:
  const std::filesystem::path& file_;
  int number_;
};

}  // namespace

std::vector<std::uint8_t> readFileBytes(const std::filesystem::path& file, std::size_t max_bytes,
                                        FileUse use) {
  if (file.empty()) throw InputError("(no name)", "a file name is empty");
  const RegularFile opened(file);
  const std::size_t size = opened.size();
  noteInput(file, use);
  if (size > max_bytes)
    throw InputError(file,
                     "larger than the limit of " + std::to_string(max_bytes / kMegabyte) + " MB");
  return opened.beginning(size);
}

std::vector<std::uint8_t> readBeginning(const std::filesystem::path& file, std::size_t count) {
  const RegularFile opened(file);
  return opened.beginning(std::min(count, opened.size()));
}

std::string_view asText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string sha256Text(std::span<const std::uint8_t> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return hexText(sha.digest()).data();
}

}  // namespace boresight::sessions
