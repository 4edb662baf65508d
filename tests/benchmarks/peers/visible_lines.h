// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/benchmarks/peers/peer.h"
#include "tests/benchmarks/peers/wire_model.h"

namespace boresight::peers {

/// Keeps the lines of a model that are seen from a pose: at least two of three places on a line lie
/// inside the image and not behind a face of the model (by more than 1 mm and 1 % of their depth;
/// faces are drawn into a depth image of 640 px).
void keepVisibleLines(const PinholeImage& image, const Pose& camera_from_station, WireModel& model);

}  // namespace boresight::peers
