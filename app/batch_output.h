// SPDX-License-Identifier: Apache-2.0
// What commands share that write results run by run.
#pragma once

#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::app {

/// Turns an interrupt into a stop: what has been run is then still written.
class InterruptWatch {
 public:
  explicit InterruptWatch(const std::stop_source& source);
  ~InterruptWatch();

 private:
  std::jthread thread_;
};

/// A line of stderr that rewrites itself on a terminal; nothing elsewhere.
class TerminalLine {
 public:
  TerminalLine();
  void show(const std::string& text) const;
  void erase() const;

 private:
  bool on_terminal_;
};

/// The command as it was typed, near enough to be typed again.
std::string typedCommand();

/// JSON lines, one a run. OutputError.
void writeResultLines(const std::string& file, const std::vector<sessions::RunResult>& results);

}  // namespace boresight::app
