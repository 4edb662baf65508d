// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

namespace boresight::sessions {

/// Failure of a child process; what() continues a sentence that begins with its name.
class ChildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A command of the shell with its standard input and output on pipes; its standard error is read
/// and the last line kept. No call waits longer than its deadline, and a stop takes effect within
/// 50 ms. The destructor kills the process and all its children.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// ChildError when the process cannot be started.
  explicit ChildProcess(const std::string& command);
  ~ChildProcess();

  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Each throws ChildError: "died ...", "did not take its input in time", "did not answer in
  /// time", "was stopped".
  void write(std::span<const std::uint8_t> bytes, Clock::time_point deadline,
             const std::stop_token& stop);
  /// Reads a line, returned without its line break; also throws "wrote a line of more than N
  /// bytes".
  std::string readLine(std::size_t most, Clock::time_point deadline, const std::stop_token& stop);
  std::vector<std::uint8_t> read(std::size_t count, Clock::time_point deadline,
                                 const std::stop_token& stop);

 private:
  void wait(bool to_write, Clock::time_point deadline, const std::stop_token& stop);
  void drainErrors();
  bool receive();
  [[noreturn]] void died();

  pid_t pid_ = -1;
  int input_ = -1, output_ = -1, errors_ = -1;
  std::vector<std::uint8_t> received_;  ///< not yet returned to the caller
  std::string last_errors_;             ///< end of standard error
};

}  // namespace boresight::sessions
