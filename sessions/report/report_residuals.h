// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "sessions/report/pose_report.h"

namespace boresight::sessions {

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
