// SPDX-License-Identifier: Apache-2.0
#include "sessions/log/program_log.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/file_lock.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

class ProgramLog : public testing::Test {
 protected:
  ~ProgramLog() override { stopLog(); }
  std::string text() const { return folder_.read("state/boresight.log"); }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "state/boresight.log";
};

void logText(LogLevel level, const std::string& text) {
  logEvent(level, [&text] { return text; });
}

TEST_F(ProgramLog, UntilItIsStarted_IsOffAndComposesNothing) {
  EXPECT_EQ(logFile(), "");
  bool composed = false;
  logEvent(LogLevel::kError, [&composed] {
    composed = true;
    return std::string("text");
  });
  EXPECT_FALSE(composed);
}

TEST_F(ProgramLog, LinesHaveTimeProcessAndLevel_AndStayLines) {
  startLog(file_, LogLevel::kInfo);
  EXPECT_EQ(logFile(), file_);
  logText(LogLevel::kInfo, "run begins\nforged line \x1b[2J");
  logText(LogLevel::kError, "cannot write a {} %s");
  logText(LogLevel::kDebug, "not taken");
  EXPECT_THAT(text(),
              testing::MatchesRegex("[0-9-]+T[0-9:.]+Z [0-9]+ info run begins forged line .2J\n"
                                    "[0-9-]+T[0-9:.]+Z [0-9]+ error cannot write a \\{\\} %s\n"));
}

TEST_F(ProgramLog, IsContinuedAndRotated) {
  for (int start = 0; start < 2; ++start) {
    startLog(file_, LogLevel::kInfo);
    logText(LogLevel::kInfo, "start " + std::to_string(start));
  }
  EXPECT_THAT(text(), AllOf(HasSubstr("start 0"), HasSubstr("start 1")));
  for (int i = 0; i < 900; ++i) logText(LogLevel::kInfo, std::string(10000, 'x'));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state")) {
    EXPECT_LE(entry.file_size(), 2'000'000u);
    ++files;
  }
  EXPECT_EQ(files, 3u);
}

/// Writes 1000 B lines of programs that run at the same time and rename the file.
TEST_F(ProgramLog, ProgramsThatShareIt_LoseNoLineWhenItIsRotated) {
  constexpr int kPrograms = 3;
  constexpr int kLines = 1500;
  std::vector<pid_t> programs;
  for (int program = 0; program < kPrograms; ++program) {
    programs.push_back(::fork());
    if (programs.back() != 0) continue;
    startLog(file_, LogLevel::kInfo);
    for (int line = 0; line < kLines; ++line)
      logText(LogLevel::kInfo, "line " + std::to_string(program) + "," + std::to_string(line) +
                                   std::string(1000, '.'));
    ::_exit(0);
  }
  for (const pid_t program : programs) ASSERT_EQ(::waitpid(program, nullptr, 0), program);
  std::set<std::string> lines;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state")) {
    EXPECT_LE(entry.file_size(), 2'000'000u + kPrograms * 1100u);
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      lines.insert(line.substr(line.find("line "), line.find("...") - line.find("line ")));
  }
  EXPECT_EQ(lines.size(), static_cast<std::size_t>(kPrograms * kLines));
}

TEST_F(ProgramLog, IsNotOpenInProgramsThatAreStarted) {
  startLog(file_, LogLevel::kInfo);
  bool found = false;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (std::filesystem::read_symlink(entry.path(), error) != file_) continue;
    found = true;
    const int flags = ::fcntl(std::stoi(entry.path().filename().string()), F_GETFD);
    EXPECT_TRUE((flags & FD_CLOEXEC) != 0);
  }
  EXPECT_TRUE(found);
}

TEST_F(ProgramLog, FolderThatCannotBeWritten_LeavesItOff) {
  for (const char* file : {"/dev/null/boresight/boresight.log", "/proc/boresight.log", ""}) {
    startLog(file, LogLevel::kDebug);
    logText(LogLevel::kError, "nothing happens");
    EXPECT_EQ(logFile(), "") << file;
    EXPECT_FALSE(logTakes(LogLevel::kError));
  }
}

TEST_F(ProgramLog, TakesLinesOfSeveralThreadsWhole) {
  startLog(file_, LogLevel::kInfo);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([] {
      for (int line = 0; line < 100; ++line) logText(LogLevel::kInfo, std::string(100, 'x'));
    });
  for (std::thread& thread : threads) thread.join();
  std::istringstream lines(text());
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_TRUE(line.ends_with(" info " + std::string(100, 'x'))) << line;
  EXPECT_EQ(count, 400);
}

TEST_F(ProgramLog, NamesLocksAndFilesWritten) {
  startLog(file_, LogLevel::kInfo);
  {
    const FileLock lock(folder_ / "s.lock");
    const FileLock other(folder_ / "s.lock");
  }
  writeFileAtomically(folder_ / "out.json", "text");
  EXPECT_THAT(text(), AllOf(HasSubstr("s.lock: locked\n"), HasSubstr("s.lock: held by process "),
                            HasSubstr("s.lock: released\n"), HasSubstr("out.json: written, 4 B")));
}

TEST(UserLogFile, IsInTheStateFolder) {
  ASSERT_EQ(::setenv("XDG_STATE_HOME", "/state", 1), 0);
  EXPECT_EQ(userLogFile(), "/state/boresight/boresight.log");
  ASSERT_EQ(::setenv("XDG_STATE_HOME", "relative", 1), 0);  // to be ignored by the standard
  ASSERT_EQ(::setenv("HOME", "/home/op", 1), 0);
  EXPECT_EQ(userLogFile(), "/home/op/.local/state/boresight/boresight.log");
  ::unsetenv("HOME");
  EXPECT_EQ(userLogFile(), "");
}

}  // namespace
}  // namespace boresight::sessions
