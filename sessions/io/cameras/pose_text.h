// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Forms of a pose as text, for operators and other programs.
enum class PoseForm { kRotationVector, kQuaternion, kMatrix };

/// The unit quaternion with w >= 0 (at half turns, with the first nonzero of x, y, z positive).
Eigen::Quaterniond shownQuaternion(const Eigen::Quaterniond& rotation);

/// The pose in one form, with names that state its direction, order and units, exact enough to be
/// read back to 1e-12. A matrix is 4x4, row-major, metres, as in pose files; the others give mm.
std::string poseText(const Pose& camera_from_station, PoseForm form);

/// Meaning of the numbers of a text; chosen by the operator, as texts do not state all of it.
struct PoseReading {
  bool station_from_camera = false;  ///< else camera_from_station
  bool column_major = false;         ///< else row-major
  bool xyzw = false;                 ///< order of a quaternion; else wxyz
  bool millimetres = false;          ///< else metres
};

/// Meaning indicated by the text itself (names, a last row of 0 0 0 1): the default of a dialog.
PoseReading guessReading(std::string_view text);

/// Result of reading a text.
struct ParsedPose {
  bool valid = false;
  Pose camera_from_station;
  PoseForm form = PoseForm::kMatrix;  ///< of the text, by the count of its numbers
  double rotation_deviation = 0.0;    ///< |R'R - I| before it was projected to a rotation
  std::string problem;                ///< one sentence, when not valid
};

/// Reads 16 or 12 numbers (a matrix, with or without its last row), 7 (quaternion, then
/// translation) or 6 (rotation vector in deg, then translation); words, brackets, commas and
/// semicolons between them, marks of a YAML list, and numbers that belong to a name (p1), are
/// ignored. Rejects a matrix
/// that is not a rotation within 1e-4, a last row other than 0 0 0 1, and a quaternion whose length
/// is not 1 to 1e-4.
ParsedPose parsePose(std::string_view text, const PoseReading& reading);

}  // namespace boresight::sessions
