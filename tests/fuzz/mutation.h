// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/random.h"

namespace boresight::test {

using Bytes = std::vector<std::uint8_t>;

/// Some changes, the same for the same generator: bits and bytes, pieces left out, doubled and
/// moved, the end cut off, numbers of a text made strange.
Bytes mutated(Bytes bytes, Random& random);

}  // namespace boresight::test
