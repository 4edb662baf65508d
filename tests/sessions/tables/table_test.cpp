// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/table.h"

#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

Table twoRows() {
  return {
      "some",
      "Some 100 % of a_b",
      {{"name"}, {"error mm", {"mean", "max"}, 2}, {"share %", {}, 1}},
      {{TableCell("a, \"b\""), std::vector<std::optional<double>>{0.125, -1.0}, TableCell(50.0)},
       {TableCell("c_d"), std::vector<std::optional<double>>{std::nullopt, std::nullopt},
        TableCell(std::nullopt)}},
      {"A note."}};
}

TEST(TableText, IsReadByPeopleAndPrograms) {
  EXPECT_EQ(tableText(twoRows(), TableFormat::kText),
            "Some 100 % of a_b\n"
            "name    error mm mean / max  share %\n"
            "------------------------------------\n"
            "a, \"b\"         0.12 / -1.00     50.0\n"
            "c_d                       -        -\n"
            "A note.\n");
  EXPECT_EQ(tableText(twoRows(), TableFormat::kCsv),
            "name,error mm mean,error mm max,share %\r\n"
            "\"a, \"\"b\"\"\",0.125,-1,50\r\n"
            "c_d,,,\r\n");
}

TEST(TableText, IsSetByLatex) {
  EXPECT_THAT(tableText(twoRows(), TableFormat::kLatex),
              AllOf(HasSubstr("\\caption{Some 100 \\% of a\\_b}"),
                    HasSubstr("name & error mm mean / max & share \\% \\\\"),
                    HasSubstr("c\\_d & - & - \\\\"), HasSubstr("{lrr}")));
}

}  // namespace
}  // namespace boresight::sessions
