// SPDX-License-Identifier: Apache-2.0
#include "core/match/column_kernels_impl.h"

namespace boresight {

extern const ColumnKernels kAvx2ColumnKernels;
constinit const ColumnKernels kAvx2ColumnKernels = kernels::kColumnKernels<kernels::Word4>;

}  // namespace boresight
