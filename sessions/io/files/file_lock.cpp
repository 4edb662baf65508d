// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/log/program_log.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::string hostName() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "?";
  return name.data();
}

/// Field 22 of /proc/PID/stat; 0 when there is no such process.
std::int64_t processStart(std::int64_t process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::size_t name_end = text.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int field = 3; field < 22; ++field) fields >> skipped;
  std::int64_t start = 0;
  fields >> start;
  return start;
}

/// Writes who holds the lock: this process. False with errno when it cannot be written.
bool writeHolder(int descriptor) {
  nlohmann::ordered_json json;
  json["process"] = ::getpid();
  json["host"] = hostName();
  json["time"] = utcNowText();
  json["process_start"] = processStart(::getpid());
  const std::string text =
      json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return ::ftruncate(descriptor, 0) == 0 &&
         ::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

/// Whether the name still leads to the open file: its holder may have removed it meanwhile.
bool isStillNamed(int descriptor, const fs::path& file) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// A query by isLocked() holds the file for some microseconds.
bool takeWithinQueries(int descriptor) {
  constexpr int kAttempts = 5;
  for (int i = 0; i < kAttempts; ++i) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return false;
    ::usleep(2000);
  }
  errno = EWOULDBLOCK;
  return false;
}

}  // namespace

std::string LockHolder::text() const {
  return "process " + std::to_string(process) + " on host " + host + ", since " + time;
}

std::optional<LockHolder> readLockFile(const fs::path& lock_file) {
  constexpr std::size_t kMost = 4096;
  try {
    const nlohmann::json json = nlohmann::json::parse(readBeginning(lock_file, kMost));
    LockHolder holder;
    holder.process = json.at("process").get<std::int64_t>();
    holder.host = json.at("host").get<std::string>();
    holder.time = json.at("time").get<std::string>();
    holder.process_start = json.at("process_start").get<std::int64_t>();
    return holder;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool hasEnded(const LockHolder& holder) {
  if (holder.host != hostName()) return false;
  const std::int64_t start = processStart(holder.process);
  return start == 0 || start != holder.process_start;
}

bool isLocked(const fs::path& lock_file) {
  const int descriptor = ::open(lock_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  // Shared: queries do not exclude each other.
  const bool free = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  const bool refused = !free && errno == EWOULDBLOCK;
  ::close(descriptor);
  if (free || refused) return refused;
  const std::optional<LockHolder> holder = readLockFile(lock_file);
  return holder && !hasEnded(*holder);
}

FileLock::FileLock(const fs::path& lock_file) : file_(lock_file) {
  // The holder may remove the file between our open and our flock; then the name is tried again.
  constexpr int kAttempts = 100;
  for (int i = 0; i < kAttempts; ++i) {
    if (!take()) continue;
    log();
    return;
  }
  throw OutputError(file_, "other programs take the lock repeatedly; try again");
}

bool FileLock::take() {
  const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw OutputError(file_, std::strerror(errno));
  const bool locked = takeWithinQueries(descriptor);
  const bool refused = !locked && errno == EWOULDBLOCK;
  if (locked && !isStillNamed(descriptor, file_)) {
    ::close(descriptor);
    return false;
  }
  const std::optional<LockHolder> holder = readLockFile(file_);
  // On a file system without flock the holder that the file names decides.
  if (refused || (!locked && holder && !hasEnded(*holder))) {
    ::close(descriptor);
    other_ = holder;
    return true;
  }
  stale_ = holder;
  if (writeHolder(descriptor)) {
    descriptor_ = descriptor;
    return true;
  }
  const int error = errno;
  if (locked) ::unlink(file_.c_str());
  ::close(descriptor);
  if (locked)
    throw OutputError(file_,
                      error == ENOSPC ? "no space left on the device" : std::strerror(error));
  return true;  // neither flock nor a lock file: not held
}

void FileLock::log() const {
  logEvent(LogLevel::kInfo, [this] {
    const std::string text = file_.string() + ": ";
    if (!held()) return text + "held by " + (other_ ? other_->text() : "another program");
    return text + "locked" + (stale_ ? "; it was left by " + stale_->text() : std::string());
  });
}

FileLock::~FileLock() {
  if (!held()) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
  logEvent(LogLevel::kInfo, [this] { return file_.string() + ": released"; });
}

}  // namespace boresight::sessions
