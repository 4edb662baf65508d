// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include "core/base/enum_name.h"

namespace boresight {

const char* kernelsName(Kernels kernels) {
  return enumName<Kernels::kSse2>(kernels, {"portable", "sse2"});
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
