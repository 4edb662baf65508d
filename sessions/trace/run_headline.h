// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// How a run ended, for one line: a word or two, and a sentence with the values measured and
/// needed.
struct RunHeadline {
  std::string head;
  std::string sentence;
};
RunHeadline runHeadline(const LocalizationTrace& trace);

/// Whether the seed's uncertainty covers a turn by any angle about the view axis.
bool searchedEveryTurn(const LocalizationTrace& trace);

/// Name of an iteration: its attempt and its number in it, "2.3"; "seed" below 0 and beyond the
/// end.
std::string iterationName(const LocalizationTrace& trace, int iteration);

}  // namespace boresight::sessions
