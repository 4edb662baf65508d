// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/batch_progress.h"

#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

TEST(DurationText, ReadsAsAWait) {
  EXPECT_EQ(durationText(0.4), "0 s");
  EXPECT_EQ(durationText(59.0), "59 s");
  EXPECT_EQ(durationText(59.7), "1 min");
  EXPECT_EQ(durationText(150.0), "3 min");
  EXPECT_EQ(durationText(3600.0), "1 h 00 min");
  EXPECT_EQ(durationText(2 * 3600.0 + 5 * 60.0 + 10.0), "2 h 05 min");
  EXPECT_EQ(durationText(24 * 3600.0), "1 day 0 h");
  EXPECT_EQ(durationText(76 * 3600.0), "3 days 4 h");
  EXPECT_EQ(durationText(-1.0), "?");
}

TEST(BatchProgressText, TellsRateAndTimeLeft) {
  EXPECT_EQ(batchProgressText(0, 40, 0, 3.0), "0 of 40 runs, 0 completed");
  EXPECT_EQ(batchProgressText(12, 40, 11, 60.0),
            "12 of 40 runs, 11 completed, 720 an hour, 2 min left");
  EXPECT_EQ(batchProgressText(40, 40, 38, 200.0), "40 of 40 runs, 38 completed, 720 an hour");
}

}  // namespace
}  // namespace boresight::sessions
