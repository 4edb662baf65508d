// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace boresight::test {

/// Whether long walks are gone through whole: with BORESIGHT_ALL set, as by tests/run.sh --all.
inline bool allCases() { return std::getenv("BORESIGHT_ALL") != nullptr; }

}  // namespace boresight::test
