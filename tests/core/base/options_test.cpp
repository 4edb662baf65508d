// SPDX-License-Identifier: Apache-2.0
#include "core/base/options.h"

#include <gtest/gtest.h>

#include "tests/support/not_finite.h"

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
  const SampleOptions defaults;
  EXPECT_EQ(firstInvalidOption(defaults), nullptr);
  SampleOptions options;
  for (const double end : {0.5, 2.0}) {
    options.sigma_px = end;
    EXPECT_EQ(firstInvalidOption(options), nullptr);
  }
}

TEST(FirstInvalidOption, NamesTheFirstFieldOutsideItsRange) {
  SampleOptions options;
  options.count = 11;
  EXPECT_STREQ(firstInvalidOption(options), "sample.count");
  for (const double bad : {0.4, 2.1, test::kNan, test::kInfinity}) {
    options.sigma_px = bad;
    EXPECT_STREQ(firstInvalidOption(options), "sample.sigma_px") << bad;
  }
}

}  // namespace
}  // namespace boresight
