// SPDX-License-Identifier: Apache-2.0
#include "ui/models/marks_model.h"

#include <gtest/gtest.h>

#include <QtTest>

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;
using sessions::LinePair;
using sessions::Marks;
using sessions::PointPair;

Marks someMarks() {
  Marks marks;
  PointPair whole;
  whole.id = "p1";
  whole.point_in_station_m = {0.1, 0.2, 0.3};
  whole.pixel = {10.25, 20.5};
  PointPair half;
  half.id = "p2";
  half.pixel = {30.0, 5.0};
  half.enabled = false;
  marks.points = {whole, half};
  LinePair line;
  line.id = "l1";
  line.line = {{1.0, 2.0}, {3.0, 4.0}};
  line.edge = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}};
  marks.lines.push_back(line);
  return marks;
}

/// p1 fits, the line is far out.
MarksModel::SolutionPtr someSolution(const Marks& marks) {
  auto made = std::make_shared<sessions::CaseMarksSolution>();
  made->marks.views.resize(1);
  made->marks.views[0].marks = marks;
  sessions::MarksSolution solution;
  sessions::SolvedMark point;
  point.address = {0, sessions::MarkKind::kPoint, 0};
  point.projected = true;
  point.residual_px = {0.24, -0.25};
  point.residual_mm = {0.01, -0.02};
  point.normalized = 0.9;
  sessions::SolvedMark line = point;
  line.address = {0, sessions::MarkKind::kLine, 0};
  line.normalized = 7.0;
  solution.marks = {point, line};
  made->result.solution = solution;
  made->left_out = {{point.address, true, 0.5, 1.5}, {line.address, false, 0.0, 0.0}};
  return made;
}

class MarksModelTest : public ::testing::Test {
 protected:
  MarksModelTest() {
    filter_.setSourceModel(&model_);
    model_.setMarks(someMarks());
  }

  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }
  bool edit(int row, int column, const QVariant& value, int role = Qt::EditRole) {
    return model_.setData(model_.index(row, column), value, role);
  }

  MarksModel model_;
  RowsFilter filter_;
  Tester model_tester_{&model_, Tester::FailureReportingMode::Fatal};
  Tester filter_tester_{&filter_, Tester::FailureReportingMode::Fatal};
};

TEST_F(MarksModelTest, HasARowPerMarkPointsFirst) {
  ASSERT_EQ(model_.rowCount(), 3);
  EXPECT_EQ(text(0, MarksModel::kName), QStringLiteral("p1"));
  EXPECT_EQ(text(0, MarksModel::kU_px), QStringLiteral("10.25"));
  EXPECT_EQ(text(0, MarksModel::kX_mm), QStringLiteral("100.000"));
  EXPECT_EQ(text(1, MarksModel::kX_mm), QString()) << "half made";
  EXPECT_EQ(text(2, MarksModel::kName), QStringLiteral("l1"));
  EXPECT_EQ(model_.rowOf("l1"), 2);
  EXPECT_EQ(model_.rowOf("none"), -1);
}

TEST_F(MarksModelTest, ShowsWhatTheSolutionSaysOfEachMark) {
  model_.setSolution(someSolution(model_.marks()), false);
  EXPECT_EQ(text(0, MarksModel::kResidualX_px), QStringLiteral("0.24"));
  EXPECT_EQ(text(0, MarksModel::kWithout_mm), QStringLiteral("0.500"));
  EXPECT_EQ(text(1, MarksModel::kResidualX_px), QString()) << "it took no part";
  EXPECT_EQ(text(2, MarksModel::kWithout_mm), QStringLiteral("no pose"));
  EXPECT_TRUE(text(2, MarksModel::kNormalized).contains(QLatin1Char('!')));
  EXPECT_FALSE(text(0, MarksModel::kNormalized).contains(QLatin1Char('!')));
  // By name: a mark that went away takes its figures with it.
  Marks fewer = model_.marks();
  fewer.points.erase(fewer.points.begin());
  model_.setMarks(fewer);
  EXPECT_EQ(text(0, MarksModel::kResidualX_px), QString());
  EXPECT_TRUE(text(1, MarksModel::kNormalized).contains(QLatin1Char('!')));
}

