// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/append_file.h"
#include "sessions/io/files/link_target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/unfinished_file.h"
#include "sessions/log/program_log.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::string writeReason(int error) {
  if (error == ENOENT) return "no such folder";
  if (error == EISDIR) return "is a folder";
  if (error == ENOSPC) return "no space left on the device";
  if (error == EACCES || error == EPERM) return "permission denied";
  if (error == EROFS) return "the file system is read-only";
  return std::strerror(error);
}

[[noreturn]] void fail(const fs::path& file, int error) {
  throw OutputError(file, writeReason(error));
}

/// The number in the name of an open file of this process, such as /proc/self/fd/1.
std::optional<int> descriptorIn(const fs::path& name) {
  const fs::path folder = name.parent_path();
  if (folder != "/proc/self/fd" && folder != "/dev/fd") return std::nullopt;
  return numberIn<int>(name.filename().string());
}

/// Owns the descriptor, and the temporary name until it is renamed away.
class OpenFile {
 public:
  OpenFile(fs::path reported, fs::path name, int flags, bool temporary)
      : reported_(std::move(reported)), name_(std::move(name)) {
    if (temporary) unfinished_.emplace(name_);
    descriptor_ = ::open(name_.c_str(), flags | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(reported_, errno);
    temporary_ = temporary;
  }
  /// Another name of an open file: its place to write is shared with the standard output.
  OpenFile(fs::path reported, int descriptor) : reported_(std::move(reported)) {
    std::cout.flush();
    descriptor_ = ::dup(descriptor);
    if (descriptor_ < 0) fail(reported_, errno);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (temporary_) ::unlink(name_.c_str());
  }

  void write(std::span<const std::uint8_t> bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail(reported_, count < 0 ? errno : EIO);
      done += static_cast<std::size_t>(count);
    }
  }
  /// The next bytes are written after these; they must be all that the file has.
  void goToEnd(std::uint64_t size_bytes) const {
    const off_t end = ::lseek(descriptor_, 0, SEEK_END);
    if (end < 0) fail(reported_, errno);
    if (static_cast<std::uint64_t>(end) != size_bytes)
      throw OutputError(reported_, "another program has changed it");
  }
  void setMode(mode_t mode) const {
    if (::fchmod(descriptor_, mode & 07777) != 0) fail(reported_, errno);
  }
  /// Waits until the bytes are stored, and closes.
  void finish() {
    // Pipes and some devices cannot be synchronized; that is no failure to write.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) fail(reported_, errno);
    const int result = ::close(std::exchange(descriptor_, -1));
    if (result != 0 && errno != EINTR) fail(reported_, errno);
  }
  void renameTo(const fs::path& target) {
    if (::rename(name_.c_str(), target.c_str()) != 0) fail(reported_, errno);
    temporary_ = false;
  }

 private:
  fs::path reported_;
  fs::path name_;
  int descriptor_ = -1;
  bool temporary_ = false;
  std::optional<UnfinishedFile> unfinished_;  ///< released after the name is removed
};

fs::path folderOf(const fs::path& file) {
  return file.parent_path().empty() ? fs::path(".") : file.parent_path();
}

/// Names no file: a killed program may have left one of the same process number.
fs::path temporaryName(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  for (;;) {
    fs::path name = folderOf(target) / (".boresight-" + std::to_string(::getpid()) + "-" +
                                        std::to_string(counter.fetch_add(1)) + ".tmp");
    if (!fs::exists(fs::symlink_status(name, error))) return name;
  }
}

/// Waits until the bytes of all files below a folder are stored, and their names.
void syncBelow(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) syncFolder(entry.path());
    if (!entry.is_regular_file()) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail(entry.path(), errno);
    const int error = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    if (error != 0) fail(entry.path(), error);
  }
}

/// The file that is created or replaced.
struct Target {
  fs::path file;               ///< not a link
  std::optional<mode_t> mode;  ///< of a file that exists

  std::optional<int> descriptor() const { return descriptorIn(file); }
  bool isDevice() const { return descriptor() || (mode && !S_ISREG(*mode)); }
};

Target targetOf(const fs::path& file, FileUse use) {
  if (file.empty()) throw OutputError("(no name)", "a file name is empty");
  requireNoInput(file, use);
  Target target{linkTarget(file), std::nullopt};
  struct stat existing {};
  if (target.descriptor() || ::stat(target.file.c_str(), &existing) != 0) return target;
  if (S_ISDIR(existing.st_mode)) fail(file, EISDIR);
  // Renaming would replace a write-protected file, which only asks the folder.
  if (::access(target.file.c_str(), W_OK) != 0) fail(file, errno);
  target.mode = existing.st_mode;
  return target;
}

