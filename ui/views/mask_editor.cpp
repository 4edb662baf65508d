// SPDX-License-Identifier: Apache-2.0
#include "ui/views/mask_editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QKeyEvent>

#include "ui/views/image_view.h"

namespace boresight::ui {
namespace {

using sessions::MaskStroke;
using sessions::StrokeKind;

constexpr double kCloseDistance = 7.0;  ///< on the screen
/// A brush's points are this share of its radius apart: the track looks the same, and is short.
constexpr double kBrushSpacing = 0.2;

/// As the mask's layer looks; erasing is bright.
QColor previewColor(const ImageView& view, bool erase) {
  QColor color = erase ? QColor(255, 255, 255) : view.layer(LayerId::kIgnoreMask).style.color;
  color.setAlphaF(std::max(0.35, view.layer(LayerId::kIgnoreMask).style.opacity));
  return color;
}

ToolPreview previewOf(const MaskStroke& stroke, const ImageView& view) {
  ToolPreview preview;
  for (const Eigen::Vector2d& point : stroke.points) preview.points.push_back(pointOf(point));
  preview.color = previewColor(view, stroke.erase);
  preview.filled = stroke.kind == StrokeKind::kPolygon;
  if (stroke.kind == StrokeKind::kBrush) preview.radius_px = stroke.radius_px;
  return preview;
}

}  // namespace

MaskEditor::MaskEditor(ImageView& view, QObject* parent) : CanvasTool(view, parent) {
  connect(&view_, &ImageView::toolPressed, this, &MaskEditor::press);
  connect(&view_, &ImageView::toolMoved, this, &MaskEditor::move);
  connect(&view_, &ImageView::toolReleased, this, &MaskEditor::finishBrush);
  connect(&view_, &ImageView::cursorMoved, this, [this](const QPointF& pixel) {
    if (tool_ != MaskTool::kPolygon || points_.empty()) return;
    pointer_ = pixel;
    showPreview();
  });
}

void MaskEditor::setTool(MaskTool tool) {
  if (tool == tool_) return;
  tool_ = tool;
  points_.clear();
  tool != MaskTool::kNone ? claim() : release();
  view_.setToolActive(tool != MaskTool::kNone, tool == MaskTool::kBrush ? radius_px_ : 0.0);
  showPreview();
  Q_EMIT changed();
}

void MaskEditor::setErase(bool erase) {
  if (erase == erase_) return;
  erase_ = erase;
  showPreview();
  Q_EMIT changed();
}

void MaskEditor::setRadius(double radius_px) {
  const double next = std::clamp(radius_px, kMinRadius_px, kMaxRadius_px);
  if (next == radius_px_) return;
  radius_px_ = next;
  if (tool_ == MaskTool::kBrush) view_.setToolActive(true, radius_px_);
  showPreview();
  Q_EMIT changed();
}

void MaskEditor::setPending(const sessions::MaskStrokes& strokes) {
  pending_ = strokes;
  showPreview();
}

bool MaskEditor::isNear(const QPointF& pixel, const QPointF& corner) const {
  return distance_px(pixel, corner) * view_.transform().scale() <= kCloseDistance;
}

void MaskEditor::press(const QPointF& pixel) {
  pointer_ = pixel;
  if (tool_ == MaskTool::kBrush) {
    points_ = {pixel};
  } else if (tool_ == MaskTool::kPolygon) {
    if (points_.size() >= 3 && (isNear(pixel, points_.front()) || isNear(pixel, points_.back())))
      return closePolygon();
    if (points_.empty() || !isNear(pixel, points_.back())) points_.push_back(pixel);
  }
  showPreview();
}

void MaskEditor::move(const QPointF& pixel) {
  pointer_ = pixel;
  if (tool_ == MaskTool::kBrush && !points_.empty() &&
      distance_px(pixel, points_.back()) >= kBrushSpacing * radius_px_)
    points_.push_back(pixel);
  showPreview();
}

void MaskEditor::finishBrush() {
  if (tool_ == MaskTool::kBrush && !points_.empty()) finish();
}

void MaskEditor::closePolygon() {
  if (tool_ != MaskTool::kPolygon) return;
  if (points_.size() >= 3) finish();
  points_.clear();
  showPreview();
}

void MaskEditor::finish() {
  MaskStroke stroke;
  stroke.kind = tool_ == MaskTool::kBrush ? StrokeKind::kBrush : StrokeKind::kPolygon;
  stroke.erase = erase_;
  // What a kind has no use for stays at its default, as it is when the stroke is read from a file.
  if (tool_ == MaskTool::kBrush) stroke.radius_px = radius_px_;
  for (const QPointF& point : std::exchange(points_, {})) stroke.points.push_back(vectorOf(point));
  showPreview();
  Q_EMIT strokeDrawn(stroke);
}

void MaskEditor::showPreview() {
  std::vector<ToolPreview> previews;
  for (const MaskStroke& stroke : pending_)
    if (stroke.kind != StrokeKind::kSaturation) previews.push_back(previewOf(stroke, view_));
  if (!points_.empty()) {
    ToolPreview preview;
    preview.points = points_;
    preview.color = previewColor(view_, erase_);
    if (tool_ == MaskTool::kBrush) {
      preview.radius_px = radius_px_;
    } else {
      preview.points.push_back(pointer_);
    }
    previews.push_back(std::move(preview));
  }
  view_.setToolPreviews(std::move(previews));
}

bool MaskEditor::pressKey(int key) {
  switch (key) {
    case Qt::Key_Return:
    case Qt::Key_Enter:
      closePolygon();
      return true;
    case Qt::Key_Backspace:
      if (!points_.empty()) points_.pop_back();
      showPreview();
      return true;
    default:
      return false;
  }
}

void MaskEditor::cancelGesture() {
  points_.clear();
  showPreview();
}

void MaskEditor::loseButton() {
  if (tool_ == MaskTool::kBrush) cancelGesture();
}

void MaskEditor::escape() { points_.empty() ? leave() : cancelGesture(); }

bool MaskEditor::eventFilter(QObject* watched, QEvent* event) {
  if (tool_ != MaskTool::kNone && event->type() == QEvent::KeyPress &&
      pressKey(static_cast<QKeyEvent*>(event)->key()))
    return true;
  return CanvasTool::eventFilter(watched, event);
}

}  // namespace boresight::ui
