// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::test {

/// How long a test waits for work in the background before it fails: much longer than it takes.
inline constexpr int kPatienceMs = 120'000;

}  // namespace boresight::test
