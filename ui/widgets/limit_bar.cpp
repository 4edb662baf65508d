// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/limit_bar.h"

#include <algorithm>

#include <QPainter>

#include "ui/style/theme.h"

namespace boresight::ui {

void LimitBar::setFigure(double value, double limit, bool passed) {
  value_ = value;
  limit_ = limit;
  passed_ = passed;
  update();
}

void LimitBar::clear() { setFigure(0.0, 0.0, false); }

void LimitBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF track(0, (height() - 6) / 2.0, width(), 6);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(theme().line));
  painter.drawRoundedRect(track, 3, 3);
  if (limit_ <= 0.0) return;
  const double end = std::max(value_, 2.0 * limit_);
  QRectF bar = track;
  bar.setWidth(track.width() * std::clamp(value_ / end, 0.0, 1.0));
  painter.setBrush(QColor(passed_ ? theme().success : theme().failure));
  painter.drawRoundedRect(bar, 3, 3);
  const double tick = track.width() * limit_ / end;
  painter.fillRect(QRectF(tick - 1, 0, 2, height()), QColor(theme().text));
}

}  // namespace boresight::ui
