// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

/// The station before a small camera: a run takes a few milliseconds.
inline Case smallCase(std::uint64_t seed) {
  Camera camera = makePinhole(131, 97, 200.0);
  camera.cx = 66.0;
  camera.cy = 47.0;
  static const Picture picture = takePicture(stationMesh(), camera, truthPose());
  return caseOf(stationMesh(), camera, picture, truthPose(), seed);
}

/// Each option stays as it is, or becomes anything in its range; counts stay small.
inline LocalizerOptions randomOptions(Random& random) {
  LocalizerOptions options = random.below(3) == 0 ? paperProfile() : defaultProfile();
  const std::uint32_t stays = 1 + random.below(12);
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    if (random.below(stays + 1) != 0) return;
    const double exponent = random.uniform();
    const double span = std::min(info.maximum, 2000.0 + info.minimum) - info.minimum;
    const double value = info.minimum + span * exponent * exponent * exponent;
    if constexpr (std::is_same_v<Field, double>) {
      field = random.below(8) == 0 ? info.maximum : value;
    } else {
      field = static_cast<Field>(static_cast<std::int64_t>(std::floor(value + 0.5)));
    }
  });
  options.loop.max_iterations = std::min(options.loop.max_iterations, 6);
  // Room for every pixel of the small camera: too little is a fault, and has tests of its own.
  options.render.max_edge_pixels = std::max(options.render.max_edge_pixels, 131 * 97);
  return options;
}

}  // namespace boresight::test
