// SPDX-License-Identifier: Apache-2.0
#include "ui/models/annotations_model.h"

#include <gtest/gtest.h>

#include <QtTest>

#include "tests/ui/models/tested_model.h"

namespace boresight::ui {
namespace {

using sessions::Annotations;
using sessions::LinePair;
using sessions::PointPair;

Annotations someAnnotations() {
  Annotations annotations;
  annotations.points.resize(2);
  PointPair& whole = annotations.points[0];
  whole.id = "p1";
  whole.point_in_station_m = {0.1, 0.2, 0.3};
  whole.pixel = {10.25, 20.5};
  PointPair& half = annotations.points[1];
  half.id = "p2";
  half.pixel = {30.0, 5.0};
  half.enabled = false;
  LinePair& line = annotations.lines.emplace_back();
  line.id = "l1";
  line.line = {{1.0, 2.0}, {3.0, 4.0}};
  line.edge = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}};
  return annotations;
}

/// p1 fits, the line is far out.
AnnotationsModel::SolutionPtr someSolution(const Annotations& annotations) {
  auto result = std::make_shared<sessions::CaseAnnotationsSolution>();
  result->annotations.views.resize(1);
  result->annotations.views[0].annotations = annotations;
  sessions::AnnotationsSolution solution;
  sessions::SolvedAnnotation point;
  point.address = {0, sessions::AnnotationKind::kPoint, 0};
  point.projected = true;
  point.residual_px = {0.24, -0.25};
  point.residual_mm = {0.01, -0.02};
  point.normalized = 0.9;
  sessions::SolvedAnnotation line = point;
  line.address = {0, sessions::AnnotationKind::kLine, 0};
  line.normalized = 7.0;
  solution.annotations = {point, line};
  result->result.solution = solution;
  result->left_out = {{point.address, true, 0.5, 1.5}, {line.address, false, 0.0, 0.0}};
  return result;
}

class AnnotationsModelTest : public test::TestedModel<AnnotationsModel> {
 protected:
  AnnotationsModelTest() { model_.setAnnotations(someAnnotations()); }

  bool edit(int row, int column, const QVariant& value, int role = Qt::EditRole) {
    return model_.setData(model_.index(row, column), value, role);
  }
};

TEST_F(AnnotationsModelTest, HasARowPerAnnotationPointsFirst_WhichASolutionFills) {
  ASSERT_EQ(model_.rowCount(), 3);
  EXPECT_EQ(text(0, AnnotationsModel::kName), QStringLiteral("p1"));
  EXPECT_EQ(text(0, AnnotationsModel::kU_px), QStringLiteral("10.25"));
  EXPECT_EQ(text(0, AnnotationsModel::kX_mm), QStringLiteral("100.000"));
  EXPECT_EQ(text(1, AnnotationsModel::kX_mm), QString()) << "half made";
  EXPECT_EQ(text(2, AnnotationsModel::kName), QStringLiteral("l1"));
  EXPECT_EQ(model_.rowOf("l1"), 2);
  EXPECT_EQ(model_.rowOf("none"), -1);
  model_.setSolution(someSolution(model_.annotations()), false);
  EXPECT_EQ(text(0, AnnotationsModel::kResidualX_px), QStringLiteral("0.24"));
  EXPECT_EQ(text(0, AnnotationsModel::kWithout_mm), QStringLiteral("0.500"));
  EXPECT_EQ(text(1, AnnotationsModel::kResidualX_px), QString()) << "it took no part";
  EXPECT_EQ(text(2, AnnotationsModel::kWithout_mm), QStringLiteral("no pose"));
  EXPECT_TRUE(text(2, AnnotationsModel::kNormalized).contains(QLatin1Char('!')));
  EXPECT_FALSE(text(0, AnnotationsModel::kNormalized).contains(QLatin1Char('!')));
  // By name: an annotation that went away takes its figures with it.
  Annotations fewer = model_.annotations();
  fewer.points.erase(fewer.points.begin());
  model_.setAnnotations(fewer);
  EXPECT_EQ(text(0, AnnotationsModel::kResidualX_px), QString());
  EXPECT_TRUE(text(1, AnnotationsModel::kNormalized).contains(QLatin1Char('!')));
}

