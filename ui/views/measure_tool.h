// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QPointF>
#include <QString>

#include "sessions/trace/surface_point.h"
#include "ui/views/canvas_tool.h"

class QPainter;

namespace boresight::ui {

class ViewState;

/// Measures on the image: from a press to the release, in pixels, and in millimetres on the
/// station's surface if both ends are on it in the shown pose.
class MeasureTool : public CanvasTool {
  Q_OBJECT

 public:
  MeasureTool(ImageView& view, ViewState& state, QObject* parent = nullptr);

  bool isActive() const { return active_; }
  void setActive(bool active);
  /// "123.4 px, 45.67 mm", or empty.
  QString text() const;

  void cancelGesture() override;
  void leave() override { setActive(false); }
  void escape() override { from_ ? cancelGesture() : leave(); }

 Q_SIGNALS:
  void activeChanged(bool active);

 private:
  void press(const QPointF& pixel);
  void moveTo(const QPointF& pixel);
  void paint(QPainter& painter) const;

  ViewState& state_;
  bool active_ = false;
  std::optional<QPointF> from_;  ///< px
  QPointF to_;                   ///< px
  sessions::Measurement measured_;
};

}  // namespace boresight::ui
