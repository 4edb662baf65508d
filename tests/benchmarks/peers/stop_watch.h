// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace boresight::peers {

/// Wall time in pieces.
class StopWatch {
 public:
  /// Seconds since it was made or last asked.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - began_;
    began_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace boresight::peers
