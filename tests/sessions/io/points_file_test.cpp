// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/points_file.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;

TEST(PointsFile, RoundTripIsExact) {
  const TemporaryFolder folder;
  Random random(2);
  std::vector<PointPair> points;
  for (int i = 0; i < 20; ++i) {
    PointPair point;
    point.id = "p" + std::to_string(i);
    point.point_in_station_m = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    point.pixel = Eigen::Vector2d(random.uniform(-10, 2000), random.uniform(-10, 2000));
    point.sigma_px = random.uniform(0.1, 3.0);
    point.enabled = i % 3 != 0;
    point.comment = i % 2 == 0 ? "left \"screw\"\n\u00e9" : "";
    points.push_back(point);
  }
  writePoints(folder / "points.json", points);
  const std::vector<PointPair> read = readPoints(folder / "points.json");
  ASSERT_EQ(read.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(read[i].id, points[i].id);
    EXPECT_EQ(read[i].point_in_station_m, points[i].point_in_station_m);
    EXPECT_EQ(read[i].pixel, points[i].pixel);
    EXPECT_EQ(read[i].sigma_px, points[i].sigma_px);
    EXPECT_EQ(read[i].enabled, points[i].enabled);
    EXPECT_EQ(read[i].comment, points[i].comment);
  }
  writePoints(folder / "none.json", {});
  EXPECT_TRUE(readPoints(folder / "none.json").empty());
}

TEST(PointsFile, FillsInWhatMayBeLeftOut) {
  const TemporaryFolder folder;
  const auto points = readPoints(folder.write("points.json", R"({"format": "boresight-points",
      "version": 1, "points": [{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, 5]}]})"));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].sigma_px, 1.0);
  EXPECT_TRUE(points[0].enabled);
  EXPECT_EQ(points[0].comment, "");
}

TEST(PointsFile, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error = [&folder](const std::string& points) {
    return folder.message([&] {
      (void)readPoints(folder.write("points.json", R"({"format": "boresight-points", "version": 1,
          "points": )" + points + "}"));
    });
  };
  const std::string good = R"("point_in_station_m": [1, 2, 3], "pixel": [4, 5])";
  EXPECT_EQ(error("{}"), "points.json: points: not a list (is an object)");
  EXPECT_EQ(error("[{" + good + "}]"), "points.json: points[0].id: missing");
  EXPECT_EQ(error(R"([{"id": "a", )" + good + R"(}, {"id": "a", )" + good + "}]"),
            "points.json: points[1].id: 'a' is given twice");
  EXPECT_EQ(error(R"([{"id": "a", "point_in_station_m": [1, 2], "pixel": [4, 5]}])"),
            "points.json: points[0].point_in_station_m: not a list of 3 (is a list of 2)");
  EXPECT_EQ(error(R"([{"id": "a", "point_in_station_m": [1, 2, 3], "pixel": [4, Infinity]}])"),
            "points.json: points[0].pixel[1]: not a finite number");
  EXPECT_EQ(error(R"([{"id": "a", "sigma_px": 0, )" + good + "}]"),
            "points.json: points[0].sigma_px: 0 is outside 1e-06 .. 10000");
}

}  // namespace
}  // namespace boresight::sessions
