// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/panel_area.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/style/tokens.h"

namespace boresight::ui {
namespace {

constexpr int kLeastHeight = 160 - kPanelHeadHeight;

}  // namespace

PanelArea::PanelArea(QWidget* panel) {
  setFrameShape(QFrame::NoFrame);
  setFocusPolicy(Qt::NoFocus);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setWidget(panel);
  if (!panel->layout() || panel->property("edgeToEdge").toBool()) return;
  panel->layout()->setContentsMargins(kPanelMargin, kBlockGap, kPanelMargin, kBlockGap);
  panel->layout()->setSpacing(kBlockGap);
}

QSize PanelArea::minimumSizeHint() const {
  const int bar = scrolls_ ? verticalScrollBar()->sizeHint().width() : 0;
  return {leastOfPanel().width() + bar, std::min(leastOfPanel().height(), kLeastHeight)};
}

bool PanelArea::eventFilter(QObject* watched, QEvent* event) {
  const bool done = QScrollArea::eventFilter(watched, event);
  if (watched == widget() && event->type() == QEvent::LayoutRequest) {
    followPanel();
    updateGeometry();
  }
  return done;
}

void PanelArea::resizeEvent(QResizeEvent* event) {
  QScrollArea::resizeEvent(event);
  followPanel();
}

QSize PanelArea::leastOfPanel() const {
  return widget()->minimumSizeHint().expandedTo(widget()->minimumSize());
}

/// With all lines of its texts at this width.
int PanelArea::leastHeight(int width) const {
  const QLayout* layout = widget()->layout();
  const bool wraps = layout && layout->hasHeightForWidth();
  return std::max(leastOfPanel().height(), wraps ? layout->minimumHeightForWidth(width) : 0);
}

/// The panel fills the area, and is never lower than it can be.
void PanelArea::followPanel() {
  const int bar = verticalScrollBar()->sizeHint().width();
  const bool scrolled = std::exchange(scrolls_, height() < leastHeight(width()));
  const int panel_width = width() - (scrolls_ ? bar : 0);
  widget()->resize(panel_width, std::max(height(), leastHeight(panel_width)));
  if (scrolled != scrolls_) updateGeometry();
}

}  // namespace boresight::ui