TEST_F(AnnotationsModelTest, Edits_AreSignalledNotApplied) {
  PointPair edited;
  QString name;
  QObject::connect(&model_, &AnnotationsModel::pointEdited, &model_,
                   [&](const std::string&, const PointPair& point, const QString& said) {
                     edited = point;
                     name = said;
                   });
  ASSERT_TRUE(edit(0, AnnotationsModel::kU_px, QStringLiteral("11.5")));
  EXPECT_EQ(edited.pixel, Eigen::Vector2d(11.5, 20.5));
  EXPECT_EQ(name, QStringLiteral("Move p1"));
  EXPECT_EQ(text(0, AnnotationsModel::kU_px), QStringLiteral("10.25"));
  ASSERT_TRUE(edit(0, AnnotationsModel::kSigma_px, QStringLiteral("0,5")));
  EXPECT_EQ(edited.sigma_px, 0.5) << "a comma is a point";
  ASSERT_TRUE(edit(0, AnnotationsModel::kU_px, QStringLiteral("11,75")));
  EXPECT_EQ(edited.pixel, Eigen::Vector2d(11.75, 20.5));
  ASSERT_TRUE(edit(0, AnnotationsModel::kZ_mm, 299.0));
  EXPECT_DOUBLE_EQ(edited.point_in_station_m->z(), 0.299);
  ASSERT_TRUE(edit(0, AnnotationsModel::kOn, Qt::Unchecked, Qt::CheckStateRole));
  EXPECT_FALSE(edited.enabled);
  EXPECT_EQ(name, QStringLiteral("Turn p1 off"));
  ASSERT_TRUE(edit(0, AnnotationsModel::kComment, QStringLiteral("left screw")));
  EXPECT_EQ(edited.comment, "left screw");
}

TEST_F(AnnotationsModelTest, InvalidValue_IsRefused) {
  int told = 0;
  QObject::connect(&model_, &AnnotationsModel::pointEdited, &model_, [&] { ++told; });
  for (const char* wrong : {"", "abc", "nan", "inf", "-1", "0"})
    EXPECT_FALSE(edit(0, AnnotationsModel::kSigma_px, QString::fromUtf8(wrong))) << wrong;
  for (const char* wrong : {"", "abc", "nan", "inf"})
    EXPECT_FALSE(edit(0, AnnotationsModel::kU_px, QString::fromUtf8(wrong))) << wrong;
  EXPECT_FALSE(edit(1, AnnotationsModel::kX_mm, 1.0)) << "its place of the station is not marked";
  EXPECT_FALSE(edit(0, AnnotationsModel::kResidualX_px, 1.0));
  EXPECT_EQ(told, 0);
  Annotations locked = model_.annotations();
  locked.points[0].locked = true;
  model_.setAnnotations(locked);
  EXPECT_FALSE(model_.index(0, AnnotationsModel::kU_px).flags().testFlag(Qt::ItemIsEditable));
}

TEST_F(AnnotationsModelTest, FiltersAndSorts) {
  model_.setSolution(someSolution(model_.annotations()), false);
  using Show = AnnotationsModel::Show;
  for (const auto& [show, count] :
       {std::pair(Show::kUsed, 2), std::pair(Show::kOff, 1), std::pair(Show::kHalfMade, 1),
        std::pair(Show::kStandOut, 1), std::pair(Show::kLines, 1), std::pair(Show::kAll, 3)})
    EXPECT_EQ(countOf(show), count) << static_cast<int>(show);
  filter_.sort(AnnotationsModel::kNormalized, Qt::DescendingOrder);
  EXPECT_EQ(filter_.index(0, AnnotationsModel::kName).data().toString(), QStringLiteral("l1"));
  EXPECT_EQ(filter_.index(2, AnnotationsModel::kName).data().toString(), QStringLiteral("p2"));
}

}  // namespace
}  // namespace boresight::ui
