// SPDX-License-Identifier: Apache-2.0
// Before the loops, which use it where it is there. The compiler's own macro would not do: it is
// also set where a whole build is for such a machine.
#define BORESIGHT_AVX512_KERNELS
#include <immintrin.h>

#include "core/match/column_kernels_impl.h"

namespace boresight {

extern const ColumnKernels kAvx512ColumnKernels;
constinit const ColumnKernels kAvx512ColumnKernels = kernels::kColumnKernels<kernels::Word8>;

}  // namespace boresight
