// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_file.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/sessions/annotation/random_annotations.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;

TEST(AnnotationsFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  Random random(2);
  const Annotations annotations = test::randomAnnotations(random, 20, 12);
  for (const char* name : {"points.json", "points.csv"}) {
    writeAnnotations(folder / name, annotations);
    EXPECT_EQ(readAnnotations(folder / name), annotations) << name;
  }
  EXPECT_EQ(folder.read("points.csv").substr(0, 8), "kind,id,");
  writeAnnotations(folder / "none.json", {});
  EXPECT_TRUE(readAnnotations(folder / "none.json").empty());
}

TEST(AnnotationsFile, OptionalMembers_HaveDefaults) {
  const TemporaryFolder folder;
  Annotations expected;
  expected.points = {{"a", Eigen::Vector3d(1, 2, 3), Eigen::Vector2d(4, 5), 1.0, true, false, ""},
                     {"b", {}, {}, 1.0, true, false, ""}};
  EXPECT_EQ(readAnnotations(folder.write("points.json", R"({"format": "boresight-points",
      "version": 1, "points": [{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, 5]},
      {"id": "b"}]})")),
            expected);
}

TEST(AnnotationsFile, InvalidFile_IsReportedWithTheMember) {
  const TemporaryFolder folder;
  const std::string good = R"("point_in_station_m": [1, 2, 3], "pixel": [4, 5])";
  const std::string a = R"({"id": "a", )" + good + "}";
  const struct {
    std::string points, lines, error;
  } files[] = {{"{}", "[]", "points: not a list (is an object)"},
               {"[{" + good + "}]", "[]", "points[0].id: missing"},
               {"[" + a + ", " + a + "]", "[]", "points[1].id: 'a' is given twice"},
               {"[" + a + "]", R"([{"id": "a"}])", "lines[0].id: 'a' is given twice"},
               {R"([{"id": "a", "point_in_station_m": [1, 2], "pixel": [4, 5]}])", "[]",
                "points[0].point_in_station_m: not a list of 3 (is a list of 2)"},
               {R"([{"id": "a", "sigma_px": 0, )" + good + "}]", "[]",
                "points[0].sigma_px: 0 is outside 1e-06 .. 10000"},
               {"[]", R"([{"id": "l", "line_px": [[1, 1], [1, 1]]}])",
                "lines[0].line_px: both ends coincide"}};
  for (const auto& [points, lines, error] : files) {
    const auto file =
        folder.write("points.json", R"({"format": "boresight-points", "version": 1, "points": )" +
                                        points + ", \"lines\": " + lines + "}");
    EXPECT_EQ(folder.message([&] { (void)readAnnotations(file); }), "points.json: " + error);
  }
}

TEST(AnnotationsCsv, RoundTripIsExact) {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Annotations annotations = test::randomAnnotations(random, trial % 9, trial % 5);
    std::string text = annotationsCsv(annotations);
    EXPECT_EQ(parseAnnotationsCsv("marks.csv", text), annotations) << text;
    std::erase(text, '\r');  // lines may end with a line feed alone
    EXPECT_EQ(parseAnnotationsCsv("marks.csv", text), annotations) << text;
  }
}

/// As spreadsheets write a table: with a byte order mark, or with carriage returns alone.
TEST(AnnotationsCsv, TableOfASpreadsheet_IsRead) {
  const TemporaryFolder folder;
  Random random(12);
  Annotations annotations = test::randomAnnotations(random, 3, 0);
  for (PointPair& point : annotations.points) point.comment.clear();
  std::string text = annotationsCsv(annotations);
  const auto file = folder.write("marks.csv", "\xEF\xBB\xBF" + text);
  EXPECT_EQ(readAnnotations(file), annotations);
  std::erase(text, '\n');
  EXPECT_EQ(parseAnnotationsCsv("marks.csv", text), annotations);
}

TEST(AnnotationsCsv, OtherEncodings_AreNamed) {
  const TemporaryFolder folder;
  Random random(13);
  Annotations annotations = test::randomAnnotations(random, 2, 0);
  annotations.points[1].comment = "caf\xE9";
  const auto file = folder.write("marks.csv", annotationsCsv(annotations));
  EXPECT_THAT(folder.message([&] { (void)readAnnotations(file); }),
              testing::HasSubstr("is not UTF-8 text: save the table as UTF-8"));
  folder.write("marks.csv", std::string_view("\xFF\xFEk\0i\0", 6));
  EXPECT_EQ(folder.message([&] { (void)readAnnotations(file); }),
            "marks.csv: is UTF-16 or UTF-32 text: save it as UTF-8");
}

