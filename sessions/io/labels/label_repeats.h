// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {

/// Of the camera model of a VICAR or PDS3 label: what its text states twice, of which GDAL hands on
/// the last alone. One sentence, or nothing.
std::string repeatedInCameraModel(const LabelFiles& files);

}  // namespace boresight::sessions
