// SPDX-License-Identifier: Apache-2.0
#include "ui/views/legend.h"

#include <algorithm>

#include <QFontMetrics>
#include <QPainter>

namespace boresight::ui {
namespace {

constexpr int kMargin_px = 8;
constexpr int kSample_px = 22;  // of a line in the layer's colour

}  // namespace

void paintLegend(QPainter& painter, const std::vector<LegendEntry>& entries) {
  if (entries.empty()) return;
  const QFontMetrics metrics = painter.fontMetrics();
  const int line = metrics.height() + 2;
  int widest = 0;
  for (const LegendEntry& entry : entries)
    widest = std::max(widest, metrics.horizontalAdvance(entry.name));
  const QRect ground(kMargin_px, kMargin_px, widest + kSample_px + 3 * kMargin_px,
                     static_cast<int>(entries.size()) * line + kMargin_px);
  painter.save();
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0, 0, 0, 190));
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.drawRoundedRect(ground, 4.0, 4.0);
  painter.setRenderHint(QPainter::Antialiasing, false);
  int top = ground.top() + kMargin_px / 2;
  for (const LegendEntry& entry : entries) {
    const int left = ground.left() + kMargin_px;
    painter.setPen(QPen(entry.color, 3.0));
    painter.drawLine(left, top + line / 2, left + kSample_px, top + line / 2);
    painter.setPen(QColor(240, 240, 240));
    painter.drawText(QRect(left + kSample_px + kMargin_px, top, widest + 1, line),
                     Qt::AlignLeft | Qt::AlignVCenter, entry.name);
    top += line;
  }
  painter.restore();
}

}  // namespace boresight::ui
