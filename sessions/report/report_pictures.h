// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

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

/// Where the pose predicts something, and how far from there it was seen.
struct ReportResidual {
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();  ///< seen minus predicted
  bool used = false;  ///< the pose rests on it; else it was set aside
};

struct ReportResiduals {
  const char* of = "";  ///< "edge places of the refinement", "matched templates", "marks"
  std::vector<ReportResidual> all;

  double rms_px() const;  ///< over those that are used, root of the mean squared norm
};

/// Of what the pose rests on last: edges of the refinement, else templates, else marks.
ReportResiduals reportResiduals(const PoseReport& report);

}  // namespace boresight::sessions
