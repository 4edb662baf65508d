// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// What the inner loops may use of the processor. Whoever makes a Localizer chooses; it is neither
/// an option nor part of the digest, as every set of kernels gives the same bits. Each set holds
/// the ones before it.
enum class Kernels : std::uint8_t {
  kPortable = 0,  ///< 64-bit integers: any machine
  kSse2,          ///< 128-bit registers
  kAvx2,          ///< 256-bit registers
  kAvx512,        ///< 512-bit registers: F, BW, VL, VBMI2, VPOPCNTDQ
};
inline constexpr int kKernelSets = 4;

/// "portable", "sse2", "avx2", "avx512".
const char* kernelsName(Kernels kernels);
/// True when both this build and the processor (with its operating system) have them.
bool kernelsAvailable(Kernels kernels);
/// The last available set.
Kernels bestKernels();

}  // namespace boresight
