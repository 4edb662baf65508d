// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/text_table.h"

#include <gtest/gtest.h>

#include <limits>

namespace boresight::sessions {
namespace {

TEST(TextTable, AlignsItsColumns) {
  TextTable table({"name", "mm"});
  table.add({"a", "10.25"});
  table.add({"longer", "1"});
  EXPECT_EQ(table.text(),
            "name       mm\n"
            "-------------\n"
            "a       10.25\n"
            "longer      1\n");
}

TEST(TextTable, LeavesMissingCellsEmpty) {
  TextTable table({"a", "b", "c"});
  table.add({"1"});
  EXPECT_EQ(table.text(), "a  b  c\n-------\n1\n");
}

TEST(FixedText, RoundsAndMarksWhatIsNotFinite) {
  EXPECT_EQ(fixedText(1.2345, 2), "1.23");
  EXPECT_EQ(fixedText(-0.5, 1), "-0.5");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::quiet_NaN(), 2), "-");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::infinity(), 2), "-");
}

}  // namespace
}  // namespace boresight::sessions
