// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// A text file of camera calibration (.cahv, .cahvor, .cahvore): vectors in a frame that the file
/// does not name. The centre of the top-left pixel is (0, 0).
struct CahvorFile {
  CahvModel cahv;
  int width = 0;
  int height = 0;
  /// Of the vectors in the order C A H V O R E: 12 x 12, 18 x 18 or 21 x 21; empty when the file
  /// has none.
  Eigen::MatrixXd covariance;
  /// Of Hs Hc Vs Vc Theta (px, px, px, px, rad): 5 x 5, or empty.
  Eigen::MatrixXd internal_covariance;
};

/// Whether the file has one of these extensions.
bool isCahvorFile(const std::filesystem::path& file);

/// InputError with the line's key: a missing or duplicate key, numbers that are not finite or too
/// few, a covariance that is not symmetric or of another size; a last line without its end, which
/// may be cut.
CahvorFile readCahvorFile(const std::filesystem::path& file);
/// The camera of such a file; its reference frame has no name.
CameraFile readCahvorCamera(const std::filesystem::path& file);
/// Reading it back gives the same bits; Hs to Theta follow from the vectors. OutputError.
void writeCahvorFile(const std::filesystem::path& file, const CahvorFile& cahvor);

}  // namespace boresight::sessions
