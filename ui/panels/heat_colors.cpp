// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/heat_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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

QRgb heatColor(double value) {
  const double place = std::clamp(value, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double share = place - static_cast<double>(below);
  const Color& a = kStops[below];
  const Color& b = kStops[below + 1];
  const auto mixed = [share](double from, double to) {
    return static_cast<int>(std::lround(from + share * (to - from)));
  };
  return qRgb(mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue));
}

}  // namespace boresight::ui
