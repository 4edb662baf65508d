// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/plot_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boresight::ui {

namespace {

struct Color {
  double red, green, blue;
};

/// Nine of viridis' 256 colours, evenly spaced; straight lines in between.
constexpr std::array<Color, 9> kStops = {{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

}  // namespace

QPalette tinted(const QPalette& base, const QColor& towards) {
  const QColor window = base.color(QPalette::Window);
  const auto mixed = [](int a, int b) { return (3 * a + b) / 4; };
  QPalette palette = base;
  palette.setColor(QPalette::Window, QColor(mixed(window.red(), towards.red()),
                                            mixed(window.green(), towards.green()),
                                            mixed(window.blue(), towards.blue())));
  return palette;
}

QColor heatColor(double value) {
  const double place = std::clamp(value, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double share = place - static_cast<double>(below);
  const Color& a = kStops[below];
  const Color& b = kStops[below + 1];
  const auto mixed = [share](double from, double to) {
    return static_cast<int>(std::lround(from + share * (to - from)));
  };
  return QColor(mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue));
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