TEST(AnnotationsCsv, TextThatLooksLikeAFormulaIsTextInASpreadsheetAndComesBack) {
  Random random(14);
  Annotations annotations = test::randomAnnotations(random, 3, 1);
  annotations.points[0].id = "=HYPERLINK(\"http://example.org\")";
  annotations.points[0].comment = "-2+3";
  annotations.points[1].id = "'=1";
  annotations.points[1].comment = "@SUM(A1)";
  annotations.points[2].pixel = Eigen::Vector2d(-1.5, -2.5);
  annotations.lines[0].comment = "\t+1";
  const std::string text = annotationsCsv(annotations);
  for (const char* begin : {",\"'=HYPERLINK", ",'-2+3\r", ",''=1,", ",'@SUM(A1)\r", ",'\t+1\r"})
    EXPECT_NE(text.find(begin), std::string::npos) << begin << "\n" << text;
  EXPECT_NE(text.find(",-1.5,-2.5,"), std::string::npos) << "numbers stay numbers";
  EXPECT_EQ(parseAnnotationsCsv("marks.csv", text), annotations);
}

TEST(AnnotationsCsv, InvalidCsv_IsReportedWithLineAndColumn) {
  const TemporaryFolder folder;
  const std::string a = "point,a,1,2,,,3,4,5,,,,1,1,0,\n";
  for (const auto& [rows, error] :
       {std::pair<std::string, std::string>(a + "plane,b,1,2,,,3,4,5,,,,1,1,0,\n",
                                            "line 3, kind: must be point or line"),
        {"point,a,1,two,,,3,4,5,,,,1,1,0,\n", "line 2, y1_px: 'two' is not a number"},
        {"point,a,1,2,,,3,4,5,,,,0,1,0,\n", "line 2, sigma_px: is outside 1e-06 .. 10000"},
        {"point,a,1,2,,,3,4,5,,,,1,yes,0,\n", "line 2, enabled: must be 0 or 1"},
        {"point,a,1,2\n", "line 2: has 4 fields, needs 16"},
        {a + a, "line 3, id: 'a' is given twice"},
        {"point,a,1,2,,,3,4,5,,,,1,1,0,\"open\n", "line 2: closing quote is missing"},
        {"line,a,1,2,1,2,3,4,5,6,7,8,1,1,0,\n",
         "line 2, x1_px: a line needs two pixels, or none"}}) {
    const std::string text = annotationsCsv({}) + rows;
    EXPECT_EQ(folder.message([&] { (void)parseAnnotationsCsv("marks.csv", text); }),
              "marks.csv: " + error);
  }
  EXPECT_THROW((void)parseAnnotationsCsv("marks.csv", ""), std::exception);
}

/// Spreadsheets write empty rows behind the last one, editors empty lines.
TEST(AnnotationsCsv, EmptyRows_AreLeftOut) {
  Random random(15);
  const Annotations annotations = test::randomAnnotations(random, 3, 2);
  const std::string text = annotationsCsv(annotations), empty(15, ',');
  for (const std::string& rows : {std::string("\r\n"), std::string("\n\n\n"), std::string("\r\r"),
                                  empty + "\r\n", empty, "\n" + empty + "\n"})
    EXPECT_EQ(parseAnnotationsCsv("marks.csv", text + rows), annotations) << rows;
  EXPECT_EQ(parseAnnotationsCsv("marks.csv", text.substr(0, text.size() - 2)), annotations)
      << "RFC 4180 lets the last row have no line end";
}

TEST(AnnotationsCsv, TablesAndNumbersOfOtherCountries_AreNamed) {
  const TemporaryFolder folder;
  const auto message = [&](std::string text, char separator) {
    std::ranges::replace(text, ',', separator);
    return folder.message([&] { (void)parseAnnotationsCsv("marks.csv", text); });
  };
  const std::string row = "point,a,1,2,,,3,4,5,,,,1,1,0,\n";
  for (const char separator : {';', '\t'})
    EXPECT_EQ(message(annotationsCsv({}) + row, separator),
              "marks.csv: line 1: is not the header of an annotation table (kind,id,x1_px,...): "
              "save it with commas between fields and points in numbers");
  EXPECT_EQ(message(annotationsCsv({}) + "point,a,\"1,5\",2,,,3,4,5,,,,1,1,0,\n", ','),
            "marks.csv: line 2, x1_px: '1,5' is not a number: write a decimal point");
  EXPECT_EQ(message(annotationsCsv({}) + "point,a,+1.,.2,,,3E0,4,5,,,,1,1,0,\n", ','), "(nothing)");
}

TEST(AnnotationsCsv, NoDamageCrashes) {
  Random random(13);
  const std::string text = annotationsCsv(test::randomAnnotations(random, 6, 3));
  for (int trial = 0; trial < 3000; ++trial) {
    std::string damaged = text.substr(0, random.below(static_cast<std::uint32_t>(text.size())));
    for (std::uint32_t i = random.below(4); i > 0 && !damaged.empty(); --i)
      damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<char>(random.below(256));
    try {
      (void)parseAnnotationsCsv("marks.csv", damaged);
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace boresight::sessions
