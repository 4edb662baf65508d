// SPDX-License-Identifier: Apache-2.0
// The covariance of a CAHV camera's vectors, as .cahvor files and camera.json state it.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

class JsonReader;
struct CalibrationSigma;

/// Of the vectors C A H V, of CAHVOR and CAHVORE also O R, of CAHVORE also E, in this order (m and
/// px), in the frame of the vectors: 12 x 12, 18 x 18 or 21 x 21.
struct CameraCovariance {
  Eigen::MatrixXd of_vectors;

  bool operator==(const CameraCovariance& other) const {
    return of_vectors.rows() == other.of_vectors.rows() && of_vectors == other.of_vectors;
  }
};

/// Number of components of a model's vectors: 12, 18 or 21; 0 outside the CAHV family.
int vectorComponents(CameraModel model);

/// The covariance where the vectors are given in frame a; R and E are the same in every frame.
CameraCovariance inFrame(const CameraCovariance& in_b, const Pose& a_from_b);
/// The covariance for a part of the image: H and V are (H + shift A) / scale.
CameraCovariance ofSubframe(const CameraCovariance& whole, double shift_h_px, double shift_v_px,
                            double scale);

/// Reads a square matrix as rows. InputError.
CameraCovariance readCameraCovariance(const JsonReader& json, CameraModel model);
nlohmann::ordered_json toJson(const CameraCovariance& covariance);

/// A camera with one component of its vectors displaced, and the pose of its frame relative to the
/// undisplaced camera's, which stays fixed in the vectors' frame.
struct DisplacedCamera {
  Camera camera;
  Pose displaced_from_camera;
};
struct VectorStep {
  DisplacedCamera before, after;
  double width = 0.0;  ///< of the component between both
};
/// One per component, for central differences. Empty outside the CAHV family, or where a displaced
/// camera cannot project.
std::vector<VectorStep> vectorSteps(const Camera& camera);

/// One sigma of focal length and principal point that follows from the covariance (in the camera's
/// own frame).
CalibrationSigma calibrationSigmaOf(const Camera& camera, const CameraCovariance& covariance);

}  // namespace boresight::sessions
