// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/edges/directed_edges.h"

namespace boresight {

/// Distances to edges of a direction, in units of kDistanceUnit_px, at most kFarthest.
inline constexpr double kDistanceUnit_px = 0.1;
inline constexpr int kFarthest = 60;         ///< 6 px
inline constexpr int kStepOfDirection = 15;  ///< per step of direction: 1.5 px farther

/// For each pixel the distance to the nearest edge whose normal has `direction`, edges of other
/// directions counting as farther by kStepOfDirection per step: a chamfer transform (Borgefors
/// 1986, 3 x 3 with 10 and 14). Unknown pixels get the mean of the known ones, so that they neither
/// support nor contradict a pose.
void distanceToDirection(const DirectedEdges& edges, int direction,
                         std::span<std::uint8_t> distance);

}  // namespace boresight
