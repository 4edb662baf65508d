// SPDX-License-Identifier: Apache-2.0
#include "sessions/log/program_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 2'000'000;
constexpr int kOlderFiles = 2;

/// Lines of a file that several programs append to and rename when it is full. A line is one write
/// at the file's end. The program that holds the lock of the named file alone renames it; the
/// others notice before their next line that the name is of another file.
class SharedFileSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// std::system_error when the file cannot be opened.
  explicit SharedFileSink(fs::path file) : file_(std::move(file)) { open(); }
  SharedFileSink(const SharedFileSink&) = delete;
  SharedFileSink& operator=(const SharedFileSink&) = delete;
  ~SharedFileSink() override { ::close(descriptor_); }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (!isNamed()) open();
    struct stat info {};
    if (::fstat(descriptor_, &info) == 0 && info.st_size > 0 &&
        static_cast<std::size_t>(info.st_size) + line.size() > kMostBytes)
      rotate();
    if (::write(descriptor_, line.data(), line.size()) < 0)
      throw std::system_error(errno, std::generic_category());
  }
  void flush_() override {}

  void open() {
    const int opened = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (opened < 0) throw std::system_error(errno, std::generic_category());
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = opened;
  }

  bool isNamed() const {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor_, &opened) == 0 && ::stat(file_.c_str(), &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
  }

  /// boresight.1.log is the newest of the older files; number 0 is the file itself.
  fs::path numbered(int number) const {
    fs::path name = file_;
    if (number > 0)
      name.replace_filename(file_.stem().string() + "." + std::to_string(number) +
                            file_.extension().string());
    return name;
  }

  /// Nothing while another program rotates.
  void rotate() {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return;
    std::error_code error;
    for (int number = kOlderFiles; number > 0 && isNamed(); --number)
      fs::rename(numbered(number - 1), numbered(number), error);
    open();  // and releases the lock
  }

  fs::path file_;
  int descriptor_ = -1;
};

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
    auto logger =
        std::make_unique<spdlog::logger>("boresight", std::make_shared<SharedFileSink>(file));
    logger->set_formatter(std::make_unique<spdlog::pattern_formatter>(
        "%Y-%m-%dT%H:%M:%S.%eZ %P %l %v", spdlog::pattern_time_type::utc));
    logger->set_level(spdlog::level::debug);
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
