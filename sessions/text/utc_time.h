// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace boresight::sessions {

/// "2026-01-31T23:59:59Z", now.
std::string utcNowText();

}  // namespace boresight::sessions
