// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_content.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "tests/support/random_pose.h"

namespace boresight::ui {
namespace {

class AnnotationContentTest : public testing::Test {
 protected:
  AnnotationContentTest() {
    look_.camera = test::makePinhole(1001, 1001, 1000.0);
    look_.camera_from_station.emplace().translation_m = {0.0, 0.0, 1.0};
  }

  static sessions::PointPair complete(const std::string& id) {
    sessions::PointPair point;
    point.id = id;
    point.point_in_station_m = Eigen::Vector3d(0.01, 0.02, 0.0);
    point.pixel = Eigen::Vector2d(512.3, 520.7);
    return point;
  }
  /// The sign that carries the label.
  Mark signOf(const sessions::PointPair& point) {
    for (const Mark& mark : annotationSigns({{point}, {}}, look_))
      if (!mark.label.isEmpty()) return mark;
    return {};
  }

  AnnotationLook look_;
};

TEST_F(AnnotationContentTest, PointStates_DifferInShapeOrLabel) {
  std::vector<sessions::PointPair> points(6, complete("p1"));
  points[1].point_in_station_m.reset();
  points[2].pixel.reset();
  points[3].enabled = false;
  points[4].locked = true;
  std::set<std::tuple<MarkShape, bool, QString>> looks;
  for (std::size_t i = 0; i < points.size(); ++i) {
    look_.outliers.clear();
    if (i == 5) look_.outliers["p1"] = 4.2;
    const Mark mark = signOf(points[i]);
    looks.insert({mark.shape, mark.dashed, mark.label});
    EXPECT_TRUE(mark.label.contains(QStringLiteral("p1")));
    EXPECT_EQ(mark.item, 0);
  }
  EXPECT_EQ(looks.size(), points.size());
}

TEST_F(AnnotationContentTest, PointWithoutPixel_IsDrawnAtItsProjection) {
  sessions::PointPair point = complete("p1");
  point.pixel.reset();
  const Mark mark = signOf(point);
  EXPECT_TRUE(mark.dashed);
  EXPECT_NEAR(mark.at.x(), 510.0, 1e-9);
  EXPECT_NEAR(mark.at.y(), 520.0, 1e-9);
  point.point_in_station_m = Eigen::Vector3d(0.0, 0.0, -5.0);
  EXPECT_TRUE(signOf(point).label.isEmpty()) << "behind the camera it stands nowhere";
}

TEST_F(AnnotationContentTest, SelectedAnnotation_HasARingAndAnItemId) {
  sessions::LinePair line;
  line.id = "l1";
  line.line = sessions::ImageLine{{10.0, 20.0}, {110.0, 60.0}};
  const sessions::Annotations annotations = {{complete("p1"), complete("p2")}, {line}};
  const std::size_t unchosen = annotationSigns(annotations, look_).size();
  look_.selected = "p2";
  const auto signs = annotationSigns(annotations, look_);
  EXPECT_EQ(signs.size(), unchosen + 1);
  std::set<std::string> ids;
  for (const Mark& mark : signs) ids.insert(idOfSign(annotations, mark.item));
  EXPECT_EQ(ids, (std::set<std::string>{"p1", "p2", "l1"}));
  EXPECT_EQ(idOfSign(annotations, -1), "");
  EXPECT_EQ(idOfSign(annotations, 3), "");
}

TEST_F(AnnotationContentTest, Residuals_AreMagnifiedFromTheProjection) {
  const std::vector<sessions::AnnotationVector> vectors = {{"p1", {100.0, 50.0}, {100.25, 49.5}}};
  for (const double factor : {1.0, 40.0}) {
    const auto signs = residualSigns(vectors, look_, factor, false);
    ASSERT_EQ(signs.size(), 1u);
    EXPECT_EQ(signs[0].at, QPointF(100.0, 50.0));
    EXPECT_NEAR(signs[0].to.x(), 100.0 + 0.25 * factor, 1e-9);
    EXPECT_NEAR(signs[0].to.y(), 50.0 - 0.5 * factor, 1e-9);
    EXPECT_FALSE(signs[0].dashed);
  }
  EXPECT_TRUE(residualSigns(vectors, look_, 1.0, true)[0].dashed) << "not up to date";
}

TEST_F(AnnotationContentTest, TheBandLiesOnBothSidesOfTheEdge) {
  sessions::BandPiece piece;
  for (const double x : {0.0, 10.0, 20.0})
    piece.places.push_back({{x, 5.0}, {0.0, 1.0}, 0.5 + 0.1 * x});
  const auto signs = bandSigns({piece, {}});
  ASSERT_EQ(signs.size(), 1u);
  const QPolygonF& outline = signs[0].outline;
  ASSERT_EQ(outline.size(), 6);
  EXPECT_EQ(outline[0], QPointF(0.0, 5.5));
  EXPECT_EQ(outline[2], QPointF(20.0, 7.5));
  EXPECT_EQ(outline[3], QPointF(20.0, 2.5));
  EXPECT_EQ(outline[5], QPointF(0.0, 4.5));
}

}  // namespace
}  // namespace boresight::ui
