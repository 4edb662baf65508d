// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/utc_time.h"

#include <array>
#include <chrono>
#include <ctime>

namespace boresight::sessions {

std::string utcNowText() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace boresight::sessions
