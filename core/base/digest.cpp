// SPDX-License-Identifier: Apache-2.0
#include "core/base/digest.h"

#include <cstddef>

namespace boresight {

std::array<char, 65> hexText(const std::array<std::uint8_t, 32>& digest) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::array<char, 65> text{};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    text[2 * i] = kDigits[digest[i] >> 4];
    text[2 * i + 1] = kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace boresight
