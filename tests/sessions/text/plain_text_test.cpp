// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/plain_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <string>

#include "sessions/io/files/errors.h"
#include "tests/support/comma_locale.h"

namespace boresight::sessions {
namespace {

/// Text in place of whose other characters blanks are shown.
TEST(PlainText, HasBlanksForWhatIsNotShown) {
  const struct {
    std::string text;
    const char *shown, *reason;
  } cases[] = {{"a\x1b[31mb\nc\td\re\x7f", "a [31mb c d e ", "control characters"},
               {{"a\0b", 3}, "a b", "zero"},
               {"a\xc2\x80z \xc2\x9b"
                "31m \xc2\x9f.",
                "a z  31m  .", "U+0080, U+009B and U+009F"},
               {"\xc2\xa0", "\xc2\xa0", "U+00A0 is the first behind them"},
               {"a\xe2\x80\xae"
                "b\xe2\x81\xa6"
                "c\xe2\x80\x8f"
                "d\xd8\x9c"
                "e",
                "a b c d e", "marks of direction: U+202E, U+2066, U+200F, U+061C"},
               {"a\xe2\x80\xa8"
                "b\xe2\x80\xa9"
                "c",
                "a b c", "separators: U+2028, U+2029"},
               {"a\x9b"
                "31m",
                "a 31m", "a control sequence of a terminal of eight bits"},
               {"\xc0\x9b.", "  .", "overlong"},
               {"\xe0\x82\x9b.", "   .", "overlong"},
               {"\xe2\x80", "  ", "cut"},
               {"\xff\xfe", "  ", "no UTF-8"}};
  for (const auto& each : cases) EXPECT_EQ(plainText(each.text), each.shown) << each.reason;
  const std::string text = "Sol 12, \xc3\xa9\xc4\x9b \xe2\x82\xac \xf0\x9f\x9b\xb0  50 %";
  for (const std::string& shown : {text, std::string()}) EXPECT_EQ(plainText(shown), shown);
}

TEST(OneLine, MergesBlanks) {
  EXPECT_EQ(oneLine("\n a \x1b\x1b b\r\n"), "a b");
  EXPECT_EQ(oneLine(" \n"), "");
  EXPECT_STREQ(InputError("a\n.json", "id",
                          "'\xc2\x9b"
                          "2J' is \x1b[1m bad")
                   .what(),
               "a .json: id: ' 2J' is [1m bad");
}

TEST(FormatText, InALocaleWithDecimalComma_HasAPoint) {
  const test::CommaLocale locale;
  if (!locale.active()) GTEST_SKIP() << "localedef cannot build de_DE.UTF-8 here";
  EXPECT_EQ(formatText("%.2f mm of %d", 1234.5, 10000), "1234.50 mm of 10000");
  EXPECT_EQ(threeDigits(0.0212), "0.0212");
  EXPECT_STREQ(std::localeconv()->decimal_point, ",") << "the caller's locale is restored";
}

TEST(FormatText, LongText_IsWhole) {
  const std::string name(5000, 'n');
  EXPECT_EQ(formatText("<%s>", name.c_str()), "<" + name + ">");
  EXPECT_EQ(formatText("%s", ""), "");
}

}  // namespace
}  // namespace boresight::sessions
