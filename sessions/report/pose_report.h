// SPDX-License-Identifier: Apache-2.0
// Report of a pose: two PDF pages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sessions/review/validated_pose_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"
#include "sessions/trace/overlay.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

struct PoseReport {
  const Session* session = nullptr;
  HandedPose pose;  ///< with its checks, as judged or current
  std::shared_ptr<const LoadedCase> loaded;
  std::optional<LocalizationTrace> trace;  ///< of the pose's run; empty for a pose from annotations
};

/// The data to report of a case: its pose, measured again (checkedPose), its image and its run.
/// InputError.
PoseReport poseReport(const Session& session, const std::string& case_id);

/// The PDF: overlay, pose, end effector, inputs and decision on the first page, checks, residuals
/// and the run's course on the second. Every page states who validated the pose, or that it is not
/// validated.
std::vector<std::uint8_t> poseReportPdf(const PoseReport& report);

/// The same into a file, atomically; OutputError.
void writePoseReport(const std::filesystem::path& file, const PoseReport& report);

/// A part of the image, with its position in the image.
struct ReportPicture {
  ColorImage image;
  int left_px = 0;  ///< of the image's pixels
  int top_px = 0;
};

/// The station's surroundings, with the edges of the seed in orange and of the pose in blue.
ReportPicture overlayPicture(const PoseReport& report);
/// The same region in pale gray, to draw residuals on.
ReportPicture palePicture(const PoseReport& report);

/// A predicted image position and its residual.
struct ReportResidual {
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();  ///< observed minus predicted
  bool used = false;                                      ///< used for the pose; otherwise rejected
};

struct ReportResiduals {
  const char* of = "";  ///< "edge places of the refinement", "matched templates", "annotations"
  std::vector<ReportResidual> all;

  double rms_px() const;  ///< over those that are used, root of the mean squared norm
};

/// Residuals of the last data used for the pose: edges of the refinement, else templates, else
/// annotations.
ReportResiduals reportResiduals(const PoseReport& report);

}  // namespace boresight::sessions
