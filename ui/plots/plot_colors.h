// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>
#include <QPalette>

namespace boresight::ui {

/// The palette with a background tinted towards a colour; the text stays readable.
QPalette tinted(const QPalette& base, const QColor& towards);

/// Colours for red-green colour blindness (Okabe and Ito 2008), in a lighter variant on a dark
/// background. Shapes and lines differ, too.
struct PlotColors {
  QColor first;   ///< blue
  QColor second;  ///< orange
  QColor grid;
  QColor cursor;
};

/// A colour of viridis (Smith and van der Walt 2015) for a value in [0, 1], clamped. Equal steps
/// look equal, also to colour-blind readers and in gray.
QColor heatColor(double value);

bool isDark(const QPalette& palette);
PlotColors plotColors(const QPalette& palette);

}  // namespace boresight::ui
