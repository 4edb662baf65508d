// SPDX-License-Identifier: Apache-2.0
#include "sessions/log/program_log.h"

#include <cstdlib>
#include <exception>
#include <memory>
#include <system_error>

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 2'000'000;
constexpr std::size_t kOlderFiles = 2;

/// Never destroyed: threads may write until the process ends.
struct Log {
  std::unique_ptr<spdlog::logger> logger;
  fs::path file;
};

Log& theLog() {
  static Log* const kLog = new Log;
  return *kLog;
}

spdlog::level::level_enum levelOf(LogLevel level) {
  if (level == LogLevel::kError) return spdlog::level::err;
  return level == LogLevel::kInfo ? spdlog::level::info : spdlog::level::debug;
}

/// A folder that others cannot read, as the standard of user folders asks for.
void makeFolder(const fs::path& folder) {
  std::error_code error;
  if (fs::create_directories(folder, error)) fs::permissions(folder, fs::perms::owner_all, error);
}

fs::path environmentPath(const char* name) {
  const char* value = std::getenv(name);
  const fs::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : fs::path();
}

}  // namespace

namespace log_detail {

std::atomic<LogLevel> taken{LogLevel::kOff};

void write(LogLevel level, const std::string& text) {
  if (theLog().logger) theLog().logger->log(levelOf(level), oneLine(text));
}

}  // namespace log_detail

fs::path userLogFile() {
  const fs::path state = environmentPath("XDG_STATE_HOME");
  if (!state.empty()) return state / "boresight" / "boresight.log";
  const fs::path home = environmentPath("HOME");
  return home.empty() ? fs::path() : home / ".local" / "state" / "boresight" / "boresight.log";
}

void startLog(const fs::path& file, LogLevel level) {
  stopLog();
  if (file.empty() || level == LogLevel::kOff) return;
  makeFolder(file.parent_path());
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file.string(), kMostBytes,
                                                                       kOlderFiles);
    auto logger = std::make_unique<spdlog::logger>("boresight", std::move(sink));
    logger->set_formatter(std::make_unique<spdlog::pattern_formatter>(
        "%Y-%m-%dT%H:%M:%S.%eZ %P %l %v", spdlog::pattern_time_type::utc));
    logger->set_level(spdlog::level::debug);
    logger->flush_on(spdlog::level::debug);  // a line is there when the program is killed
    logger->set_error_handler([](const std::string&) {});
    theLog() = {std::move(logger), file};
    log_detail::taken = level;
  } catch (const std::exception&) {
    stopLog();
  }
}

void stopLog() {
  log_detail::taken = LogLevel::kOff;
  theLog() = {};
}

fs::path logFile() { return theLog().file; }

}  // namespace boresight::sessions
