// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// A rotational symmetry: the station looks the same after any rotation about a line.
struct AxisSymmetry {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    ///< unit length, station frame
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< on the line, station frame

  bool operator==(const AxisSymmetry&) const = default;
};

/// Symmetries of a station: transforms station_from_station after which it looks the same.
struct Symmetries {
  std::vector<Pose> discrete;  ///< without the identity
  std::vector<AxisSymmetry> continuous;

  bool empty() const { return discrete.empty() && continuous.empty(); }
  bool operator==(const Symmetries&) const = default;
};

/// The turn by `angle_rad` about a symmetry's line.
Pose turnAbout(const AxisSymmetry& symmetry, double angle_rad);

/// Symmetries as an operator writes them, separated by semicolons: "z" is any turn about the
/// station's z axis, "z 90" the turns by 90 deg and its multiples. An axis is x, y, z or three
/// numbers; "at X Y Z" adds a point on it, m. Turns after one another are symmetries as well.
/// "none" and blanks: no symmetries. InputError, also where the turns have no end.
Symmetries symmetriesIn(std::string_view text);
/// The same as text, which symmetriesIn() reads; transforms that are not turns by a part of a whole
/// turn are counted instead: "and 2 other transforms". "none" without symmetries.
std::string symmetriesText(const Symmetries& symmetries);

/// InputError at `location` when a symmetry moves a station of these bounds out of its place: what
/// looks the same after a turn has its middle near the axis. A point in mm would otherwise make any
/// shift a symmetry.
void requireInPlace(const Symmetries& symmetries, const BoundingBox& bounds_in_station,
                    const std::string& location);

}  // namespace boresight::sessions
