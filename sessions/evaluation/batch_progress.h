// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace boresight::sessions {

/// "12 s", "4 min", "2 h 05 min", "3 days 4 h": rounded as one reads a wait.
std::string durationText(double seconds);

/// How far a batch is: "12 of 40 runs, 11 completed, 720 an hour, 2 min left". Rate and time left
/// follow from what was done since `began`, and are left out before the first run.
std::string batchProgressText(std::size_t done, std::size_t total, std::size_t completed,
                              double seconds_since_began);

}  // namespace boresight::sessions
