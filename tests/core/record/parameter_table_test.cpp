// SPDX-License-Identifier: Apache-2.0
#include "core/record/parameter_table.h"

#include <gtest/gtest.h>

#include "tests/core/localizer/random_options.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

std::vector<std::uint8_t> tableOf(const LocalizerOptions& options) {
  std::vector<std::uint8_t> bytes(encodeParameters(options, {}));
  EXPECT_EQ(encodeParameters(options, bytes), bytes.size());
  return bytes;
}

TEST(ParameterTable, ReadsBackAsItWas) {
  Random random = randomFor("ParameterTable.ReadsBack");
  for (int trial = 0; trial < 200; ++trial) {
    const LocalizerOptions options = randomOptions(random);
    LocalizerOptions read;
    EXPECT_EQ(decodeParameters(tableOf(options), read).fault, ProblemFault::kNone);
    EXPECT_TRUE(sameOptions(options, read));
  }
}

TEST(ParameterTable, EveryFlippedBitAndEveryLengthIsRefused) {
  const std::vector<std::uint8_t> good = tableOf(paperProfile());
  const LocalizerOptions before;
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::vector<std::uint8_t> bytes = good;
      bytes[byte] ^= static_cast<std::uint8_t>(1U << bit);
      LocalizerOptions read;
      EXPECT_NE(decodeParameters(bytes, read).fault, ProblemFault::kNone) << byte << ", " << bit;
      EXPECT_TRUE(sameOptions(read, before));
    }
    LocalizerOptions read;
    EXPECT_NE(decodeParameters(std::span(good).first(byte), read).fault, ProblemFault::kNone);
  }
}

TEST(ParameterTable, OptionOutOfRangeIsNamed) {
  LocalizerOptions options;
  options.pnp.max_samples = 0;
  LocalizerOptions read;
  const ProblemCheck check = decodeParameters(tableOf(options), read);
  EXPECT_EQ(check.fault, ProblemFault::kOption);
  EXPECT_STREQ(check.option, "pnp.max_samples");
}

}  // namespace
}  // namespace boresight::test
