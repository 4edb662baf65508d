// SPDX-License-Identifier: Apache-2.0
#include "core/base/options.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace boresight {
namespace {

struct SampleOptions {
  double sigma_px = 1.0;
  std::int32_t count = 5;
  bool on = true;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"sample.sigma_px", "px", 0.5, 2.0, "Smoothing."}, self.sigma_px);
    visit(OptionInfo{"sample.count", "", 1, 10, "How many."}, self.count);
    visit(OptionInfo{"sample.on", "", 0, 1, "Whether at all."}, self.on);
  }
};

TEST(FirstInvalidOption, AcceptsDefaultsAndBothEndsOfARange) {
  SampleOptions options;
  EXPECT_EQ(firstInvalidOption(options), nullptr);
  for (const double end : {0.5, 2.0}) {
    options.sigma_px = end;
    EXPECT_EQ(firstInvalidOption(options), nullptr);
  }
}

TEST(FirstInvalidOption, NamesTheFirstFieldOutsideItsRange) {
  SampleOptions options;
  options.count = 11;
  EXPECT_EQ(std::string(firstInvalidOption(options)), "sample.count");
  for (const double bad : {0.4, 2.1, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    options.sigma_px = bad;
    EXPECT_EQ(std::string(firstInvalidOption(options)), "sample.sigma_px") << bad;
  }
}

TEST(FirstInvalidOption, LooksAtConstantOptionsToo) {
  const SampleOptions options;
  EXPECT_EQ(firstInvalidOption(options), nullptr);
}

}  // namespace
}  // namespace boresight
