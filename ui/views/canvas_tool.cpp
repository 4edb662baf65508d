// SPDX-License-Identifier: Apache-2.0
#include "ui/views/canvas_tool.h"

#include <QKeyEvent>

#include "ui/views/image_view.h"

namespace boresight::ui {

CanvasTool::CanvasTool(ImageView& view, QObject* parent) : QObject(parent), view_(view) {
  view_.installEventFilter(this);
}

CanvasTool::~CanvasTool() = default;

void CanvasTool::claim() { view_.setTool(this); }

void CanvasTool::release() {
  if (view_.tool() == this) view_.setTool(nullptr);
}

bool CanvasTool::eventFilter(QObject* watched, QEvent* event) {
  const bool override = event->type() == QEvent::ShortcutOverride;
  if (view_.tool() != this || !(override || event->type() == QEvent::KeyPress) ||
      static_cast<QKeyEvent*>(event)->key() != Qt::Key_Escape)
    return QObject::eventFilter(watched, event);
  if (override)
    event->accept();  // while a run could be stopped by the same key
  else
    escape();
  return true;
}

}  // namespace boresight::ui
