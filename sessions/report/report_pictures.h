// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/report/pose_report.h"
#include "sessions/run/overlay.h"

namespace boresight::sessions {

/// A part of the image, and where it lies in it.
struct ReportPicture {
  ColorImage image;
  int left_px = 0;  ///< of the image's pixels
  int top_px = 0;
};

/// The station's surroundings, with the edges of the seed in red and of the pose in green.
ReportPicture overlayPicture(const PoseReport& report);
/// The same place in pale gray, to draw residuals on.
ReportPicture palePicture(const PoseReport& report);

}  // namespace boresight::sessions
