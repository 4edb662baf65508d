// SPDX-License-Identifier: Apache-2.0
// Names of what is drawn, in a corner of the picture.
#pragma once

#include <vector>

#include <QColor>
#include <QString>

#include "ui/views/layer.h"

QT_BEGIN_NAMESPACE
class QPainter;
QT_END_NAMESPACE

namespace boresight::ui {

/// What a layer is called while it shows something.
struct LegendLine {
  LayerId layer = LayerId::kTestEdges;
  QString name;

  bool operator==(const LegendLine&) const = default;
};

struct LegendEntry {
  QColor color;
  QString name;
};

/// In the upper left corner, on a dark ground of its own; without entries nothing.
void paintLegend(QPainter& painter, const std::vector<LegendEntry>& entries);

}  // namespace boresight::ui
