// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/annotate/levels_histogram.h"

#include <algorithm>
#include <cmath>

#include <QtWidgets>

#include "ui/style/theme.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

constexpr double kSide = 8.0;     ///< left and right of the bars
constexpr double kBottom = 14.0;  ///< of the handles
constexpr double kHandle = 6.0;

}  // namespace

LevelsHistogram::LevelsHistogram(DisplayImage& display) : display_(display) {
  setObjectName(QStringLiteral("histogram"));
  setMinimumHeight(72);
  setToolTip(
      tr("Drag the handles: levels below the first are shown black, levels above the second white. "
         "Display only: runs do not change."));
  setAccessibleName(tr("Histogram of the gray levels"));
  const auto follow = [this] {
    setEnabled(display_.samples() && !display_.showsCore());
    update();
  };
  connect(&display_, &DisplayImage::levelsChanged, this, follow);
  follow();
}

int LevelsHistogram::largest() const {
  return display_.samples() ? fullLevels(*display_.samples()).white : 255;
}

double LevelsHistogram::xOf(int level) const {
  return kSide + (width() - 2.0 * kSide) * level / largest();
}

int LevelsHistogram::levelAt(double x) const {
  const double share = (x - kSide) / std::max(1.0, width() - 2.0 * kSide);
  return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * largest()));
}

void LevelsHistogram::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF area(kSide, 2.0, width() - 2.0 * kSide, height() - kBottom - 2.0);
  painter.fillRect(area, QColor(theme().alt));
  const std::vector<int>& counts = display_.histogram();
  if (counts.empty()) return;
  // Few bins hold most pixels; the root lets the others be seen.
  const double most = std::sqrt(std::max(1, *std::max_element(counts.begin(), counts.end())));
  const double bin = area.width() / static_cast<double>(counts.size());
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(theme().text2));
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double high = area.height() * std::sqrt(counts[i]) / most;
    painter.drawRect(QRectF(area.left() + static_cast<double>(i) * bin, area.bottom() - high,
                            std::max(bin, 1.0), high));
  }
  for (const bool black : {true, false}) {
    const double x = xOf(black ? display_.levels().black : display_.levels().white);
    painter.setPen(QPen(QColor(theme().accent), 1.5));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setBrush(black ? Qt::black : Qt::white);
    painter.drawPolygon(
        QPolygonF({QPointF(x, area.bottom() + 1.0), QPointF(x + kHandle, height() - 2.0),
                   QPointF(x - kHandle, height() - 2.0)}));
  }
}

void LevelsHistogram::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  const double x = event->pos().x();
  const double to_black = std::abs(x - xOf(display_.levels().black));
  const double to_white = std::abs(x - xOf(display_.levels().white));
  dragged_ = to_black <= to_white ? Handle::kBlack : Handle::kWhite;
  drag(x);
}

void LevelsHistogram::mouseMoveEvent(QMouseEvent* event) { drag(event->pos().x()); }

void LevelsHistogram::mouseReleaseEvent(QMouseEvent*) { dragged_ = Handle::kNone; }

void LevelsHistogram::drag(double x) {
  sessions::GrayLevels levels = display_.levels();
  if (dragged_ == Handle::kNone) return;
  if (dragged_ == Handle::kBlack)
    levels.black = std::min(levelAt(x), levels.white - 1);
  else
    levels.white = std::max(levelAt(x), levels.black + 1);
  display_.setLevels(levels);
}

}  // namespace boresight::ui