TEST_F(MarksModelTest, TellsEditsAndDoesNotMakeThem) {
  PointPair edited;
  QString name;
  QObject::connect(&model_, &MarksModel::pointEdited, &model_,
                   [&](const std::string&, const PointPair& point, const QString& said) {
                     edited = point;
                     name = said;
                   });
  ASSERT_TRUE(edit(0, MarksModel::kU_px, QStringLiteral("11.5")));
  EXPECT_EQ(edited.pixel, Eigen::Vector2d(11.5, 20.5));
  EXPECT_EQ(name, QStringLiteral("Move p1"));
  EXPECT_EQ(text(0, MarksModel::kU_px), QStringLiteral("10.25"));
  ASSERT_TRUE(edit(0, MarksModel::kZ_mm, 299.0));
  EXPECT_DOUBLE_EQ(edited.point_in_station_m->z(), 0.299);
  ASSERT_TRUE(edit(0, MarksModel::kOn, Qt::Unchecked, Qt::CheckStateRole));
  EXPECT_FALSE(edited.enabled);
  EXPECT_EQ(name, QStringLiteral("Turn p1 off"));
  ASSERT_TRUE(edit(0, MarksModel::kComment, QStringLiteral("left screw")));
  EXPECT_EQ(edited.comment, "left screw");
}

TEST_F(MarksModelTest, RefusesWhatIsNoValue) {
  int told = 0;
  QObject::connect(&model_, &MarksModel::pointEdited, &model_, [&] { ++told; });
  for (const char* wrong : {"", "abc", "nan", "inf", "-1", "0"})
    EXPECT_FALSE(edit(0, MarksModel::kSigma_px, QString::fromUtf8(wrong))) << wrong;
  for (const char* wrong : {"", "abc", "nan", "inf"})
    EXPECT_FALSE(edit(0, MarksModel::kU_px, QString::fromUtf8(wrong))) << wrong;
  EXPECT_FALSE(edit(1, MarksModel::kX_mm, 1.0)) << "its place of the station is not marked";
  EXPECT_FALSE(edit(0, MarksModel::kResidualX_px, 1.0));
  EXPECT_EQ(told, 0);
  Marks locked = model_.marks();
  locked.points[0].locked = true;
  model_.setMarks(locked);
  EXPECT_FALSE(model_.index(0, MarksModel::kU_px).flags().testFlag(Qt::ItemIsEditable));
}

TEST_F(MarksModelTest, FiltersAndSorts) {
  model_.setSolution(someSolution(model_.marks()), false);
  const auto count = [&](MarksModel::Show show) {
    filter_.setCondition([this, show](int row) { return model_.isShown(row, show); });
    return filter_.rowCount();
  };
  EXPECT_EQ(count(MarksModel::Show::kAll), 3);
  EXPECT_EQ(count(MarksModel::Show::kUsed), 2);
  EXPECT_EQ(count(MarksModel::Show::kOff), 1);
  EXPECT_EQ(count(MarksModel::Show::kHalfMade), 1);
  EXPECT_EQ(count(MarksModel::Show::kStandOut), 1);
  EXPECT_EQ(count(MarksModel::Show::kLines), 1);
  count(MarksModel::Show::kAll);
  filter_.sort(MarksModel::kNormalized, Qt::DescendingOrder);
  EXPECT_EQ(filter_.index(0, MarksModel::kName).data().toString(), QStringLiteral("l1"));
  EXPECT_EQ(filter_.index(2, MarksModel::kName).data().toString(), QStringLiteral("p2"));
}

}  // namespace
}  // namespace boresight::ui
