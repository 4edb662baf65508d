// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "sessions/evaluation/posed_image.h"

namespace boresight::sessions {

/// Whether COLMAP has cameras of this model.
bool hasColmapModel(CameraModel model);

/// Writes cameras.txt, images.txt and points3D.txt of a COLMAP text model
/// (colmap.github.io/format.html) into a folder. Cameras are PINHOLE, OPENCV, FULL_OPENCV or
/// OPENCV_FISHEYE, one for all images that share its numbers. Annotated points of several images at
/// the same place of the station are one point. COLMAP's top-left pixel has its centre at (0.5,
/// 0.5): cx and cy are written half a pixel larger. Remarks are comments at the beginning of
/// images.txt. The world frame is the station frame. OutputError, also for a duplicate or not
/// positive id, and a name that is empty or has line breaks.
void writeColmapText(const std::filesystem::path& folder, std::span<const PosedImage> images);

/// Reads cameras and poses of such a model, or of one that COLMAP wrote, also with SIMPLE_PINHOLE,
/// SIMPLE_RADIAL, RADIAL, SIMPLE_FISHEYE, FISHEYE, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE, or a
/// THIN_PRISM_FISHEYE whose tangential and prism terms are 0. Poses and distortion are read back
/// bit by bit, cx and cy to the last bit but one. InputError; for COLMAP's other models its message
/// names a remedy.
std::vector<PosedImage> readColmapText(const std::filesystem::path& folder);

}  // namespace boresight::sessions
