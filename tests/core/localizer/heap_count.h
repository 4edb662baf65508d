// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::test {

/// How often this program has taken memory from the heap so far: by `new`, or by a call to the
/// malloc family from any code that is linked in (the linker redirects it), Eigen's included.
int heapAllocations();

}  // namespace boresight::test
