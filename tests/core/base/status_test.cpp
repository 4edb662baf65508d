// SPDX-License-Identifier: Apache-2.0
#include "core/base/status.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(StatusText, IsDifferentForEveryStatus) {
  std::set<std::string> texts;
  int count = 0;
  for (; statusText(static_cast<Status>(count)) != std::string("unknown"); ++count)
    texts.insert(statusText(static_cast<Status>(count)));
  EXPECT_EQ(count, static_cast<int>(kLastStatus) + 1);
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(count));
  EXPECT_STREQ(statusText(static_cast<Status>(200)), "unknown") << "of a corrupt file";
}

}  // namespace
}  // namespace boresight
