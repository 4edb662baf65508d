// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace boresight::peers {

/// Processor time of this process in pieces: what others do on the machine does not count.
class StopWatch {
 public:
  /// Seconds since it was made or last asked.
  double lap() {
    const double now_s = processor_s();
    const double passed_s = now_s - began_s_;
    began_s_ = now_s;
    return passed_s;
  }

 private:
  static double processor_s() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double began_s_ = processor_s();
};

}  // namespace boresight::peers
