// SPDX-License-Identifier: Apache-2.0
// Pictures of the algorithm's stages for the manual, drawn without a window.
#pragma once

#include <QImage>

#include "sessions/session/case_run.h"

namespace boresight::ui {

/// Depth, normals and salient edges of the station as the seed has it, side by side.
QImage renderPicture(const sessions::LoadedCase& one);

/// The image and the edges that Canny's detector finds in it, side by side.
QImage edgePicture(const sessions::LoadedCase& one);

/// Part of the image with the edges of the seed, and with those of the result.
QImage beforeAndAfter(const sessions::LoadedCase& one, const Pose& camera_from_station);

}  // namespace boresight::ui
