// SPDX-License-Identifier: Apache-2.0
#include "ui/style/icons.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>

#include <QIconEngine>
#include <QPainter>
#include <QPainterPath>

namespace boresight::ui {
namespace {

/// In the order of `Icon`. M, L: to a point; Z: closes; O: a circle by its centre and radius.
constexpr const char* kPaths[] = {
    "",
    "M 3 8.5 L 6.5 12 L 13 4.5",
    "M 4 4 L 12 12 M 12 4 L 4 12",
    "M 8 2.5 L 14 13 L 2 13 Z M 8 6.5 L 8 9.5 M 8 11 L 8 11.4",
    "O 8 8 6 M 8 7.3 L 8 11 M 8 5 L 8 5.4",
    "O 8 8 6 M 8 4.8 L 8 8 L 10.5 9.5",
    "O 8 8 5.5",
    "O 8 8 1.6",
    "M 5 3.5 L 12.5 8 L 5 12.5 Z",
    "M 4.5 4.5 L 11.5 4.5 L 11.5 11.5 L 4.5 11.5 Z",
    "M 4 3.5 L 9.5 8 L 4 12.5 Z M 12 3.5 L 12 12.5",
    "M 2.5 4 L 7 8 L 2.5 12 Z M 7.5 4 L 12 8 L 7.5 12 Z M 13.5 4 L 13.5 12",
    "M 3 8 L 3.4 5.8 L 5 3.9 L 7.5 3 L 10 3.4 L 12 5 L 13 7.5 L 12.6 10 L 11 12 L 8.5 13 L 6 12.6 "
    "M 3 3.5 L 3 8 L 7 8",
    "O 7 7 4.2 M 10.2 10.2 L 13.5 13.5",
    "M 8 2 L 8 14 M 2 8 L 14 8 M 6 4 L 8 2 L 10 4 M 6 12 L 8 14 L 10 12 M 4 6 L 2 8 L 4 10 "
    "M 12 6 L 14 8 L 12 10",
    "M 3 3 L 13 3 L 13 13 L 3 13 Z M 3 8 L 8 3 M 3 13 L 13 3 M 8 13 L 13 8",
    "M 3 13 L 3.8 9.8 L 10.8 2.8 L 13.2 5.2 L 6.2 12.2 Z",
    "M 8 2 L 13 4 L 13 8 L 11.5 11 L 8 13.8 L 4.5 11 L 3 8 L 3 4 Z M 5.8 7.8 L 7.5 9.5 L 10.4 6",
    "M 8 3 L 8 13 M 3 8 L 13 8",
    "M 2.5 3.5 L 13.5 3.5 L 9.3 8.5 L 9.3 13 L 6.7 11.6 L 6.7 8.5 Z",
    "M 2 4 L 6.5 4 L 8 5.8 L 14 5.8 L 14 13 L 2 13 Z",
    "M 3 4.5 L 13 4.5 M 6 4.5 L 6 2.8 L 10 2.8 L 10 4.5 M 4.2 4.5 L 4.8 13.5 L 11.2 13.5 L 11.8 "
    "4.5",
    "M 2.5 3 L 13.5 3 L 13.5 13 L 2.5 13 Z O 6 6.3 1.2 M 2.5 12 L 7 8.8 L 9 10.4 L 11 8.4 L 13.5 "
    "10.6",
    "M 2 5 L 5 5 L 6.2 3.3 L 9.8 3.3 L 11 5 L 14 5 L 14 12.7 L 2 12.7 Z O 8 8.7 2.4",
    "M 8 2 L 13.2 5 L 13.2 11 L 8 14 L 2.8 11 L 2.8 5 Z M 2.8 5 L 8 8 L 13.2 5 M 8 8 L 8 14",
    "O 8 8 4.6 M 8 1.5 L 8 5 M 8 11 L 8 14.5 M 1.5 8 L 5 8 M 11 8 L 14.5 8",
    "O 8 8 5.5 M 8 2.5 L 8 13.5 M 9.5 3 L 9.5 13 M 11 3.8 L 11 12.2 M 12.4 5.3 L 12.4 10.7",
    "O 8 8 6 M 6.2 6.4 L 6.8 5.2 L 8.2 4.8 L 9.6 5.4 L 9.8 6.8 L 8 8.4 L 8 9.4 M 8 11.2 L 8 11.5",
    "M 4 14 L 4 2.5 L 12.5 2.5 L 10.5 5.5 L 12.5 8.5 L 4 8.5",
    "M 6 3.5 L 10.5 8 L 6 12.5",
    "M 2 3 L 14 3 L 14 13 L 2 13 Z M 9.5 3 L 9.5 13",
    "M 2.5 5.5 L 2.5 2.5 L 5.5 2.5 M 10.5 2.5 L 13.5 2.5 L 13.5 5.5 M 13.5 10.5 L 13.5 13.5 "
    "L 10.5 13.5 M 5.5 13.5 L 2.5 13.5 L 2.5 10.5 M 5.5 5.5 L 10.5 5.5 L 10.5 10.5 L 5.5 10.5 Z",
    "M 3 5 L 4.5 4 L 4.5 12 M 8 6 L 8 6.4 M 8 10 L 8 10.4 M 11 5 L 12.5 4 L 12.5 12",
    "M 2.5 10.5 L 10.5 2.5 L 13.5 5.5 L 5.5 13.5 Z M 5 8 L 6.5 9.5 M 7 6 L 8 7 M 9 4 L 10.5 5.5",
    "M 1.5 8 L 4 5 L 8 3.5 L 12 5 L 14.5 8 L 12 11 L 8 12.5 L 4 11 Z O 8 8 2",
    "M 2.5 3 L 13.5 3 L 13.5 13 L 2.5 13 Z M 8 1.5 L 8 14.5 M 10.5 6 L 12 8 L 10.5 10 M 5.5 6 L 4 "
    "8 "
    "L 5.5 10",
    "M 8 2.5 L 14 5.5 L 8 8.5 L 2 5.5 Z M 2 8.2 L 8 11.2 L 14 8.2 M 2 10.8 L 8 13.8 L 14 10.8",
    "M 2 3 L 7 3 L 7 13 L 2 13 Z M 9 3 L 14 3 L 14 13 L 9 13 Z",
    "M 4.5 4.5 L 11.5 4.5 L 11.5 11.5 L 4.5 11.5 Z M 6.5 2 L 6.5 4.5 M 9.5 2 L 9.5 4.5 M 6.5 11.5 "
    "L 6.5 14 M 9.5 11.5 L 9.5 14 M 2 6.5 L 4.5 6.5 M 2 9.5 L 4.5 9.5 M 11.5 6.5 L 14 6.5 "
    "M 11.5 9.5 L 14 9.5",
    "M 3 5.5 L 10.5 5.5 L 10.5 13 L 3 13 Z M 6 5.5 L 6 2.5 L 13.5 2.5 L 13.5 10 L 10.5 10",
};
static_assert(std::size(kPaths) == static_cast<std::size_t>(Icon::kFloat) + 1);

QPainterPath pathOf(const char* text) {
  QPainterPath path;
  std::istringstream words(text);
  for (std::string command; words >> command;) {
    double x = 0.0;
    double y = 0.0;
    if (command != "Z") words >> x >> y;
    if (command == "Z") path.closeSubpath();
    if (command == "M") path.moveTo(x, y);
    if (command == "L") path.lineTo(x, y);
    if (command == "O") {
      double radius = 0.0;
      words >> radius;
      path.addEllipse(QPointF(x, y), radius, radius);
    }
  }
  return path;
}

/// Drawn when it is shown, so that it is sharp on every screen and follows the theme.
class LineIcon final : public QIconEngine {
 public:
  /// Without a member of the theme: as on the overlay.
  LineIcon(Icon icon, QRgb Theme::*color) : icon_(icon), color_(color) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
    const QRgb enabled = color_ ? theme().*color_ : kOverlayText;
    paintIcon(*painter, rect, icon_, QColor(mode == QIcon::Disabled ? theme().text3 : enabled));
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    paint(&painter, QRect(QPoint(), size), mode, state);
    return pixmap;
  }
  QIconEngine* clone() const override { return new LineIcon(icon_, color_); }

 private:
  Icon icon_;
  QRgb Theme::*color_;
};

}  // namespace

QIcon iconOf(Icon icon, QRgb Theme::*color) {
  return icon == Icon::kNone ? QIcon() : QIcon(new LineIcon(icon, color));
}

QIcon pictureIcon(const QImage& picture) {
  const QPixmap pixmap = QPixmap::fromImage(picture);
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);
  return icon;
}

QIcon overlayIcon(Icon icon) { return QIcon(new LineIcon(icon, nullptr)); }

void paintIcon(QPainter& painter, const QRectF& place, Icon icon, const QColor& color) {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  const double side = std::min(place.width(), place.height());
  painter.translate(place.center() - QPointF(side, side) / 2.0);
  painter.scale(side / 16.0, side / 16.0);
  painter.setPen(QPen(color, kIconStroke, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.setBrush(Qt::NoBrush);
  painter.drawPath(pathOf(kPaths[static_cast<std::size_t>(icon)]));
  painter.restore();
}

}  // namespace boresight::ui
