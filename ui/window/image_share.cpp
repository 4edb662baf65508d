// SPDX-License-Identifier: Apache-2.0
#include "ui/window/image_share.h"

#include <QtWidgets>

#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/main_window.h"

namespace boresight::ui {

double imageShare(MainWindow& window) {
  ImageView& view = window.image().view();
  if (!view.isVisible() || !window.state().currentCase()) return 0.0;
  const auto& image = window.state().currentCase()->image;
  const QPointF first = view.transform().toWidget({-0.5, -0.5});
  const QPointF last = view.transform().toWidget({image.width - 0.5, image.height - 0.5});
  const QRectF shown = QRectF(first, last).intersected(QRectF(view.rect()));
  return shown.width() * shown.height() / (1.0 * window.width() * window.height());
}

}  // namespace boresight::ui
