// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "sessions/io/meshes/mesh_file.h"

namespace boresight::sessions {

/// Merges vertices that lie within `weldTolerance` (per axis) of an earlier one, and leaves out
/// vertices that no face uses and faces with two corners that became one; `info` counts all of
/// them. Vertices and faces keep the order of their first appearance. Formats such as STL repeat a
/// vertex in every face, and single precision may round the copies differently. Indices must be in
/// range and coordinates finite.
void weldMesh(Mesh& mesh);

/// Two steps of single precision at the largest coordinate: 2.4e-7 of it, e.g. 0.1 um in 0.4 m.
float weldTolerance(const std::vector<Eigen::Vector3f>& vertices);

/// Cuts a polygon into triangles of its own corners, same winding, and appends them: ears are
/// clipped in the plane of its area vector, so that concave polygons are cut correctly; n corners
/// give n - 2 triangles. False when it crosses itself or has no area: then a fan is appended
/// instead. `corners` are indices into `vertices`, all in range, at least three.
bool triangulatePolygon(const std::vector<Eigen::Vector3f>& vertices,
                        std::span<const std::int32_t> corners, std::vector<Face>& triangles);

}  // namespace boresight::sessions
