// SPDX-License-Identifier: Apache-2.0
// How the checks of this folder are put together.
#pragma once

#include <string>

#include "sessions/session/check.h"

namespace boresight::sessions {

/// What a check is of: its id and its name for people.
struct CheckName {
  const char* id;
  const char* title;
};

/// A figure against its limit. `found` is a sentence that says what was found, `remedy` one that
/// follows it when the check fails. A figure that is not finite fails and is not given.
Check measuredCheck(const CheckName& name, const std::string& unit, double figure, double limit,
                    LimitSide side, const std::string& found, const std::string& remedy);

/// A check without a figure.
Check statedCheck(const CheckName& name, bool passed, const std::string& found,
                  const std::string& remedy);

/// A check that cannot be asked; `why` is a sentence.
Check notAskedCheck(const CheckName& name, const std::string& why);

/// A share (0 to 1) for a sentence: "46 %".
std::string percentText(double share);

/// A number for a sentence: three significant digits, no exponent where it can be avoided.
std::string sentenceNumber(double value);

}  // namespace boresight::sessions
