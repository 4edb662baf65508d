// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/search/search_problem.h"

namespace boresight {

/// The search for the mesh's mirror image at a pose of the mesh: the mesh in the flipped image,
/// turned by any angle about the line of sight. A mesh that was mirrored by mistake explains a part
/// of the image; its mirror image then explains much more.
SearchProblem mirrorSearch(const SearchProblem& problem, const Pose& camera_from_station);

}  // namespace boresight