void logWritten(const fs::path& target) {
  logEvent(LogLevel::kInfo, [&target] {
    std::error_code folder;
    const std::uintmax_t bytes = fs::file_size(target, folder);
    return target.string() + ": written" + (folder ? "" : ", " + std::to_string(bytes) + " B");
  });
}

}  // namespace

void syncFolder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)::fsync(descriptor);
  ::close(descriptor);
}

fs::path linkTarget(const fs::path& file) {
  constexpr int kMaxLinks = 40;
  fs::path target = file;
  for (int i = 0; i < kMaxLinks; ++i) {
    std::error_code error;
    if (descriptorIn(target)) return target;
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
    const fs::path next = folderOf(target) / fs::read_symlink(target, error);
    if (error) fail(file, error.value());
    if (descriptorIn(next)) return next;
    target = fs::weakly_canonical(next.parent_path(), error) / next.filename();
    if (error) fail(file, error.value());
  }
  fail(file, ELOOP);
}

void writeFileAtomically(const fs::path& file, std::span<const std::uint8_t> bytes, FileUse use) {
  const Target target = targetOf(file, use);
  if (const auto descriptor = target.descriptor()) {
    OpenFile open(file, *descriptor);
    open.write(bytes);
    return open.finish();
  }
  if (target.isDevice()) {
    OpenFile device(file, target.file, 0, false);
    device.write(bytes);
    return device.finish();
  }
  OpenFile temporary(file, temporaryName(target.file), O_CREAT | O_EXCL, true);
  temporary.write(bytes);
  if (target.mode) temporary.setMode(*target.mode);
  temporary.finish();
  temporary.renameTo(target.file);
  syncFolder(folderOf(target.file));  // the rename must survive a power cut
  noteOutput(target.file, use);
  logWritten(target.file);
}

void writeFileAtomically(const fs::path& file, std::string_view text, FileUse use) {
  writeFileAtomically(
      file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), use);
}

void appendToFile(const fs::path& file, std::uint64_t size_bytes, std::string_view text) {
  OpenFile opened(file, file, 0, false);
  opened.goToEnd(size_bytes);
  try {
    opened.write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    opened.finish();
  } catch (const OutputError&) {
    (void)::truncate(file.c_str(), static_cast<off_t>(size_bytes));  // else seen by the next append
    throw;
  }
}

void moveIntoPlace(const fs::path& finished, const fs::path& file, FileUse use) {
  requireNoInput(file, use);
  const int descriptor = ::open(finished.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0) fail(file, error);
  const fs::path target = linkTarget(file);
  if (descriptorIn(target)) throw OutputError(file, "it is no file: give the name of one");
  if (::rename(finished.c_str(), target.c_str()) != 0) fail(file, errno);
  syncFolder(folderOf(target));
  noteOutput(target, use);
  logWritten(target);
}

void requireWritable(const fs::path& file, FileUse use) {
  const Target target = targetOf(file, use);
  if (target.isDevice()) return;
  const fs::path folder = folderOf(target.file);
  struct stat info {};
  if (::stat(folder.c_str(), &info) != 0) fail(file, errno);
  if (!S_ISDIR(info.st_mode)) fail(file, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(file, errno);
}

void writeFolderAtomically(const fs::path& folder,
                           const std::function<void(const fs::path&)>& write) {
  if (folder.empty()) throw OutputError("(no name)", "a folder name is empty");
  fs::path target = fs::absolute(folder).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();  // written with a slash at its end
  std::error_code error;
  const fs::file_status status = fs::symlink_status(target, error);
  const bool there = fs::exists(status);
  if (there && !(fs::is_directory(status) && fs::is_empty(target, error)))
    throw OutputError(folder, "the name exists; give a new folder");
  const fs::path temporary = temporaryName(target);
  const UnfinishedFile unfinished(temporary);
  if (::mkdir(temporary.c_str(), 0777) != 0) fail(target, errno);
  try {
    write(temporary);
    syncBelow(temporary);
    moveIntoPlace(temporary, target);
  } catch (...) {
    fs::remove_all(temporary, error);
    throw;
  }
}

}  // namespace boresight::sessions
