// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>

namespace boresight::ui {

/// A colour of viridis (Smith and van der Walt 2015) for a value in [0, 1]: equal steps look equal,
/// also to people who confuse red and green, and in gray.
QRgb heatColor(double value);

}  // namespace boresight::ui
