// SPDX-License-Identifier: Apache-2.0
#include "ui/views/canvas_chips.h"

#include <algorithm>

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/views/image_view.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kMargin = 8;

QString hex(QRgb color) { return QColor(color).name(); }

/// The overlay is dark in both themes, and is styled here, not by the window.
QString overlaySheet() {
  return QStringLiteral(
             "QFrame#legend, QToolBar#canvasTools, QLabel#titleChip, QLabel#shownChip, "
             "QLabel#zoomChip "
             "{ background: %1; border: 1px "
             "solid %2; border-radius: %3px; color: %4; }"
             "QLabel#titleChip, QLabel#shownChip, QLabel#zoomChip { padding: 3px 8px; }"
             "QLabel#titleChip { font-weight: 600; }"
             "QFrame#legend QToolButton { color: %4; background: transparent; border: none; "
             "padding: 4px 0; min-height: 0; }"
             "QFrame#legend QToolButton:hover { background: rgba(255, 255, 255, 24); }"
             "QToolBar#canvasTools { spacing: 2px; padding: 2px; }"
             "QToolBar#canvasTools QToolButton { border: none; background: transparent; padding: "
             "4px; min-width: 0; min-height: 0; border-radius: %3px; }"
             "QToolBar#canvasTools QToolButton:hover { background: rgba(255, 255, 255, 32); }"
             "QToolBar#canvasTools QToolButton:checked { background: %5; }"
             "QToolBar#canvasTools::separator { background: %2; height: 1px; margin: 3px; }")
      .arg(hex(kDarkTheme.overlay), hex(kDarkTheme.overlay_line))
      .arg(kRadius)
      .arg(hex(kOverlayText), hex(kLightTheme.accent));
}

}  // namespace

CanvasChips::CanvasChips(ImageView& view)
    : QObject(&view),
      view_(view),
      tools_(named(new QToolBar(&view), "canvasTools")),
      title_(chip("titleChip")),
      shown_(chip("shownChip")),
      zoom_(chip("zoomChip")) {
  view.setStyleSheet(overlaySheet());
  tools_->setOrientation(Qt::Vertical);
  tools_->setIconSize({kToolIcon, kToolIcon});
  tools_->setMovable(false);
  title_->hide();
  shown_->hide();
  view.installEventFilter(this);
  connect(&view, &ImageView::transformChanged, this, &CanvasChips::showZoom);
  showZoom();
}

QLabel* CanvasChips::chip(const char* name) {
  auto* label = named(new QLabel(&view_), name);
  label->setAttribute(Qt::WA_TransparentForMouseEvents);
  return label;
}

void CanvasChips::setTitle(const QString& text) {
  title_text_ = text;
  title_->setVisible(!text.isEmpty());
  arrange();
}

void CanvasChips::setShown(const QString& text) {
  shown_->setText(text);
  shown_->setVisible(!text.isEmpty());
  arrange();
}

void CanvasChips::setLegend(QWidget* legend) {
  legend_ = legend;
  arrange();
}

void CanvasChips::showZoom() {
  const double percent = 100.0 * view_.transform().scale() * view_.devicePixelRatioF();
  const QSize size = view_.imageSize();
  zoom_->setVisible(!size.isEmpty());
  zoom_->setText(tr("%1 %   %2 %3 %4 px")
                     .arg(percent, 0, 'f', percent < 10.0 ? 1 : 0)
                     .arg(size.width())
                     .arg(QChar(0xD7))
                     .arg(size.height()));
  arrange();
}

void CanvasChips::arrange() {
  // Where the view is too low, the strip itself offers what has no room.
  const int most = std::max(tools_->iconSize().height(), view_.height() - 2 * kMargin);
  tools_->resize(tools_->sizeHint().boundedTo({tools_->sizeHint().width(), most}));
  tools_->move(kMargin, kMargin);
  for (QLabel* label : {shown_, zoom_}) label->adjustSize();
  const int right = view_.width() - kMargin;
  shown_->move(right - shown_->width(), kMargin);
  placeTitle();
  zoom_->move(right - zoom_->width(), view_.height() - kMargin - zoom_->height());
  if (!legend_) return;
  legend_->move(kMargin, view_.height() - kMargin - legend_->height());
  legend_->setVisible(legend_->y() > tools_->geometry().bottom());  // a small view has the panel
}

/// Between the tools and what is shown.
void CanvasChips::placeTitle() {
  const int left = tools_->geometry().right() + kMargin;
  const int right = shown_->isHidden() ? view_.width() : shown_->x();
  title_->setText(title_text_);
  title_->adjustSize();
  const int excess = title_->width() - (right - kMargin - left);
  if (excess > 0) {
    const int room = title_->fontMetrics().horizontalAdvance(title_text_) - excess;
    title_->setText(title_->fontMetrics().elidedText(title_text_, Qt::ElideRight, room));
    title_->adjustSize();
  }
  title_->setToolTip(excess > 0 ? title_text_ : QString());
  title_->setAttribute(Qt::WA_TransparentForMouseEvents, excess <= 0);  // a tip needs the pointer
  title_->move(left, kMargin);
}

bool CanvasChips::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize || event->type() == QEvent::Show) arrange();
  return QObject::eventFilter(watched, event);
}

}  // namespace boresight::ui
