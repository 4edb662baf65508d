// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

namespace boresight {

const char* kernelsName(Kernels kernels) {
  switch (kernels) {
    case Kernels::kPortable:
      return "portable";
    case Kernels::kSse2:
      return "sse2";
  }
  return "unknown";
}

bool kernelsAvailable(Kernels kernels) {
#if defined(__GNUC__) && defined(__SSE2__)
  if (kernels == Kernels::kSse2) return true;
#endif
  return kernels == Kernels::kPortable;
}

Kernels bestKernels() {
  return kernelsAvailable(Kernels::kSse2) ? Kernels::kSse2 : Kernels::kPortable;
}

}  // namespace boresight
