// SPDX-License-Identifier: Apache-2.0
#include "ui/views/mask_editor.h"

#include <gtest/gtest.h>

#include <vector>

#include <QMouseEvent>
#include <QtTest/QTest>

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
  void send(QEvent::Type type, const QPoint& at) {
    const bool moves = type == QEvent::MouseMove;
    QMouseEvent event(type, at, view_.mapToGlobal(at), moves ? Qt::NoButton : Qt::LeftButton,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&view_, &event);
  }
  void drag(const std::vector<QPoint>& places) {
    send(QEvent::MouseButtonPress, places.front());
    for (const QPoint& at : places) send(QEvent::MouseMove, at);
    send(QEvent::MouseButtonRelease, places.back());
  }
  void click(double x, double y) {
    QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place(x, y));
  }
  QColor at(double x, double y) { return view_.grab().toImage().pixelColor(place(x, y)); }

  ImageView view_;
  MaskEditor editor_{view_};
  std::vector<MaskStroke> strokes_;
};

TEST_F(MaskEditorTest, ADragWithTheBrushIsOneStrokeThroughThePointersPlaces) {
  editor_.setTool(MaskTool::kBrush);
  editor_.setRadius(3.0);
  const QPointF before = view_.transform().toWidget(QPointF(0.0, 0.0));
  drag({place(20, 30), place(40, 30), place(40, 50)});
  ASSERT_EQ(strokes_.size(), 1u);
  EXPECT_EQ(strokes_[0].kind, StrokeKind::kBrush);
  EXPECT_FALSE(strokes_[0].erase);
  EXPECT_EQ(strokes_[0].radius_px, 3.0);
  ASSERT_EQ(strokes_[0].points.size(), 3u);
  EXPECT_LT((strokes_[0].points[1] - Eigen::Vector2d(40.0, 30.0)).norm(), 0.15);
  EXPECT_EQ(view_.transform().toWidget(QPointF(0.0, 0.0)), before) << "the image does not move";
}

TEST_F(MaskEditorTest, DrawnStroke_ShowsUntilTheMaskContainsIt) {
  editor_.setTool(MaskTool::kBrush);
  editor_.setRadius(3.0);
  send(QEvent::MouseButtonPress, place(20, 30));
  send(QEvent::MouseMove, place(60, 30));
  EXPECT_NE(at(40, 30), QColor(60, 60, 60));
  EXPECT_NE(at(40, 32), QColor(60, 60, 60));
  EXPECT_EQ(at(40, 34), QColor(60, 60, 60));
  send(QEvent::MouseButtonRelease, place(60, 30));
  EXPECT_EQ(at(40, 32), QColor(60, 60, 60)) << "the stroke is not stored";
  editor_.setPending(strokes_);
  EXPECT_NE(at(40, 32), QColor(60, 60, 60));
  editor_.setPending({});
  EXPECT_EQ(at(40, 32), QColor(60, 60, 60));
}

TEST_F(MaskEditorTest, ADoubleClickWithTheBrushMakesTwoDabs) {
  editor_.setTool(MaskTool::kBrush);
  editor_.setErase(true);
  QTest::mouseClick(&view_, Qt::LeftButton, Qt::NoModifier, place(50, 40));
  QTest::mouseDClick(&view_, Qt::LeftButton, Qt::NoModifier, place(50, 40));
  send(QEvent::MouseButtonRelease, place(50, 40));
  EXPECT_EQ(strokes_.size(), 2u);
  EXPECT_TRUE(strokes_.back().erase);
  EXPECT_EQ(strokes_.back().points.size(), 1u);
}

TEST_F(MaskEditorTest, ClicksAndEnterMakeAPolygon) {
  editor_.setTool(MaskTool::kPolygon);
  click(10, 10);
  click(60, 10);
  click(60, 50);
  click(90, 70);
  QTest::keyClick(&view_, Qt::Key_Backspace);
  EXPECT_TRUE(strokes_.empty());
  QTest::keyClick(&view_, Qt::Key_Return);
  ASSERT_EQ(strokes_.size(), 1u);
  EXPECT_EQ(strokes_[0].kind, StrokeKind::kPolygon);
  ASSERT_EQ(strokes_[0].points.size(), 3u);
  EXPECT_LT((strokes_[0].points[2] - Eigen::Vector2d(60.0, 50.0)).norm(), 0.15);
}

TEST_F(MaskEditorTest, AClickOnTheFirstCornerOrADoubleClickCloses) {
  editor_.setTool(MaskTool::kPolygon);
  click(10, 10);
  click(60, 10);
  click(60, 50);
  click(10.4, 10.2);
  ASSERT_EQ(strokes_.size(), 1u);
  click(20, 20);
  click(70, 20);
  click(70, 60);
  QTest::mouseDClick(&view_, Qt::LeftButton, Qt::NoModifier, place(70, 60));
  ASSERT_EQ(strokes_.size(), 2u);
  EXPECT_EQ(strokes_[1].points.size(), 3u);
}

TEST_F(MaskEditorTest, TwoCornersAreNoPolygonAndEscapeDropsItThenTheTool) {
  editor_.setTool(MaskTool::kPolygon);
  click(10, 10);
  click(60, 10);
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_TRUE(strokes_.empty());
  click(10, 10);
  QTest::keyClick(&view_, Qt::Key_Escape);
  EXPECT_EQ(editor_.tool(), MaskTool::kPolygon);
  QTest::keyClick(&view_, Qt::Key_Escape);
  EXPECT_EQ(editor_.tool(), MaskTool::kNone);
  EXPECT_FALSE(view_.toolActive());
  click(30, 30);
  EXPECT_TRUE(strokes_.empty());
}

}  // namespace
}  // namespace boresight::ui
