// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

namespace boresight {

const char* kernelsName(Kernels kernels) {
  switch (kernels) {
    case Kernels::kPortable:
      return "portable";
    case Kernels::kSse2:
      return "sse2";
    case Kernels::kAvx2:
      return "avx2";
    case Kernels::kAvx512:
      return "avx512";
  }
  return "unknown";
}

bool kernelsAvailable(Kernels kernels) {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  switch (kernels) {
    case Kernels::kPortable:
    case Kernels::kSse2:
      return true;
    case Kernels::kAvx2:
      return __builtin_cpu_supports("avx2");
    case Kernels::kAvx512:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("avx512f") &&
             __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512vbmi2") && __builtin_cpu_supports("avx512vpopcntdq");
  }
  return false;
#else
  return kernels == Kernels::kPortable;
#endif
}

Kernels bestKernels() {
  for (int k = kKernelSets - 1; k > 0; --k) {
    if (kernelsAvailable(static_cast<Kernels>(k))) return static_cast<Kernels>(k);
  }
  return Kernels::kPortable;
}

}  // namespace boresight
