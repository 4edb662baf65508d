// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace boresight::sessions {

inline constexpr double kMillimetres = 1e3;   ///< of a metre
inline constexpr double kMilliradians = 1e3;  ///< of a radian
/// A figure that was not measured.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace boresight::sessions
