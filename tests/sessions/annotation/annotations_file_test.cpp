// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_file.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/sessions/annotation/random_annotations.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;

TEST(AnnotationsFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  Random random(2);
  const Annotations annotations = test::randomAnnotations(random, 20, 12);
  writeAnnotations(folder / "points.json", annotations);
  EXPECT_EQ(readAnnotations(folder / "points.json"), annotations);
  writeAnnotations(folder / "points.csv", annotations);
  EXPECT_EQ(readAnnotations(folder / "points.csv"), annotations);
  EXPECT_EQ(folder.read("points.csv").substr(0, 8), "kind,id,");
  writeAnnotations(folder / "none.json", {});
  EXPECT_TRUE(readAnnotations(folder / "none.json").empty());
}

TEST(AnnotationsFile, OptionalMembers_HaveDefaults) {
  const TemporaryFolder folder;
  const Annotations annotations =
      readAnnotations(folder.write("points.json", R"({"format": "boresight-points",
      "version": 1, "points": [{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, 5]},
      {"id": "b"}]})"));
  ASSERT_EQ(annotations.points.size(), 2u);
  EXPECT_EQ(annotations.points[0].sigma_px, 1.0);
  EXPECT_TRUE(annotations.points[0].enabled && annotations.points[0].complete());
  EXPECT_FALSE(annotations.points[0].locked || annotations.points[1].complete());
  EXPECT_TRUE(annotations.lines.empty());
}

TEST(AnnotationsFile, InvalidFile_IsReportedWithTheMember) {
  const TemporaryFolder folder;
  const auto error = [&folder](const std::string& points, const std::string& lines = "[]") {
    return folder.message([&] {
      (void)readAnnotations(
          folder.write("points.json", R"({"format": "boresight-points", "version": 1,
          "points": )" + points +
                                          ", \"lines\": " + lines + "}"));
    });
  };
  const std::string good = R"("point_in_station_m": [1, 2, 3], "pixel": [4, 5])";
  EXPECT_EQ(error("{}"), "points.json: points: not a list (is an object)");
  EXPECT_EQ(error("[{" + good + "}]"), "points.json: points[0].id: missing");
  EXPECT_EQ(error(R"([{"id": "a", )" + good + R"(}, {"id": "a", )" + good + "}]"),
            "points.json: points[1].id: 'a' is given twice");
  EXPECT_EQ(error(R"([{"id": "a", )" + good + "}]", R"([{"id": "a"}])"),
            "points.json: lines[0].id: 'a' is given twice");
  EXPECT_EQ(error(R"([{"id": "a", "point_in_station_m": [1, 2], "pixel": [4, 5]}])"),
            "points.json: points[0].point_in_station_m: not a list of 3 (is a list of 2)");
  EXPECT_EQ(error(R"([{"id": "a", "sigma_px": 0, )" + good + "}]"),
            "points.json: points[0].sigma_px: 0 is outside 1e-06 .. 10000");
  EXPECT_EQ(error("[]", R"([{"id": "l", "line_px": [[1, 1], [1, 1]]}])"),
            "points.json: lines[0].line_px: both ends coincide");
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
  const test::TemporaryFolder folder;
  const auto error = [&folder](const std::string& rows) {
    return folder.message(
        [&] { (void)parseAnnotationsCsv("marks.csv", annotationsCsv({}) + rows); });
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
            "marks.csv: line 2: closing quote is missing");
  EXPECT_EQ(error("line,a,1,2,1,2,3,4,5,6,7,8,1,1,0,\n"),
            "marks.csv: line 2, x1_px: a line needs two pixels, or none");
  EXPECT_THROW((void)parseAnnotationsCsv("marks.csv", ""), std::exception);
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
