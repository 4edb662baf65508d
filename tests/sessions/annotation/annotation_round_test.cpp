// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotation_round.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/sessions/annotation/random_annotations.h"

namespace boresight::sessions {
namespace {

using test::gaussian;
using test::randomFor;

TEST(BlindAnnotations, BlindRound_KeepsStationPointsWithoutPixels) {
  Random random = randomFor("BlindMarks");
  const Annotations annotations = test::randomAnnotations(random, 12, 12);
  Annotations expected = annotations;
  std::erase_if(expected.points, [](const PointPair& point) { return !point.point_in_station_m; });
  std::erase_if(expected.lines, [](const LinePair& line) { return !line.edge; });
  EXPECT_EQ(expected.points.size() + expected.lines.size(), 18u);  // every fourth has no place
  for (PointPair& point : expected.points) {
    point.pixel.reset();
    point.locked = false;
  }
  for (LinePair& line : expected.lines) {
    line.line.reset();
    line.locked = false;
  }
  EXPECT_EQ(blindAnnotations(annotations), expected);
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

PointPair point(const std::string& id, const std::optional<Eigen::Vector2d>& pixel) {
  return {id, Eigen::Vector3d::Zero(), pixel, 1.0, true, false, ""};
}

TEST(Repeatability, ComparesCommonAnnotations) {
  Annotations first, second;
  using Eigen::Vector2d;
  first.points = {point("b", Vector2d(10, 20)), point("a", Vector2d(1, 2)), point("half", {}),
                  point("alone", Vector2d(1, 1))};
  second.points = {point("a", Vector2d(4, 6)), point("b", Vector2d(10, 20)),
                   point("half", Vector2d(1, 1))};
  const Repeatability result = repeatability(first, second);
  ASSERT_EQ(result.annotations.size(), 2u);
  EXPECT_EQ(result.annotations[0].id, "a");
  EXPECT_EQ(result.annotations[0].difference_px, Eigen::Vector2d(3, 4));
  EXPECT_EQ(result.annotations[1].difference_px, Eigen::Vector2d::Zero());
  EXPECT_DOUBLE_EQ(result.sigma_px, std::sqrt(25.0 / 4.0) / std::sqrt(2.0));
  EXPECT_EQ(repeatability(first, {}).sigma_px, 0.0);
}

TEST(Repeatability, OfALineCountsOnlyWhatIsAcross) {
  Annotations first;
  first.lines.emplace_back().id = "l1";
  first.lines[0].edge = ModelEdge{{0, 0, 0}, {1, 0, 0}};
  first.lines[0].line = ImageLine{{0, 0}, {100, 0}};
  Annotations second = first;
  second.lines[0].line = ImageLine{{130, 2}, {40, 1}};  // the other way round
  const Repeatability result = repeatability(first, second);
  ASSERT_EQ(result.annotations.size(), 1u);
  EXPECT_EQ(result.annotations[0].difference_px, Eigen::Vector2d(1, 2));
}

}  // namespace
}  // namespace boresight::sessions
