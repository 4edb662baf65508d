// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/geometry/pose.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {

/// Any turn about a line leaves the station as it is.
struct AxisSymmetry {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    ///< unit length, station frame
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< on the line, station frame
};

/// Which other poses of a station look the same. Each transform is station_from_station.
struct Symmetries {
  std::vector<Pose> discrete;  ///< without the identity
  std::vector<AxisSymmetry> continuous;

  bool empty() const { return discrete.empty() && continuous.empty(); }
};

/// `axis` (of any length, station frame) and, under `point_key`, a point on it; InputError.
AxisSymmetry readAxisSymmetry(const JsonReader& json, const char* point_key,
                              double units_per_metre);

/// `symmetries_discrete` (16 numbers each, row by row) and `symmetries_continuous` (axis, offset)
/// of an entry of BOP's models_info.json, millimetres. InputError.
Symmetries readBopSymmetries(const JsonReader& model);

/// The turn by `angle_rad` about a symmetry's line.
Pose turnAbout(const AxisSymmetry& symmetry, double angle_rad);

}  // namespace boresight::sessions
