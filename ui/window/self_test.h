// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

namespace boresight::ui {

/// Tests the installed program on the example that ships, without a display: one line per test,
/// then "N passed, N failed". Returns how many failed.
int runSelfTest(std::ostream& output);

}  // namespace boresight::ui
