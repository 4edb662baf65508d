// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <QPointF>

#include "sessions/session/ignore_strokes.h"
#include "ui/views/canvas_tool.h"

namespace boresight::ui {

enum class MaskTool : std::uint8_t { kNone, kBrush, kPolygon };

/// Draws strokes of the ignore mask on an image view: a brush by dragging, a polygon by clicking
/// its corners. The stroke is reported when the gesture ends; until the mask includes it, it is
/// drawn as a preview. Enter or a click on the first or the last corner closes a polygon, Backspace
/// drops its last corner, Escape drops the polygon, and without one the tool.
class MaskEditor : public CanvasTool {
  Q_OBJECT

 public:
  static constexpr double kMinRadius_px = 0.5;
  static constexpr double kMaxRadius_px = 500.0;

  explicit MaskEditor(ImageView& view, QObject* parent = nullptr);

  MaskTool tool() const { return tool_; }
  bool erases() const { return erase_; }
  double radius_px() const { return radius_px_; }
  void setTool(MaskTool tool);
  void setErase(bool erase);
  void setRadius(double radius_px);
  /// Closes the polygon under way: a stroke if it has three corners or more, else nothing.
  void closePolygon();

  /// Sets the strokes whose mask is still being computed.
  void setPending(const sessions::MaskStrokes& strokes);

  void cancelGesture() override;
  /// Corners of a polygon stay: no button holds them.
  void loseButton() override;
  void leave() override { setTool(MaskTool::kNone); }
  void escape() override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void strokeDrawn(const boresight::sessions::MaskStroke& stroke);
  /// Tool, size, or erasing has changed.
  void changed();

 private:
  void press(const QPointF& pixel);
  void move(const QPointF& pixel);
  void finishBrush();
  bool pressKey(int key);
  bool isNear(const QPointF& pixel, const QPointF& corner) const;
  void finish();
  void showPreview();

  MaskTool tool_ = MaskTool::kNone;
  bool erase_ = false;
  double radius_px_ = 12.0;
  std::vector<QPointF> points_;  ///< of the gesture under way
  QPointF pointer_;
  sessions::MaskStrokes pending_;
};

}  // namespace boresight::ui
