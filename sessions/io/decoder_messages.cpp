// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/decoder_messages.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <streambuf>
#include <string_view>

#include <opencv2/core/utils/logger.hpp>

namespace boresight::sessions {
namespace {

constexpr std::size_t kMostCharacters = 1000;

thread_local std::string* kept = nullptr;

/// Whether this thread's messages are kept, as these then are.
bool keep(std::string_view message) {
  if (kept == nullptr) return false;
  kept->append(message.substr(0, kMostCharacters - std::min(kept->size(), kMostCharacters)));
  return true;
}

/// std::cerr, but for what is kept.
class ErrorBuffer final : public std::streambuf {
 public:
  explicit ErrorBuffer(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char character = traits_type::to_char_type(c);
    return keep({&character, 1}) ? c : target_->sputc(character);
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    return keep({text, static_cast<std::size_t>(size)}) ? size : target_->sputn(text, size);
  }
  int sync() override { return target_->pubsync(); }

 private:
  std::streambuf* target_;
};

#ifdef __GLIBC__
ssize_t writeError(void*, const char* text, std::size_t size) {
  return keep({text, size}) ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
}

/// In the GNU C library `stderr` is a variable that a program may set.
void replaceStderr() {
  std::FILE* stream = ::fopencookie(nullptr, "w", {nullptr, writeError, nullptr, nullptr});
  if (stream == nullptr) return;
  std::setvbuf(stream, nullptr, _IONBF, 0);
  stderr = stream;
}
#else
void replaceStderr() {}
#endif

void listenOnce() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    static auto* const buffer = new ErrorBuffer(std::cerr.rdbuf());  // until the very end
    std::cerr.rdbuf(buffer);
    replaceStderr();
  });
}

}  // namespace

DecoderMessages::DecoderMessages(std::string& text) : before_(kept) {
  listenOnce();
  kept = &text;
}

DecoderMessages::~DecoderMessages() { kept = before_; }

}  // namespace boresight::sessions
