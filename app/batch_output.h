// SPDX-License-Identifier: Apache-2.0
// Shared parts of commands that write results run by run.
#pragma once

#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::app {

/// Turns an interrupt into a stop, so that completed runs are still written.
class InterruptWatch {
 public:
  explicit InterruptWatch(const std::stop_source& source);
  ~InterruptWatch();

 private:
  std::jthread thread_;
};

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
