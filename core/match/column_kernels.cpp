// SPDX-License-Identifier: Apache-2.0
#include "core/match/column_kernels.h"

namespace boresight {

#if defined(BORESIGHT_X86_64_KERNELS)
extern const ColumnKernels kAvx2ColumnKernels;
extern const ColumnKernels kAvx512ColumnKernels;
#endif

const ColumnKernels* columnKernels(Kernels kernels) {
#if defined(BORESIGHT_X86_64_KERNELS)
  switch (kernels) {
    case Kernels::kPortable:
    case Kernels::kSse2:
      return nullptr;
    case Kernels::kAvx2:
      return &kAvx2ColumnKernels;
    case Kernels::kAvx512:
      return &kAvx512ColumnKernels;
  }
#else
  (void)kernels;
#endif
  return nullptr;
}

}  // namespace boresight
