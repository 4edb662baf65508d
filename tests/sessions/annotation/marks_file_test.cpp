// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_file.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;

PointPair randomPoint(Random& random, int i) {
  PointPair point;
  point.id = "p" + std::to_string(i);
  if (i % 4 != 1)
    point.point_in_station_m = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  if (i % 4 != 2)
    point.pixel = Eigen::Vector2d(random.uniform(-10, 2000), random.uniform(-10, 2000));
  point.sigma_px = random.uniform(0.1, 3.0);
  point.enabled = i % 3 != 0;
  point.locked = i % 5 == 0;
  point.comment = i % 2 == 0 ? "left \"screw\"\n\u00e9" : "";
  return point;
}

LinePair randomLine(Random& random, int i) {
  LinePair line;
  line.id = "l" + std::to_string(i);
  if (i % 4 != 1)
    line.edge = ModelEdge{Eigen::Vector3d::Constant(random.normal()),
                          Eigen::Vector3d(random.normal(), random.normal(), random.normal())};
  if (i % 4 != 2)
    line.line = ImageLine{Eigen::Vector2d::Constant(random.uniform(0, 2000)),
                          Eigen::Vector2d(random.uniform(0, 2000), random.uniform(0, 2000))};
  line.sigma_px = random.uniform(0.1, 3.0);
  line.enabled = i % 3 != 0;
  line.locked = i % 5 == 0;
  return line;
}

TEST(MarksFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  Random random(2);
  Marks marks;
  for (int i = 0; i < 20; ++i) marks.points.push_back(randomPoint(random, i));
  for (int i = 0; i < 12; ++i) marks.lines.push_back(randomLine(random, i));
  writeMarks(folder / "points.json", marks);
  EXPECT_EQ(readMarks(folder / "points.json"), marks);
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
            "points.json: points[0].pixle: is not known to this version of the format");
  EXPECT_EQ(error("[]", R"([{"id": "l", "line_px": [[1, 1], [1, 1]]}])"),
            "points.json: lines[0].line_px: both ends are the same place");
}

}  // namespace
}  // namespace boresight::sessions
