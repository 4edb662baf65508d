// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/edges/directed_edges.h"
#include "core/geometry/pose.h"
#include "core/geometry/surface_axes.h"

namespace boresight {

// The mirror image of a mesh shows in a view what the mesh itself shows in the view flipped
// left-right. The flipped view and an unmirrored mesh therefore tell how well the mirror image
// explains the image.

/// The edges flipped left-right, with the directions of their normals.
void flipLeftRight(DirectedEdges& edges);

/// Poses of the mesh in the flipped view that show its mirror images in place of a pose in the view:
/// mirrored across each of the surface's principal planes, and through its middle.
std::array<Pose, 4> mirroredPoses(const Pose& view_from_station, const SurfaceAxes& surface);

}  // namespace boresight
