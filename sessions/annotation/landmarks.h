// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/annotation/annotations.h"

namespace boresight::sessions {

/// A named point of a station that is annotated in image after image.
struct Landmark {
  std::string name;  ///< unique; also the id of its annotations
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  std::string comment;

  bool operator==(const Landmark&) const = default;
};

/// landmarks.json (`boresight-landmarks`, version 1):
///
///     {"format": "boresight-landmarks", "version": 1,
///      "landmarks": [{"name": "left screw", "point_in_station_m": [x, y, z], "comment": "..."}]}
///
/// InputError, also for a name given twice.
std::vector<Landmark> readLandmarks(const std::filesystem::path& file);
/// Reading it back gives the same values. OutputError.
void writeLandmarks(const std::filesystem::path& file, const std::vector<Landmark>& landmarks);

/// The landmarks with every point pair's station side added or replaced under the pair's id; its
/// comment is copied as well.
std::vector<Landmark> withAnnotations(std::vector<Landmark> landmarks,
                                      const Annotations& annotations);

/// "2 lines are left out: landmarks are points."; "" when none is.
std::string leftOutOfLandmarks(const Annotations& annotations);

/// A landmark without an annotation in an image, and its predicted position.
struct Proposal {
  Landmark landmark;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0.0;  ///< of the prediction, larger axis; 0 where no covariance was given
  bool seen = false;      ///< no face of the mesh hides it
};

/// Landmarks without an annotation of their name that project into the image, seen ones first, then
/// by name. `covariance` (camera frame, left perturbation, rotation rad and translation m) may be
/// nullptr.
std::vector<Proposal> proposeAnnotations(const std::vector<Landmark>& landmarks,
                                         const Annotations& annotations, const MeshView& mesh,
                                         const Camera& camera, const Pose& camera_from_station,
                                         const Matrix6d* covariance);

/// The likeliest corner or ellipse centre of the image near a landmark's predicted position: within
/// three sigma, at least 2 and at most 8 px. Empty when there is none, as a prediction is not a
/// measurement.
std::optional<Eigen::Vector2d> featureOf(const Proposal& proposal, const ImageView& image);

}  // namespace boresight::sessions
