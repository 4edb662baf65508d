// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/plot_colors.h"

namespace boresight::ui {

QPalette tinted(const QPalette& base, const QColor& towards) {
  const QColor window = base.color(QPalette::Window);
  const auto mixed = [](int a, int b) { return (3 * a + b) / 4; };
  QPalette made = base;
  made.setColor(QPalette::Window,
                QColor(mixed(window.red(), towards.red()), mixed(window.green(), towards.green()),
                       mixed(window.blue(), towards.blue())));
  return made;
}

bool isDark(const QPalette& palette) { return palette.color(QPalette::Base).lightness() < 128; }

PlotColors plotColors(const QPalette& palette) {
  PlotColors colors;
  const bool dark = isDark(palette);
  colors.first = dark ? QColor(86, 180, 233) : QColor(0, 114, 178);
  colors.second = dark ? QColor(230, 159, 0) : QColor(213, 94, 0);
  colors.grid = palette.color(QPalette::Text);
  colors.grid.setAlpha(40);
  colors.cursor = palette.color(QPalette::Text);
  colors.cursor.setAlpha(140);
  return colors;
}

}  // namespace boresight::ui
