// SPDX-License-Identifier: Apache-2.0
#include "ui/models/number_text.h"

#include <limits>

#include <gtest/gtest.h>

namespace boresight::ui {
namespace {

TEST(NumberText, RoundsUpToOneTwoOrFiveTimesAPowerOfTen) {
  const double pairs[][2] = {{0.0011, 0.002}, {0.03, 0.05}, {0.3, 0.5}, {1.0, 1.0},  {1.1, 2.0},
                             {2.0, 2.0},      {2.1, 5.0},   {5.0, 5.0}, {6.0, 10.0}, {700.0, 1e3}};
  for (const auto& [value, rounded] : pairs) EXPECT_DOUBLE_EQ(roundedUp(value), rounded) << value;
  EXPECT_DOUBLE_EQ(roundedUp(0.1 + 0.1 + 0.1 - 0.1), 0.2) << "a last bit is no reason to round up";
  for (const double none : {0.0, -3.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(roundedUp(none), 1.0);
}

}  // namespace
}  // namespace boresight::ui
