// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/symmetries.h"

namespace boresight::sessions {
namespace {

constexpr double kMillimetres = 1000.0;

Pose readDiscrete(const JsonReader& json) {
  const std::vector<JsonReader> numbers = json.elements(16);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)].number();
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) json.fail("last row is not 0 0 0 1");
  Pose pose;
  double deviation = 0.0;
  const Eigen::Vector3d translation_m = matrix.block<3, 1>(0, 3) / kMillimetres;
  if (poseFromMatrix(matrix.block<3, 3>(0, 0), translation_m, pose, deviation) != Status::kOk)
    json.fail("is not a rotation with a translation");
  return pose;
}

}  // namespace

AxisSymmetry readAxisSymmetry(const JsonReader& json, const char* point_key,
                              double units_per_metre) {
  AxisSymmetry symmetry;
  symmetry.axis = json.at("axis").vector3();
  const double length = symmetry.axis.norm();
  if (!(length > 1e-9)) json.failMember("axis", "has no direction");
  symmetry.axis /= length;
  if (const auto point = json.find(point_key))
    symmetry.point_m = point->vector3() / units_per_metre;
  return symmetry;
}

Symmetries readBopSymmetries(const JsonReader& model) {
  Symmetries symmetries;
  if (const auto list = model.find("symmetries_discrete"))
    for (const JsonReader& one : list->elements()) symmetries.discrete.push_back(readDiscrete(one));
  if (const auto list = model.find("symmetries_continuous"))
    for (const JsonReader& one : list->elements())
      symmetries.continuous.push_back(readAxisSymmetry(one, "offset", kMillimetres));
  return symmetries;
}

Pose turnAbout(const AxisSymmetry& symmetry, double angle_rad) {
  Pose turn;
  turn.rotation = rotationExp(angle_rad * symmetry.axis);
  turn.translation_m = symmetry.point_m - turn.rotation * symmetry.point_m;
  return turn;
}

}  // namespace boresight::sessions
