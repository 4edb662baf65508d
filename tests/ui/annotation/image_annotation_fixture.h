// SPDX-License-Identifier: Apache-2.0
// An annotator at the image: real events on the view, at any zoom and screen scaling.
#pragma once

#include <cmath>

#include <QMouseEvent>

#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/mark_tool.h"
#include "ui/annotation/station_snapper.h"
#include "ui/run/task_runner.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"

namespace boresight::ui {

class ImageAnnotationTest : public AnnotationTest {
 protected:
  void SetUp() override {
    panel_.resize(900, 700);
    panel_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel_));
    AnnotationTest::SetUp();
    ready();
    QObject::connect(&annotation_, &ImageAnnotation::told,
                     [this](const QString& told) { told_ = told; });
    QObject::connect(&controller_, &AnnotationController::told,
                     [this](const QString& told) { told_ = told; });
  }

  void ready() {
    ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, kPatience_ms));
    ASSERT_TRUE(QTest::qWaitFor([this] { return !tasks_.isBusy(); }, kPatience_ms));
  }

  /// The open case with another image of the same size.
  template <class Gray>
  void paintImage(const Gray& gray_at) {
    auto painted = std::make_shared<sessions::LoadedCase>();
    painted->source = source();
    painted->scene = state_.currentCase()->scene;
    painted->image = state_.currentCase()->image;
    for (int y = 0; y < painted->image.height; ++y)
      for (int x = 0; x < painted->image.width; ++x)
        painted->image.pixels[static_cast<std::size_t>(y * painted->image.width + x)] =
            static_cast<std::uint8_t>(std::lround(gray_at(x, y)));
    state_.replaceCase(painted);
    ready();
  }

  ImageView& view() { return panel_.view(); }
  MarkTool& tool() { return annotation_.tool(); }
  const sessions::Marks& marks() const { return controller_.marks(); }
  double ratio() { return view().devicePixelRatioF(); }
  /// Length of a screen pixel in image pixels.
  double screenPixel_px() { return 1.0 / (view().transform().scale() * ratio()); }

  /// So many coordinates of the widget to an image pixel, with this pixel in the middle.
  void zoom(const Eigen::Vector2d& pixel, double scale) {
    ViewTransform transform = view().transform();
    transform.zoomAt(QPointF(0.0, 0.0), scale);
    transform.centreOn(QPointF(pixel.x(), pixel.y()), view().size());
    view().setTransform(transform);
  }

  /// What the windowing system tells when the pointer's tip is on the screen pixel of this place.
  QPointF pointer(const Eigen::Vector2d& pixel) {
    const QPointF at = view().transform().toWidget(QPointF(pixel.x(), pixel.y()));
    return QPointF(std::floor(at.x() * ratio()), std::floor(at.y() * ratio())) / ratio();
  }
  void send(QEvent::Type type, const Eigen::Vector2d& pixel,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier,
            Qt::MouseButton button = Qt::LeftButton, bool held = false) {
    const QPointF at = pointer(pixel);
    const bool moves = type == QEvent::MouseMove;
    QMouseEvent event(type, at, QPointF(view().mapToGlobal(QPoint(0, 0))) + at,
                      moves ? Qt::NoButton : button,
                      type == QEvent::MouseButtonPress || held ? button : Qt::NoButton, modifiers);
    QCoreApplication::sendEvent(&view(), &event);
  }
  void moveTo(const Eigen::Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    send(QEvent::MouseMove, pixel, modifiers);
  }
  void click(const Eigen::Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier,
             Qt::MouseButton button = Qt::LeftButton) {
    moveTo(pixel, modifiers);
    send(QEvent::MouseButtonPress, pixel, modifiers, button);
    send(QEvent::MouseButtonRelease, pixel, modifiers, button);
  }
  void drag(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    moveTo(from);
    send(QEvent::MouseButtonPress, from, modifiers);
    send(QEvent::MouseMove, 0.5 * (from + to), modifiers, Qt::LeftButton, true);
    send(QEvent::MouseMove, to, modifiers, Qt::LeftButton, true);
    send(QEvent::MouseButtonRelease, to, modifiers);
  }

  TaskRunner tasks_;
  ImagePanel panel_{state_, tasks_};
  StationSnapper snapper_{state_};
  ImageAnnotation annotation_{panel_, controller_, state_, snapper_};
  QString told_;
};

}  // namespace boresight::ui
