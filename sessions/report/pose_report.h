// SPDX-License-Identifier: Apache-2.0
// The report of a pose: two pages of PDF for whoever signs or reads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "sessions/review/handed_pose.h"
#include "sessions/run/trace.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct PoseReport {
  const Session* session = nullptr;
  HandedPose pose;  ///< with its checks, judged or as they are now
  std::shared_ptr<const LoadedCase> loaded;
  std::optional<LocalizationTrace> trace;  ///< of the pose's run; none of a pose from marks
};

/// What there is to report of a case: its pose, measured again (checkedPose), its image and its
/// run. InputError.
PoseReport poseReport(const Session& session, const std::string& case_id);

/// The PDF: overlay, pose, end effector, inputs and decision on the first page, checks, residuals
/// and the run's course on the second. Every page says who validated the pose, or that nobody has.
std::vector<std::uint8_t> poseReportPdf(const PoseReport& report);

/// The same into a file, atomically; OutputError.
void writePoseReport(const std::filesystem::path& file, const PoseReport& report);

}  // namespace boresight::sessions
