// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::test {

/// How often this program has taken memory from the heap so far.
int heapAllocations();

}  // namespace boresight::test
