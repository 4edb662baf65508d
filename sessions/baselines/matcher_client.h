// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "sessions/baselines/child_process.h"
#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// Corresponding positions in two images, px; score in [0, 1].
struct PixelPair {
  double first_x = 0.0, first_y = 0.0;
  double second_x = 0.0, second_y = 0.0;
  double score = 0.0;
};

/// A matcher in a child process, over the protocol of resources/matchers/README.md. Every failure
/// (no start, crash, timeout, invalid answer) is a MethodError of one sentence; the client cannot
/// be used afterwards.
class MatcherClient {
 public:
  /// Starts the command and waits for its greeting.
  MatcherClient(const std::string& command, double start_timeout_s, const std::stop_token& stop);

  /// Working size that the matcher announced, px; 0: none.
  int width() const { return width_; }
  int height() const { return height_; }
  /// Name that the matcher announced.
  const std::string& name() const { return name_; }

  /// At most `most` pairs, all of them inside the images.
  std::vector<PixelPair> match(const ImageView& first, const ImageView& second, int most,
                               double timeout_s, const std::stop_token& stop);

 private:
  void greet(const std::string& line);
  void send(const ImageView& first, const ImageView& second, int most,
            ChildProcess::Clock::time_point deadline, const std::stop_token& stop);
  std::size_t countIn(const std::string& line, int most) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string command_;
  std::unique_ptr<ChildProcess> process_;
  std::string name_;
  int width_ = 0, height_ = 0;
  int request_ = 0;
};

}  // namespace boresight::sessions
