// SPDX-License-Identifier: Apache-2.0
#include "ui/review/precision_bars.h"

#include <gtest/gtest.h>

#include <QtWidgets>

namespace boresight::ui {
namespace {

TEST(PrecisionBars, ShowCovariancesThatHaveALimit) {
  sessions::Check limited;
  limited.id = "covariance_lateral";
  limited.unit = "mm";
  limited.state = sessions::CheckState::kPassed;
  limited.figure = 0.37;
  sessions::Check other = limited;
  other.id = "coverage";
  other.limit = 0.4;
  PrecisionBars bars;
  bars.setChecks({limited, other});
  EXPECT_TRUE(bars.isHidden());
  limited.limit = 0.4;
  bars.setChecks({limited, other});
  EXPECT_FALSE(bars.isHidden());
  const auto figures = bars.findChildren<QLabel*>(QStringLiteral("precisionFigure"));
  ASSERT_EQ(figures.size(), 1);
  EXPECT_EQ(figures.front()->text(), QStringLiteral("0.37 of 0.40 mm"));
}

}  // namespace
}  // namespace boresight::ui
