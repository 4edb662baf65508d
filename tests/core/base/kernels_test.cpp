// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(Kernels, HaveNames) {
  std::set<std::string> names;
  for (int k = 0; k < kKernelSets; ++k) names.insert(kernelsName(static_cast<Kernels>(k)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kKernelSets));
  EXPECT_STREQ(kernelsName(static_cast<Kernels>(kKernelSets)), "unknown");
}

TEST(Kernels, AreAvailableUpToTheBest) {
  EXPECT_TRUE(kernelsAvailable(Kernels::kPortable));
  for (int k = 0; k < kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    EXPECT_EQ(kernelsAvailable(kernels), kernels <= bestKernels()) << kernelsName(kernels);
  }
  EXPECT_FALSE(kernelsAvailable(static_cast<Kernels>(kKernelSets)));
  RecordProperty("best", kernelsName(bestKernels()));
}

}  // namespace
}  // namespace boresight
