// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>
#include <QSizeF>

class QPainter;

namespace boresight::ui {

inline constexpr QColor kLoupeCrossColor(255, 255, 255, 210);

/// The cross hairs of a loupe of this size, open about its middle, readable on dark and light.
/// Leaves no brush behind.
void paintLoupeCross(QPainter& painter, const QSizeF& loupe);

}  // namespace boresight::ui
