// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/annotation/annotations.h"

namespace boresight::sessions {

/// Spread of the annotated points of the station (points, and both ends of edges).
struct AnnotatedSpread {
  int places = 0;
  Eigen::Vector3d middle_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_in_station = Eigen::Matrix3d::Identity();  ///< columns, widest first
  Eigen::Vector3d deviation_m = Eigen::Vector3d::Zero();          ///< along these, rms

  bool collinear() const { return deviation_m[1] < 0.02 * deviation_m[0]; }
  bool coplanar() const { return deviation_m[2] < 0.02 * deviation_m[0]; }
};
AnnotatedSpread annotatedSpread(std::span<const AnnotatedView> views);

enum class GeometryWeakness {
  kTooFew,     ///< fewer than six measurements, or four points without a guess
  kFew,        ///< no redundant measurement to check the pose
  kCollinear,  ///< all points on a line
  kCoplanar,   ///< all points in a plane: two poses may explain them
  kClustered,  ///< the annotations cover little of the station's image
  kOneDepth,   ///< all points at one distance from the camera
  kImprecise,  ///< the sigmas of the solved pose exceed the requirement
};

struct GeometryWarning {
  GeometryWeakness weakness = GeometryWeakness::kTooFew;
  bool prevents = false;  ///< a pose cannot be solved
  std::string text;       ///< the weakness and a remedy
};

/// Weaknesses of the enabled annotations, before solving. `guess` (rig_from_station, or nullptr)
/// gives distances and the covered share of the station's image. `station_m`: points that span the
/// station (the corners of its mesh's box), or empty.
std::vector<GeometryWarning> geometryWarnings(std::span<const AnnotatedView> views,
                                              const Pose* guess,
                                              std::span<const Eigen::Vector3d> station_m);

/// Warning of a solved pose of which `sigmas` standard deviations exceed the requirement; `excess`
/// is `sigmaExcessText`.
GeometryWarning imprecisionWarning(double sigmas, const std::string& excess);

}  // namespace boresight::sessions
