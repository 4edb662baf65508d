// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotation_round.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/sessions/annotation/random_annotations.h"

namespace boresight::sessions {
namespace {

using test::gaussian;
using test::randomFor;

TEST(BlindAnnotations, BlindRound_KeepsStationPointsWithoutPixels) {
  Random random = randomFor("BlindMarks");
  const Annotations annotations = test::randomAnnotations(random, 12, 12);
  const Annotations blind = blindAnnotations(annotations);
  EXPECT_EQ(blind.points.size(), 9u);  // every fourth has no place of the station
  EXPECT_EQ(blind.lines.size(), 9u);
  std::size_t i = 0;
  for (const PointPair& point : annotations.points) {
    if (!point.point_in_station_m) continue;
    const PointPair& point_pair = blind.points[i++];
    EXPECT_EQ(point_pair.id, point.id);
    EXPECT_EQ(point_pair.point_in_station_m, point.point_in_station_m);
    EXPECT_FALSE(point_pair.pixel);
    EXPECT_EQ(point_pair.enabled, point.enabled);
    EXPECT_FALSE(point_pair.locked);
  }
  for (const LinePair& line : blind.lines) EXPECT_TRUE(line.edge && !line.line);
}

TEST(BlindAnnotations, RoundIsBlind_UntilEachOfItsPlacesIsSetOrRemoved) {
  Random random = randomFor("BlindRound");
  const auto scene = test::randomScene(random, CameraModel::kPinhole, 2, 1, 0.0);
  const Annotations& first = scene.view.annotations;
  const AnnotationRounds rounds = {{"A", "now", first}};
  Annotations at_work = blindAnnotations(first);
  EXPECT_FALSE(isBlind({}, at_work)) << "no round has these annotations";
  EXPECT_TRUE(isBlind(rounds, at_work));
  at_work.points[0].pixel = Eigen::Vector2d(1.0, 2.0);
  at_work.lines[0].line = first.lines[0].line;
  EXPECT_TRUE(isBlind(rounds, at_work)) << "one is left";
  EXPECT_FALSE(isBlind(rounds, withoutAnnotation(at_work, at_work.points[1].id)));
  at_work.points[1].pixel = Eigen::Vector2d(1.0, 2.0);
  EXPECT_FALSE(isBlind(rounds, at_work));
}

Annotations seenBy(const Annotations& truth, double sigma_px, Random& random) {
  Annotations seen = truth;
  for (PointPair& point : seen.points) *point.pixel += gaussian(random, sigma_px);
  for (LinePair& line : seen.lines) {
    line.line->start += gaussian(random, sigma_px);
    line.line->end += gaussian(random, sigma_px);
  }
  return seen;
}

TEST(Repeatability, FindsTheSigmaOfTwoAnnotators) {
  Random random = randomFor("Repeatability");
  const auto scene = test::randomScene(random, CameraModel::kPinhole, 400, 400, 0.0);
  for (const double sigma_px : {0.1, 0.35, 1.0}) {
    const Repeatability result = repeatability(seenBy(scene.view.annotations, sigma_px, random),
                                               seenBy(scene.view.annotations, sigma_px, random));
    ASSERT_EQ(result.annotations.size(), 800u);
    // 1600 values: the deviation of their deviation is 1.8 %.
    EXPECT_NEAR(result.sigma_px / sigma_px, 1.0, 0.06);
  }
}

PointPair point(const std::string& id, const Eigen::Vector2d& pixel) {
  PointPair point_pair;
  point_pair.id = id;
  point_pair.point_in_station_m = Eigen::Vector3d::Zero();
  point_pair.pixel = pixel;
  return point_pair;
}

LinePair line(const std::string& id, const Eigen::Vector2d& start, const Eigen::Vector2d& end) {
  LinePair line_pair;
  line_pair.id = id;
  line_pair.edge = ModelEdge{{0, 0, 0}, {1, 0, 0}};
  line_pair.line = ImageLine{start, end};
  return line_pair;
}

TEST(Repeatability, ComparesCommonAnnotations) {
  Annotations first, second;
  first.points = {point("b", {10, 20}), point("a", {1, 2}), point("half", {1, 1}),
                  point("alone", {1, 1})};
  first.points[2].pixel.reset();
  second.points = {point("a", {4, 6}), point("b", {10, 20}), point("half", {1, 1})};
  const Repeatability result = repeatability(first, second);
  ASSERT_EQ(result.annotations.size(), 2u);
  EXPECT_EQ(result.annotations[0].id, "a");
  EXPECT_EQ(result.annotations[0].difference_px, Eigen::Vector2d(3, 4));
  EXPECT_EQ(result.annotations[1].difference_px, Eigen::Vector2d::Zero());
  EXPECT_DOUBLE_EQ(result.sigma_px, std::sqrt(25.0 / 4.0) / std::sqrt(2.0));
  EXPECT_EQ(repeatability(first, {}).sigma_px, 0.0);
}

TEST(Repeatability, OfALineCountsOnlyWhatIsAcross) {
  Annotations first, second;
  first.lines.push_back(line("l1", {0, 0}, {100, 0}));
  second.lines.push_back(line("l1", {130, 2}, {40, 1}));  // the other way round
  const Repeatability result = repeatability(first, second);
  ASSERT_EQ(result.annotations.size(), 1u);
  EXPECT_EQ(result.annotations[0].difference_px, Eigen::Vector2d(1, 2));
}

}  // namespace
}  // namespace boresight::sessions
