// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"

namespace boresight::sessions {

/// Cuts a polygon into triangles of its own corners, same winding, and appends them: ears are
/// clipped in the plane of its area vector, so concave polygons come out right; n corners give
/// n - 2 triangles. False when it crosses itself or has no area: then a fan is appended instead.
/// `corners` are indices into `vertices`, all in range, at least three.
bool triangulatePolygon(const std::vector<Eigen::Vector3f>& vertices,
                        std::span<const std::int32_t> corners, std::vector<Face>& triangles);

}  // namespace boresight::sessions
