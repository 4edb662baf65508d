// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace boresight::app {

/// Whether the display of a Qt platform ("xcb", "wayland", "offscreen", ...) answers, by the
/// environment. Qt itself ends the program by abort() when it does not. True for platforms that
/// need no display, and where the question cannot be asked.
bool displayAnswers(const std::string& platform);

}  // namespace boresight::app
