// SPDX-License-Identifier: Apache-2.0
#include "ui/views/measure_tool.h"

#include <QPainter>

#include "ui/state/view_state.h"
#include "ui/style/tokens.h"
#include "ui/views/image_view.h"
#include "ui/views/line_painter.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

constexpr double kTick = 8.0;
constexpr LineToken kRuler = {0xFFFFFF, 1.6, 0, 0, false, 0x000000, 2.0};

}  // namespace

MeasureTool::MeasureTool(ImageView& view, ViewState& state, QObject* parent)
    : CanvasTool(view, parent), state_(state) {
  view_.addOverlay(this, [this](QPainter& painter) { paint(painter); });
  connect(&view_, &ImageView::toolPressed, this, &MeasureTool::press);
  connect(&view_, &ImageView::toolMoved, this, &MeasureTool::moveTo);
  state_.onChange(ViewChange::kCase, this, &MeasureTool::cancelGesture);
  state_.onChange(ViewChange::kCursor | ViewChange::kNudgedPose, this, [this] {
    if (from_) moveTo(to_);  // on the surface of another pose
  });
}

void MeasureTool::setActive(bool active) {
  if (active == active_) return;
  active_ = active;
  active ? claim() : release();
  view_.setToolActive(active);
  cancelGesture();
  Q_EMIT activeChanged(active);
}

void MeasureTool::cancelGesture() {
  from_.reset();
  view_.update();
}

void MeasureTool::press(const QPointF& pixel) {
  if (!active_ || !state_.currentCase()) return;
  from_ = pixel;
  moveTo(pixel);
}

void MeasureTool::moveTo(const QPointF& pixel) {
  const auto& loaded_case = state_.currentCase();
  if (!active_ || !from_ || !loaded_case) return;
  to_ = pixel;
  measured_ = sessions::measureBetween(loaded_case->source.camera, loaded_case->scene.view(),
                                       state_.shownPose(), vectorOf(*from_), vectorOf(to_));
  if (!state_.knownPose()) measured_.surface_m.reset();
  view_.update();
}

QString MeasureTool::text() const {
  if (!from_) return {};
  const QString pixels = tr("%1 px").arg(measured_.image_px, 0, 'f', 1);
  if (!measured_.surface_m) return pixels;
  return tr("%1, %2 mm").arg(pixels).arg(1e3 * *measured_.surface_m, 0, 'f', 2);
}

void MeasureTool::paint(QPainter& painter) const {
  if (!active_ || !from_) return;
  const QPointF from = view_.transform().toWidget(*from_);
  const QPointF to = view_.transform().toWidget(to_);
  painter.setRenderHint(QPainter::Antialiasing, true);
  for (const QPen& pen : {haloPen(kRuler), linePen(kRuler)}) {
    painter.setPen(pen);
    painter.drawLine(from, to);
    for (const QPointF& end : {from, to}) paintTicks(painter, end, 2.0, kTick);
  }
  paintNote(painter, to + QPointF(12.0, 12.0), text());
  painter.setRenderHint(QPainter::Antialiasing, false);
}

}  // namespace boresight::ui
