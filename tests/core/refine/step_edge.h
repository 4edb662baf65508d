// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/core/localizer/scene.h"

namespace boresight::test {

/// Area of the unit square centred at `centre` on the side of normal . p > distance: the square's
/// corners, clipped by the line (Sutherland and Hodgman 1974), and the shoelace formula.
inline double areaBeyond(const Eigen::Vector2d& centre, const Eigen::Vector2d& normal,
                         double distance) {
  const Eigen::Vector2d half[] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d from = centre + half[i];
    const Eigen::Vector2d to = centre + half[(i + 1) % 4];
    const double s_from = normal.dot(from) - distance;
    const double s_to = normal.dot(to) - distance;
    if (s_from > 0.0) kept.push_back(from);
    if ((s_from > 0.0) != (s_to > 0.0))
      kept.push_back(from + s_from / (s_from - s_to) * (to - from));
  }
  double twice = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Eigen::Vector2d& a = kept[i];
    const Eigen::Vector2d& b = kept[(i + 1) % kept.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// One step in gray: `contrast` is added where normal . p > distance.
struct StepEdge {
  Eigen::Vector2d normal;
  double distance_px = 0.0;
  double contrast = 0.0;
};

inline Picture drawSteps(int width, int height, double base, const std::vector<StepEdge>& steps) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double gray = base;
      for (const StepEdge& step : steps)
        gray += step.contrast * areaBeyond({x, y}, step.normal, step.distance_px);
      picture.gray.push_back(static_cast<std::uint8_t>(std::clamp(gray + 0.5, 0.0, 255.0)));
    }
  }
  return picture;
}

}  // namespace boresight::test
