// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <streambuf>
#include <string>

namespace boresight::app {

/// While this object exists, a stream prints plain text: control characters become blanks
/// (sessions/text/plain_text.h). Line feeds stay: the text within a line must not contain any. The
/// lines of messages are in the program's log, too.
class PlainOutput : private std::streambuf {
 public:
  enum class Lines { kResults, kMessages };

  explicit PlainOutput(std::ostream& stream, Lines lines = Lines::kResults);
  PlainOutput(const PlainOutput&) = delete;
  PlainOutput& operator=(const PlainOutput&) = delete;
  ~PlainOutput() override;

 private:
  int_type overflow(int_type character) override;
  int sync() override;
  bool writeLine();

  std::ostream& stream_;
  std::streambuf* target_;
  std::string line_;
  Lines lines_;
};

}  // namespace boresight::app
