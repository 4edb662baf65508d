// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/csv_field.h"

#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csvField("plain text"), "plain text");
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csvField(""), "");
}

TEST(CsvField, IsTextWhereASpreadsheetWouldTakeItForAFormula) {
  EXPECT_EQ(csvField("=HYPERLINK(\"http://x\")"), "\"'=HYPERLINK(\"\"http://x\"\")\"");
  EXPECT_EQ(csvField("+1+2"), "'+1+2");
  EXPECT_EQ(csvField("-cmd"), "'-cmd");
  EXPECT_EQ(csvField("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csvField("\t=1"), "'\t=1");
  EXPECT_EQ(csvField("\r=1"), "\"'\r=1\"");
}

TEST(CsvField, LeavesNumbersAlone) {
  for (const char* number : {"-1.5", "+2", "-3e-07", "0", "1.25", "-"})
    EXPECT_EQ(csvField(number), std::string(number) == "-" ? "'-" : number);
}

TEST(CsvField, IsReadBackAsTheTextThatItWas) {
  for (const char* text : {"=1+1", "'=1+1", "''@x", "'quoted'", "-1.5", "'-1.5", "-x", "", "'",
                           "plain", "\t", "+", "''"})
    EXPECT_EQ(textOfCsvField(csvField(text)), text);
}

}  // namespace
}  // namespace boresight::sessions
