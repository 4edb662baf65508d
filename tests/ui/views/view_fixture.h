// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>
#include <QPointF>

#include "ui/views/image_view.h"

namespace boresight::test {

inline void hideLayers(ui::ImageView& view) {
  for (int i = 0; i < ui::kLayerCount; ++i)
    view.setStyle(static_cast<ui::LayerId>(i), {false, Qt::red, 1.0});
}

/// Sets the scale and keeps the pixel at a place of the widget there.
inline void zoomAt(ui::ImageView& view, const QPointF& place, double scale) {
  ui::ViewTransform transform = view.transform();
  transform.zoomAt(place, scale);
  view.setTransform(transform);
}

}  // namespace boresight::test
