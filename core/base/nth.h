// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace boresight {

/// Element `index` of an array, span or list; the index may be signed, or an enumerator.
template <class Items, class Index>
constexpr decltype(auto) nth(Items&& items, Index index) {
  return items[static_cast<std::size_t>(index)];
}

}  // namespace boresight
