// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_file.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/sessions/annotation/random_marks.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;

TEST(MarksFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  Random random(2);
  const Marks marks = test::randomMarks(random, 20, 12);
  writeMarks(folder / "points.json", marks);
  EXPECT_EQ(readMarks(folder / "points.json"), marks);
  writeMarks(folder / "points.csv", marks);
  EXPECT_EQ(readMarks(folder / "points.csv"), marks);
  EXPECT_EQ(folder.read("points.csv").substr(0, 8), "kind,id,");
  writeMarks(folder / "none.json", {});
  EXPECT_TRUE(readMarks(folder / "none.json").empty());
}

TEST(MarksFile, FillsInWhatMayBeLeftOut) {
  const TemporaryFolder folder;
  const Marks marks = readMarks(folder.write("points.json", R"({"format": "boresight-points",
      "version": 1, "points": [{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, 5]},
      {"id": "b"}]})"));
  ASSERT_EQ(marks.points.size(), 2u);
  EXPECT_EQ(marks.points[0].sigma_px, 1.0);
  EXPECT_TRUE(marks.points[0].enabled && marks.points[0].complete());
  EXPECT_FALSE(marks.points[0].locked || marks.points[1].complete());
  EXPECT_TRUE(marks.lines.empty());
}

TEST(MarksFile, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error = [&folder](const std::string& points, const std::string& lines = "[]") {
    return folder.message([&] {
      (void)readMarks(folder.write("points.json", R"({"format": "boresight-points", "version": 1,
          "points": )" + points + ", \"lines\": " + lines +
                                                      "}"));
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
  EXPECT_EQ(error(R"([{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, Infinity]}])"),
            "points.json: points[0].pixel[1]: not a finite number");
  EXPECT_EQ(error(R"([{"id": "a", "sigma_px": 0, )" + good + "}]"),
            "points.json: points[0].sigma_px: 0 is outside 1e-06 .. 10000");
  EXPECT_EQ(error(R"([{"id": "a", "pixle": [4, 5]}])"),
            "points.json: points[0].pixle: is not known to this version of the format; did you mean "
            "\"pixel\"?");
  EXPECT_EQ(error("[]", R"([{"id": "l", "line_px": [[1, 1], [1, 1]]}])"),
            "points.json: lines[0].line_px: both ends are the same place");
}

}  // namespace
}  // namespace boresight::sessions
