// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace boresight::sessions {

/// The process that has a session open.
struct LockHolder {
  std::int64_t process = 0;
  std::string host;
  std::string time;  ///< UTC, when it was opened
  /// When the process began, in clock ticks since its host started: process numbers are reused.
  std::int64_t process_start = 0;

  bool operator==(const LockHolder&) const = default;
  /// "process 4711 on host grace, since 2026-01-31T23:59:59Z"
  std::string text() const;
};

/// The right to write a session, held as long as the object lives: an exclusive flock on the lock
/// file, which names the holder. The kernel drops the flock when the holder ends, however it ends.
class FileLock {
 public:
  /// Takes the lock unless another process holds it. OutputError when the lock file cannot be
  /// written at all.
  explicit FileLock(const std::filesystem::path& lock_file);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

  bool held() const { return descriptor_ >= 0; }
  /// The other holder; empty when this object holds the lock, or the holder is not yet named.
  const std::optional<LockHolder>& other() const { return other_; }
  /// The previous holder if it ended without releasing the lock (was killed); usually empty.
  const std::optional<LockHolder>& stale() const { return stale_; }

 private:
  bool take();
  void log() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::optional<LockHolder> other_;
  std::optional<LockHolder> stale_;
};

/// Whether a program holds this lock; nothing is written. False for a missing file.
bool isLocked(const std::filesystem::path& lock_file);

/// The holder named in a lock file; empty when the file is missing, empty or not a lock file.
std::optional<LockHolder> readLockFile(const std::filesystem::path& lock_file);

/// Whether the holder is known to have ended: its process was on this host and no longer exists.
/// Processes of other hosts are unknown.
bool hasEnded(const LockHolder& holder);

}  // namespace boresight::sessions
