// SPDX-License-Identifier: Apache-2.0
// The log of a program: what it read, ran, stored and reported, in a file that outlives its windows
// and terminals. Off unless a program starts it: libraries and tests write none.
#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <string>

namespace boresight::sessions {

/// What a log takes, from nothing on; each level includes those before it.
enum class LogLevel : int {
  kOff,
  kError,  ///< messages to the operator
  kInfo,   ///< and runs, locks, recoveries, files written
  kDebug,  ///< and files read
};
inline constexpr std::array<const char*, 4> kLogLevelNames = {"off", "error", "info", "debug"};

/// boresight/boresight.log in $XDG_STATE_HOME, or in ~/.local/state without it. Empty without both.
std::filesystem::path userLogFile();

/// Appends to this file from now on; at 2 MB it is renamed to boresight.1.log and so on, of which
/// two are kept. Programs may share the file, whichever renames it: each line names its process. A
/// file that cannot be written leaves the log off and is no error; nor is a disk that gets full.
/// Not thread-safe.
void startLog(const std::filesystem::path& file, LogLevel level);
/// Ends the log. Not thread-safe.
void stopLog();

/// The file of a log that is on; empty when it is off.
std::filesystem::path logFile();

namespace log_detail {
extern std::atomic<LogLevel> taken;
void write(LogLevel level, const std::string& text);
}  // namespace log_detail

inline bool logTakes(LogLevel level) {
  return level <= log_detail::taken.load(std::memory_order_relaxed);
}

/// Appends a line: time (UTC), process, level, and the text that `compose` returns, with blanks for
/// control characters. `compose` is called only if the log takes the level. Thread-safe.
template <class Compose>
void logEvent(LogLevel level, const Compose& compose) {
  if (logTakes(level)) log_detail::write(level, compose());
}

}  // namespace boresight::sessions
