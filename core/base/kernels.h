// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// Instructions of the processor that the inner loops may use. The caller of a Localizer chooses;
/// the choice is neither an option nor part of the digest, as both sets give the same bits.
enum class Kernels : std::uint8_t {
  kPortable = 0,  ///< 64-bit integers: any machine
  kSse2,          ///< 128-bit registers
};
inline constexpr int kKernelSets = 2;

/// "portable", "sse2".
const char* kernelsName(Kernels kernels);
/// Whether this build has the set.
bool kernelsAvailable(Kernels kernels);
/// The last available set.
Kernels bestKernels();

}  // namespace boresight
