// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/edges/directed_edges.h"
#include "core/search/search_problem.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {

/// The search of a case.
inline SearchProblem searchOf(const Case& scene) {
  const LocalizationProblem problem = scene.problem();
  return {problem.image,
          problem.color,
          problem.ignore,
          problem.camera,
          problem.mesh,
          matchedBounds(problem.mesh),
          problem.camera_from_station_seed,
          problem.uncertainty};
}

/// Edge directions of a render in an image of this size.
inline std::vector<std::uint8_t> directionsOf(const EdgeRender& render, int width, int height) {
  std::vector<std::uint8_t> direction(static_cast<std::size_t>(width * height),
                                      DirectedEdges::kNone);
  for (const EdgePixel& pixel : render.eachPixel())
    direction[static_cast<std::size_t>(pixel.y * width + pixel.x)] =
        static_cast<std::uint8_t>(edgeDirectionOf(pixel.normal_x, pixel.normal_y));
  return direction;
}

}  // namespace boresight::test
