// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace boresight::sessions {

/// Samples within `tolerance` of `value` stand for no measurement.
struct InvalidValue {
  double value = 0.0;
  double tolerance = 0.0;
};

/// Adds the constant that a label states, or each of a list: a number, or the bits of one as
/// 16#FF7FFFFB#, 0xFF7FFFFB or 2#...#. Up to 32 bits of a floating-point number are those of a
/// 32-bit one; whole numbers may be of either sign. From 10^30 on, where no measurement lies, a
/// number is one of its written digits (-3.402823e+38 for the lowest of 32 bits); smaller ones are
/// exact. At most 32.
void addInvalidValues(const nlohmann::json* stated, bool floating, int sample_bits,
                      std::vector<InvalidValue>& values);

}  // namespace boresight::sessions
