// SPDX-License-Identifier: Apache-2.0
// Shared parts of commands that write results run by run.
#pragma once

#include <array>
#include <csignal>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::app {

/// Turns SIGINT, SIGTERM, SIGHUP and SIGPIPE into a stop, so that completed runs are still written.
/// A signal that was ignored before (nohup) stays ignored. One at a time in a process.
class InterruptWatch {
 public:
  explicit InterruptWatch(const std::stop_source& source);
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// The first signal since the start; 0: none.
  int signal() const;
  /// 128 + signal, as shells report it; `code` when there was none.
  int exitCode(int code) const { return signal() == 0 ? code : 128 + signal(); }

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

  std::array<struct sigaction, kSignals.size()> before_{};
  std::jthread thread_;
};

/// Ends the program by SIGINT, SIGTERM or SIGHUP as without a handler, but without a temporary file
/// that it has not finished. While an InterruptWatch lives, that receives the signal. A signal that
/// was ignored before stays ignored. One in a process.
class SignalEnd {
 public:
  SignalEnd();
  ~SignalEnd();
  SignalEnd(const SignalEnd&) = delete;
  SignalEnd& operator=(const SignalEnd&) = delete;

 private:
  std::jthread thread_;
};

/// After an interrupt of a command that continues its results.
inline constexpr const char* kInterruptedNote =
    "interrupted; run the same command again to continue";

/// A line of stderr that is rewritten on a terminal; without effect elsewhere.
class TerminalLine {
 public:
  TerminalLine();
  void show(const std::string& text) const;
  void erase() const;

 private:
  bool on_terminal_;
};

/// The command line of this program, with words quoted where a shell needs it.
std::string typedCommand();

/// Writes JSON lines, one per run. OutputError.
void writeResultLines(const std::string& file, const std::vector<sessions::RunResult>& results);

}  // namespace boresight::app
