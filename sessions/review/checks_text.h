// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "sessions/session/check.h"

namespace boresight::sessions {

/// A table for people: state, check and figure, below them why one failed or is not applicable, and
/// how many there are of each state. With `all_sentences` every check's sentence follows it.
std::string checksText(std::span<const Check> checks, bool all_sentences = false);

/// "22 passed, 1 failed, 5 not applicable".
std::string checkCountsText(std::span<const Check> checks);

}  // namespace boresight::sessions
