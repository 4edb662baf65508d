// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_csv.h"

#include <gtest/gtest.h>

#include "tests/sessions/annotation/random_marks.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

TEST(MarksCsv, RoundTripIsExact) {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Marks marks = test::randomMarks(random, trial % 9, trial % 5);
    const std::string text = marksCsv(marks);
    EXPECT_EQ(parseMarksCsv("marks.csv", text), marks) << text;
  }
}

TEST(MarksCsv, TextThatLooksLikeAFormulaIsTextInASpreadsheetAndComesBack) {
  Random random(14);
  Marks marks = test::randomMarks(random, 3, 1);
  marks.points[0].id = "=HYPERLINK(\"http://example.org\")";
  marks.points[0].comment = "-2+3";
  marks.points[1].id = "'=1";
  marks.points[1].comment = "@SUM(A1)";
  marks.points[2].pixel = Eigen::Vector2d(-1.5, -2.5);
  marks.lines[0].comment = "\t+1";
  const std::string text = marksCsv(marks);
  for (const char* begin : {",\"'=HYPERLINK", ",'-2+3\r", ",''=1,", ",'@SUM(A1)\r", ",'\t+1\r"})
    EXPECT_NE(text.find(begin), std::string::npos) << begin << "\n" << text;
  EXPECT_NE(text.find(",-1.5,-2.5,"), std::string::npos) << "numbers stay numbers";
  EXPECT_EQ(parseMarksCsv("marks.csv", text), marks);
}

TEST(MarksCsv, LinesMayEndWithALineFeedAlone) {
  Random random(12);
  const Marks marks = test::randomMarks(random, 3, 0);
  std::string text = marksCsv(marks);
  std::erase(text, '\r');
  EXPECT_EQ(parseMarksCsv("marks.csv", text), marks);
}

TEST(MarksCsv, NamesLineAndColumnOfWhatIsWrong) {
  const test::TemporaryFolder folder;
  const auto error = [&folder](const std::string& rows) {
    return folder.message([&] { (void)parseMarksCsv("marks.csv", marksCsv({}) + rows); });
  };
  EXPECT_EQ(error("point,a,1,2,,,3,4,5,,,,1,1,0,\nplane,b,1,2,,,3,4,5,,,,1,1,0,\n"),
            "marks.csv: line 3, kind: must be point or line");
  EXPECT_EQ(error("point,a,1,two,,,3,4,5,,,,1,1,0,\n"),
            "marks.csv: line 2, y1_px: 'two' is not a number");
  EXPECT_EQ(error("point,a,1,2,,,3,4,5,,,,0,1,0,\n"),
            "marks.csv: line 2, sigma_px: is outside 1e-06 .. 10000");
  EXPECT_EQ(error("point,a,1,2,,,3,4,5,,,,1,yes,0,\n"),
            "marks.csv: line 2, enabled: must be 0 or 1");
  EXPECT_EQ(error("point,a,1,2\n"), "marks.csv: line 2: has 4 fields, needs 16");
  EXPECT_EQ(error("point,a,1,2,,,3,4,5,,,,1,1,0,\npoint,a,1,2,,,3,4,5,,,,1,1,0,\n"),
            "marks.csv: line 3, id: 'a' is given twice");
  EXPECT_EQ(error("point,a,1,2,,,3,4,5,,,,1,1,0,\"open\n"),
            "marks.csv: line 2: a quote is not closed");
  EXPECT_EQ(error("line,a,1,2,1,2,3,4,5,6,7,8,1,1,0,\n"),
            "marks.csv: line 2, x1_px: a line needs two places in the image, or none");
  EXPECT_THROW((void)parseMarksCsv("marks.csv", ""), std::exception);
}

TEST(MarksCsv, NoDamageCrashes) {
  Random random(13);
  const std::string text = marksCsv(test::randomMarks(random, 6, 3));
  for (int trial = 0; trial < 3000; ++trial) {
    std::string damaged = text.substr(0, random.below(static_cast<std::uint32_t>(text.size())));
    for (std::uint32_t i = random.below(4); i > 0 && !damaged.empty(); --i)
      damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<char>(random.below(256));
    try {
      (void)parseMarksCsv("marks.csv", damaged);
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace boresight::sessions
