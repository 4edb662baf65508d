// SPDX-License-Identifier: Apache-2.0
#include "ui/views/mask_editor.h"

#include <gtest/gtest.h>

#include <vector>

#include <QtTest/QTest>

#include "tests/ui/pointer.h"
#include "ui/views/image_view.h"

namespace boresight::ui {
namespace {

using sessions::MaskStroke;
using sessions::StrokeKind;

class MaskEditorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    QImage gray(100, 80, QImage::Format_Grayscale8);
    gray.fill(60);
    view_.resize(800, 640);  // eight coordinates per image pixel
    view_.setImage(gray);
    view_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view_));
    QObject::connect(&editor_, &MaskEditor::strokeDrawn,
                     [this](const MaskStroke& stroke) { strokes_.push_back(stroke); });
  }

  QPoint place(double x, double y) { return view_.transform().toWidget(QPointF(x, y)).toPoint(); }
  void send(QEvent::Type type, double x, double y) { test::sendMouse(view_, type, place(x, y)); }
  void click(double x, double y) {
    QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place(x, y));
  }
  void doubleClick(double x, double y) {
    QTest::mouseDClick(&view_, Qt::LeftButton, Qt::NoModifier, place(x, y));
  }
  void press(Qt::Key key) { QTest::keyClick(&view_, key); }
  QColor at(double x, double y) { return view_.grab().toImage().pixelColor(place(x, y)); }

  ImageView view_;
  MaskEditor editor_{view_};
  std::vector<MaskStroke> strokes_;
};

TEST_F(MaskEditorTest, ADragWithTheBrushIsOneStrokeThatShowsUntilTheMaskContainsIt) {
  editor_.setTool(MaskTool::kBrush);
  editor_.setRadius(3.0);
  const QPointF before = view_.transform().toWidget(QPointF(0.0, 0.0));
  test::dragMouse(view_, {place(20, 30), place(40, 30), place(40, 50)});
  ASSERT_EQ(strokes_.size(), 1u);
  EXPECT_EQ(strokes_[0].kind, StrokeKind::kBrush);
  EXPECT_FALSE(strokes_[0].erase);
  EXPECT_EQ(strokes_[0].radius_px, 3.0);
  ASSERT_EQ(strokes_[0].points.size(), 3u);
  EXPECT_LT((strokes_[0].points[1] - Eigen::Vector2d(40.0, 30.0)).norm(), 0.15);
  EXPECT_EQ(view_.transform().toWidget(QPointF(0.0, 0.0)), before) << "the image does not move";

  const QColor gray(60, 60, 60);
  strokes_.clear();
  send(QEvent::MouseButtonPress, 20, 30);
  send(QEvent::MouseMove, 60, 30);
  EXPECT_NE(at(40, 30), gray);
  EXPECT_NE(at(40, 32), gray);
  EXPECT_EQ(at(40, 34), gray);
  send(QEvent::MouseButtonRelease, 60, 30);
  EXPECT_EQ(at(40, 32), gray) << "the stroke is not stored";
  editor_.setPending(strokes_);
  EXPECT_NE(at(40, 32), gray);
  editor_.setPending({});
  EXPECT_EQ(at(40, 32), gray);
}

/// A message box took the release of the button.
TEST_F(MaskEditorTest, MoveWithoutAButton_EndsTheBrushStroke_CornersOfAPolygonStay) {
  editor_.setTool(MaskTool::kBrush);
  send(QEvent::MouseButtonPress, 20, 30);
  send(QEvent::MouseMove, 40, 30);
  test::moveMouse(view_, place(60, 30));
  send(QEvent::MouseButtonRelease, 60, 30);
  EXPECT_TRUE(strokes_.empty());
  editor_.setTool(MaskTool::kPolygon);
  for (const auto& [x, y] : {std::pair(10, 10), std::pair(60, 10), std::pair(60, 50)}) {
    send(QEvent::MouseButtonPress, x, y);
    test::moveMouse(view_, place(x + 5, y + 5));
  }
  press(Qt::Key_Return);
  ASSERT_EQ(strokes_.size(), 1u);
  EXPECT_EQ(strokes_[0].points.size(), 3u);
  editor_.setTool(MaskTool::kNone);
  editor_.setTool(MaskTool::kPolygon);
  click(10, 10);
  click(60, 10);
  view_.cancelGesture();
  click(60, 50);
  press(Qt::Key_Return);
  EXPECT_EQ(strokes_.size(), 1u) << "the corners before are dropped";
  EXPECT_EQ(editor_.tool(), MaskTool::kPolygon);
}

TEST_F(MaskEditorTest, ADoubleClickWithTheBrushMakesTwoDabs) {
  editor_.setTool(MaskTool::kBrush);
  editor_.setErase(true);
  click(50, 40);
  doubleClick(50, 40);
  send(QEvent::MouseButtonRelease, 50, 40);
  EXPECT_EQ(strokes_.size(), 2u);
  EXPECT_TRUE(strokes_.back().erase);
  EXPECT_EQ(strokes_.back().points.size(), 1u);
}

TEST_F(MaskEditorTest, APolygonIsClosedByEnterItsFirstCornerOrADoubleClick) {
  editor_.setTool(MaskTool::kPolygon);
  const auto corners = [this](double x, double y) {
    click(x, y);
    click(x + 50, y);
    click(x + 50, y + 40);
  };
  corners(10, 10);
  click(90, 70);
  press(Qt::Key_Backspace);
  EXPECT_TRUE(strokes_.empty());
  press(Qt::Key_Return);
  ASSERT_EQ(strokes_.size(), 1u);
  EXPECT_EQ(strokes_[0].kind, StrokeKind::kPolygon);
  ASSERT_EQ(strokes_[0].points.size(), 3u);
  EXPECT_LT((strokes_[0].points[2] - Eigen::Vector2d(60.0, 50.0)).norm(), 0.15);
  corners(10, 10);
  click(10.4, 10.2);
  ASSERT_EQ(strokes_.size(), 2u);
  corners(20, 20);
  doubleClick(70, 60);
  ASSERT_EQ(strokes_.size(), 3u);
  EXPECT_EQ(strokes_[2].points.size(), 3u);
}

TEST_F(MaskEditorTest, TwoCornersAreNoPolygonAndEscapeDropsItThenTheTool) {
  editor_.setTool(MaskTool::kPolygon);
  click(10, 10);
  click(60, 10);
  press(Qt::Key_Return);
  EXPECT_TRUE(strokes_.empty());
  click(10, 10);
  press(Qt::Key_Escape);
  EXPECT_EQ(editor_.tool(), MaskTool::kPolygon);
  press(Qt::Key_Escape);
  EXPECT_EQ(editor_.tool(), MaskTool::kNone);
  EXPECT_FALSE(view_.toolActive());
  click(30, 30);
  EXPECT_TRUE(strokes_.empty());
}

}  // namespace
}  // namespace boresight::ui
