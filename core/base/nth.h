// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <ranges>
#include <type_traits>

namespace boresight {

/// Element `index` of an array, a span or a list with `operator[](std::size_t)`. The index may be
/// signed, or an enumerator.
template <class Items, class Index>
requires((std::integral<Index> ||
          std::is_enum_v<Index>)&&(std::is_lvalue_reference_v<Items> ||
                                   std::ranges::borrowed_range<Items>)) constexpr decltype(auto)
    nth(Items&& items, Index index) {
  return items[static_cast<std::size_t>(index)];
}

}  // namespace boresight
