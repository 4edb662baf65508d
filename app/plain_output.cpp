// SPDX-License-Identifier: Apache-2.0
#include "app/plain_output.h"

#include "sessions/log/program_log.h"
#include "sessions/text/plain_text.h"

namespace boresight::app {

PlainOutput::PlainOutput(std::ostream& stream, Lines lines)
    : stream_(stream), target_(stream.rdbuf(this)), lines_(lines) {}

PlainOutput::~PlainOutput() {
  sync();
  stream_.rdbuf(target_);
}

PlainOutput::int_type PlainOutput::overflow(int_type character) {
  line_ += traits_type::to_char_type(character);
  return line_.back() != '\n' || writeLine() ? character : traits_type::eof();
}

int PlainOutput::sync() { return writeLine() && target_->pubsync() == 0 ? 0 : -1; }

bool PlainOutput::writeLine() {
  const bool ended = line_.ends_with('\n');
  if (ended) line_.pop_back();
  if (lines_ == Lines::kMessages && !line_.empty())
    sessions::logEvent(sessions::LogLevel::kError, [this] { return line_; });
  const std::string plain = sessions::plainText(line_) + (ended ? "\n" : "");
  line_.clear();
  return target_->sputn(plain.data(), std::ssize(plain)) == std::ssize(plain);
}

}  // namespace boresight::app
