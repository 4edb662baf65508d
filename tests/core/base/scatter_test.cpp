// SPDX-License-Identifier: Apache-2.0
#include "core/base/scatter.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(Scattered, OneItemOfEachStride) {
  for (const std::int32_t stride : {1, 2, 3, 7, 4000})
    for (std::int32_t k = 0; k < 500; ++k) {
      EXPECT_GE(scattered(k, stride), k * stride);
      EXPECT_LT(scattered(k, stride), (k + 1) * stride);
    }
  EXPECT_EQ(scattered(5, 0), 5);
}

TEST(Scattered, PlacesInAStride_AreTakenEqually) {
  constexpr std::int32_t kStride = 6;
  constexpr std::int32_t kItems = 6000;
  std::array<int, kStride> taken{};
  for (std::int32_t k = 0; k < kItems; ++k)
    ++taken[static_cast<std::size_t>(scattered(k, kStride) - k * kStride)];
  for (const int count : taken) EXPECT_NEAR(count, kItems / kStride, 4.0 * std::sqrt(1000.0));
}

}  // namespace
}  // namespace boresight
