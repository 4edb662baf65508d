// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/digest.h"
#include "sessions/io/files/errors.h"
#include "sessions/log/program_log.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identityOf(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return Identity(info.st_dev, info.st_ino);
}

struct Input {
  fs::path file;  ///< absolute
  FileUse use;
};

struct Inputs {
  std::mutex mutex;
  std::map<Identity, Input> noted;

  /// The input that has this identity still: of a file that is gone another one may get it.
  Input* find(const Identity& identity) {
    const auto found = noted.find(identity);
    if (found == noted.end() || identityOf(found->second.file) != identity) return nullptr;
    return &found->second;
  }
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

constexpr std::size_t kSubstituteBytes = 64;  ///< that show a pointer or a page

constexpr const char* kSpecial = "is a pipe, a socket or a device: give a regular file";

std::string readReason(int error) {
  if (error == ENOENT) return "no such file";
  if (error == EISDIR) return "is a folder, not a file";
  if (error == ENXIO) return kSpecial;  // a socket
  if (error == EACCES) return "permission denied";
  return std::strerror(error);
}

/// Whether the text begins with two characters of ASCII in UTF-16 of either byte order.
bool isUnmarkedUtf16(std::string_view text) {
  if (text.size() < 4) return false;
  const bool zero[] = {text[0] == 0, text[1] == 0, text[2] == 0, text[3] == 0};
  return zero[0] != zero[1] && zero[0] == zero[2] && zero[1] == zero[3];
}

/// InputError for what a download without Git LFS, or one that was refused, leaves in place of the
/// file.
void requireNoSubstitute(const fs::path& file, std::span<const std::uint8_t> bytes) {
  const auto text = withoutMark(asText(bytes.first(std::min(bytes.size(), kSubstituteBytes))));
  if (text.starts_with("version https://git-lfs.github.com/spec/"))
    throw InputError(file, "is a Git LFS pointer instead of the file: run git lfs pull");
  const std::string begin = lowerCase(trimmed(text));
  if (begin.starts_with("<!doctype html") || begin.starts_with("<html"))
    throw InputError(file, "is an HTML page instead of the file: download the file itself");
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
    std::vector<std::uint8_t> bytes(std::max(count, kSubstituteBytes));
    std::size_t used = 0;
    while (used < bytes.size()) {
      const ssize_t got = ::read(number_, bytes.data() + used, bytes.size() - used);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw InputError(file_, readReason(errno));
      if (got == 0) break;
      used += static_cast<std::size_t>(got);
    }
    if (used == 0) throw InputError(file_, "the file is empty");
    bytes.resize(used);
    requireNoSubstitute(file_, bytes);
    bytes.resize(std::min(used, count));
    return bytes;
  }

 private:
  const std::filesystem::path& file_;
  int number_;
};

}  // namespace

void noteInput(const fs::path& file, FileUse use) {
  const auto identity = identityOf(file);
  if (!identity || use == FileUse::kFree) return;
  logEvent(LogLevel::kDebug, [&file] { return file.string() + ": read"; });
  const std::lock_guard lock(inputs().mutex);
  Input* known = inputs().find(*identity);
  if (known == nullptr)
    inputs().noted.insert_or_assign(*identity, Input{fs::absolute(file), use});
  else if (known->use != use && known->use != FileUse::kFree)
    known->use = FileUse::kInput;
}

void noteOutput(const fs::path& output, FileUse use) {
  const auto identity = identityOf(output);
  if (!identity) return;
  if (use == FileUse::kInput) use = FileUse::kFree;
  const std::lock_guard lock(inputs().mutex);
  inputs().noted.insert_or_assign(*identity, Input{fs::absolute(output), use});
}

void requireNoInput(const fs::path& output, FileUse use) {
  const auto identity = identityOf(output);
  if (!identity) return;
  const std::lock_guard lock(inputs().mutex);
  const Input* known = inputs().find(*identity);
  if (known == nullptr || known->use == FileUse::kFree) return;
  if (known->use == use && use != FileUse::kInput) return;
  throw OverwriteError(output, known->file);
}

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

std::string_view withoutMark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view unmarkedText(const fs::path& file, std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("\xFE\xFF"sv) ||
      bytes.starts_with("\0\0\xFE\xFF"sv) || isUnmarkedUtf16(bytes))
    throw InputError(file, "is UTF-16 or UTF-32 text: save it as UTF-8");
  return withoutMark(bytes);
}

std::string_view textOf(const fs::path& file, std::string_view bytes) {
  return withoutPadding(unmarkedText(file, bytes));
}

std::string sha256Text(std::span<const std::uint8_t> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return hexText(sha.digest()).data();
}

std::string sha256Text(std::string_view text) {
  return sha256Text(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace boresight::sessions
