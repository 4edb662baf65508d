// SPDX-License-Identifier: Apache-2.0
#include "core/match/column_kernels_impl.h"

namespace boresight {

extern const ColumnKernels kSse2ColumnKernels;
constinit const ColumnKernels kSse2ColumnKernels = kernels::kColumnKernels<kernels::Word2>;

}  // namespace boresight
