// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/digest.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

std::string readReason(int error) {
  if (error == ENOENT) return "no such file";
  if (error == EISDIR) return "is a folder, not a file";
  if (error == EACCES) return "permission denied";
  return std::strerror(error);
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (number_ < 0) throw InputError(file, readReason(errno));
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }
  int number() const { return number_; }

 private:
  int number_;
};

std::string tooLarge(std::size_t max_bytes) {
  return "larger than the limit of " + std::to_string(max_bytes / kMegabyte) + " MB";
}

}  // namespace

std::vector<std::uint8_t> readFileBytes(const std::filesystem::path& file, std::size_t max_bytes,
                                        FileUse use) {
  if (file.empty()) throw InputError("(no name)", "a file name is empty");
  const Descriptor descriptor(file);
  struct stat info {};
  if (::fstat(descriptor.number(), &info) != 0) throw InputError(file, readReason(errno));
  if (S_ISDIR(info.st_mode)) throw InputError(file, readReason(EISDIR));
  noteInput(file, use);
  const auto stated_size = info.st_size > 0 ? static_cast<std::size_t>(info.st_size) : 0;
  if (stated_size > max_bytes) throw InputError(file, tooLarge(max_bytes));

  // A pipe states no size, so the buffer grows; one byte more than stated finds the end at once.
  std::vector<std::uint8_t> bytes(std::max(stated_size, std::size_t{65535}) + 1);
  std::size_t used = 0;
  while (true) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t count = ::read(descriptor.number(), bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(file, readReason(errno));
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used > max_bytes) throw InputError(file, tooLarge(max_bytes));
  }
  bytes.resize(used);
  if (bytes.empty()) throw InputError(file, "the file is empty");
  return bytes;
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
