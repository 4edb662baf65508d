// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>
#include <QPointF>

#include "ui/scene/viewpoint.h"

class QKeyEvent;
class QMouseEvent;
class QWidget;

namespace boresight::ui {

/// The mouse and the keys on the scene's canvas, as what they ask for. Places are in the canvas'
/// coordinates, its top-left corner (0, 0).
class SceneInput : public QObject {
  Q_OBJECT

 public:
  /// Belongs to the canvas.
  explicit SceneInput(QWidget& canvas);

 Q_SIGNALS:
  void resized();
  void clicked(const QPointF& at, Qt::KeyboardModifiers modifiers);
  void dragged(const QPointF& moved, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers);
  void turned(const QPointF& by);
  void zoomed(const QPointF& at, double notches);
  void resetAsked();
  void lookFromAsked(StandardView view);
  void throughCameraToggled();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void press(const QMouseEvent& event);
  void move(const QMouseEvent& event);
  void release(const QMouseEvent& event);
  bool pressKey(const QKeyEvent& event);

  QWidget& canvas_;
  QPointF press_;
  QPointF last_;
  bool pressed_ = false;
  bool dragging_ = false;
};

}  // namespace boresight::ui
