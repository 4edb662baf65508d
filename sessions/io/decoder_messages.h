// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace boresight::sessions {

/// While it lives, what this thread writes to standard error goes to a text instead: OpenCV and the
/// decoders below it (libpng, libjpeg, libtiff) print what they meet, and cannot be told not to.
/// Other threads print as ever.
class DecoderMessages {
 public:
  /// `text` gets at most 1000 characters, and must outlive this.
  explicit DecoderMessages(std::string& text);
  DecoderMessages(const DecoderMessages&) = delete;
  DecoderMessages& operator=(const DecoderMessages&) = delete;
  ~DecoderMessages();

 private:
  std::string* before_;
};

}  // namespace boresight::sessions
