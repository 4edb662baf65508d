// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/text_reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/comma_locale.h"

namespace boresight::sessions {
namespace {

using namespace std::string_view_literals;  // NOLINT: texts with zero bytes

TEST(RealIn, NumbersAsProgramsWriteThem_AreRead) {
  const test::CommaLocale locale;
  const std::pair<const char*, double> numbers[] = {
      {"1", 1.0},       {"+1.5", 1.5},     {"-.5", -0.5},    {".5", 0.5},
      {"5.", 5.0},      {"-5.E+00", -5.0}, {"+.5e-1", 0.05}, {"1.5D+02", 150.0},
      {"-1d-2", -0.01}, {"007.50", 7.5},   {"1e-400", 0.0},  {"0.1", 0.1}};
  for (const auto& [text, value] : numbers) EXPECT_EQ(realIn(text), value) << text;
  EXPECT_EQ(realIn("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(realIn("1D400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(realIn(std::string(400, '9')), std::numeric_limits<double>::infinity());
  EXPECT_EQ(realIn("0." + std::string(400, '0') + "1"), 0.0);
}

TEST(RealIn, OtherTexts_AreEmptyWithTheReason) {
  const std::pair<const char*, const char*> texts[] = {
      {"", "'' is not a number"},
      {"+-1", "'+-1' is not a number"},
      {".", "'.' is not a number"},
      {"1.5.2", "'1.5.2' is not a number"},
      {"0x10", "'0x10' is not a number"},
      {"1 2", "'1 2' is not a number"},
      {"1,5", "'1,5' is not a number: write a decimal point"},
      {"1,2,3", "'1,2,3' is not a number"},
      {"nan", "'nan' is not a finite number"},
      {"-NaN(ind)", "'-NaN(ind)' is not a finite number"},
      {"+inf", "'+inf' is not a finite number"},
      {"-1.#IND", "'-1.#IND' is not a finite number"},
      {"1.#QNAN0", "'1.#QNAN0' is not a finite number"},
      {"\xe2\x88\x92"
       "5",
       "'\xe2\x88\x92"
       "5' is not a number: write its digits, sign and the "
       "blanks around it in ASCII"},
      {"1\xc2\xa0"
       "234",
       "'1\xc2\xa0"
       "234' is not a number: write its digits, sign and the "
       "blanks around it in ASCII"}};
  for (const auto& [text, reason] : texts) {
    EXPECT_FALSE(realIn(text)) << text;
    EXPECT_EQ(noNumberText(text), reason);
  }
  EXPECT_EQ(wholeIn<int>("+7"), 7);
  EXPECT_FALSE(wholeIn<int>("+-7"));
}

TEST(TextLines, LinesOfEverySystem_AreEqual) {
  const std::vector<std::string> lines = {"a", "", "b c", "d"};
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const bool last_end : {true, false}) {
      std::string text;
      for (const std::string& line : lines) text += line + end;
      if (!last_end) text.resize(text.size() - end.size());
      EXPECT_EQ(endsItsLine(text), last_end);
      EXPECT_EQ(lineAt(text, text.find('d')), 4);
      TextLines read(text);
      for (const std::string& line : lines) {
        ASSERT_TRUE(read.next());
        EXPECT_EQ(read.line(), line);
      }
      EXPECT_TRUE(read.isLast());
      EXPECT_EQ(read.number(), 4);
      EXPECT_FALSE(read.next());
    }
}

TEST(WithoutPadding, ZerosAndEndMarksBehindTheText_AreLeftOut) {
  for (const std::string_view padding : {""sv, "\x1a"sv, "\x1a\r\n"sv, "\0\0\0"sv, "\x1a\x1a\0"sv})
    EXPECT_EQ(withoutPadding("a\n" + std::string(padding)), "a\n");
  EXPECT_EQ(withoutPadding("a\0b \n"sv), "a\0b \n"sv) << "zeros in the text stay";
  EXPECT_EQ(withoutPadding("\0\0"sv), "");
}

TEST(TakeWord, Words_AreSeparatedByBlanksAndTabs) {
  std::string_view rest = "\t a \tb\v\fc\r";
  for (const char* word : {"a", "b", "c", "", ""}) EXPECT_EQ(takeWord(rest), word);
}

}  // namespace
}  // namespace boresight::sessions
