// SPDX-License-Identifier: Apache-2.0
// Text and tables of a run.
#pragma once

#include <string>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// One line per iteration: kind, level, templates, matches, inliers, threshold, correction, rms.
std::string iterationTable(const LocalizationTrace& trace);

/// The pose as rotation vector (deg), quaternion (wxyz, w >= 0) and matrix, with its centre in m. A
/// covariance that is not zero adds one sigma per axis, at the camera, the rig's origin (a `name`
/// that begins with "rig"), or `place`. `name` heads it.
std::string poseText(const Pose& pose, const Matrix6d& covariance,
                     const std::string& name = "camera_from_station",
                     const std::string& place = "");

/// Why a run failed: the values measured and needed, and what to try. One sentence or two; empty
/// for a run that converged.
std::string explanation(const LocalizationTrace& trace);

/// High-water mark of memory by stage, compared with the limit if there is one.
std::string memoryTable(const LocalizationTrace& trace);

/// Status of a run for a line that is always in view: how it ended with the evidence for the pose,
/// why it failed (explanation()), or its current stage. Whole sentences; the first one states that
/// a run is replayed.
std::string runStatusText(const LocalizationTrace& trace);

}  // namespace boresight::sessions
