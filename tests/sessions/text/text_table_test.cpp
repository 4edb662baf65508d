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
  TextTable short_row({"a", "b", "c"});
  short_row.add({"1"});
  EXPECT_EQ(short_row.text(), "a  b  c\n-------\n1\n");
}

TEST(FixedText, RoundsAndMarksNonFiniteNumbers) {
  EXPECT_EQ(fixedText(1.2345, 2), "1.23");
  EXPECT_EQ(fixedText(-0.5, 1), "-0.5");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::quiet_NaN(), 2), "-");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(CsvField, IsQuotedAndIsTextWhereASpreadsheetWouldTakeItForAFormula) {
  for (const auto& [text, field] :
       {std::pair("plain text", "plain text"),
        {"a,b", "\"a,b\""},
        {"say \"no\"", "\"say \"\"no\"\"\""},
        {"a\nb", "\"a\nb\""},
        {"", ""},
        {"=HYPERLINK(\"http://x\")", "\"'=HYPERLINK(\"\"http://x\"\")\""},
        {"+1+2", "'+1+2"},
        {"-cmd", "'-cmd"},
        {"@SUM(A1)", "'@SUM(A1)"},
        {"\t=1", "'\t=1"},
        {"\r=1", "\"'\r=1\""},
        {"-", "'-"}})
    EXPECT_EQ(csvField(text), field);
  for (const char* number : {"-1.5", "+2", "-3e-07", "0", "1.25"})
    EXPECT_EQ(csvField(number), number);
  for (const char* text : {"=1+1", "'=1+1", "''@x", "'quoted'", "-1.5", "'-1.5", "-x", "", "'",
                           "plain", "\t", "+", "''"})
    EXPECT_EQ(textOfCsvField(csvField(text)), text) << "read back";
}

}  // namespace
}  // namespace boresight::sessions
