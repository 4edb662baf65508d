// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace boresight {

/// The name of an enumerator: `names` are those of the values 0 ... kLast, in order. "unknown" for
/// other values, as of a corrupt file.
template <auto kLast, std::size_t kCount>
constexpr const char* enumName(decltype(kLast) value, const char* const (&names)[kCount]) {
  static_assert(kCount == static_cast<std::size_t>(kLast) + 1);
  const auto index = static_cast<std::size_t>(value);
  return index < kCount ? names[index] : "unknown";
}

}  // namespace boresight
