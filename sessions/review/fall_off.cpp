// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "sessions/review/edge_evidence.h"

namespace boresight::sessions {
namespace {

/// In the order of a perturbation's coordinates.
constexpr std::array<const char*, 6> kAxisNames = {
    "turned about the image's x axis", "turned about the image's y axis",
    "turned about the view axis",      "moved along the image's x axis",
    "moved along the image's y axis",  "moved along the view axis"};
/// Keeps ways that hardly move the image at all out of the search for the least determined one.
constexpr double kLeastMotion = 1e-3;

/// How the image follows perturbations about the station's middle.
struct Motion {
  Matrix6d image = Matrix6d::Zero();   ///< mean of J' J of both coordinates
  Matrix6d across = Matrix6d::Zero();  ///< mean of that along the edges' normals alone
};

Eigen::Vector3d middleOf(const std::vector<EdgePlace>& places, const Pose& camera_from_station) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const EdgePlace& place : places) sum += camera_from_station * place.point_in_station_m;
  return sum / static_cast<double>(places.size());
}

/// A perturbation about a point of the camera frame as one about the camera's centre.
Vector6d aboutCamera(const Vector6d& xi, const Eigen::Vector3d& middle_m) {
  Vector6d made = xi;
  made.tail<3>() += middle_m - rotationExp(xi.head<3>()) * middle_m;
  return made;
}

Motion motionOf(const std::vector<EdgePlace>& places, const Camera& camera,
                const Pose& camera_from_station, const Eigen::Vector3d& middle_m) {
  Matrix6d shift = Matrix6d::Identity();  // d (about the camera) / d (about the middle)
  for (int i = 0; i < 3; ++i)
    shift.block<3, 1>(3, i) = middle_m.cross(Eigen::Vector3d(Eigen::Vector3d::Unit(i)));
  Motion motion;
  double count = 0.0;
  for (const EdgePlace& place : places) {
    PlaceDerivative by;
    if (!placeDerivative(camera, camera_from_station, place.point_in_station_m, by)) continue;
    const Eigen::Matrix<double, 2, 6> rows = by.by_pose * shift;
    const Vector6d across = rows.transpose() * place.normal;
    motion.image += rows.transpose() * rows;
    motion.across += across * across.transpose();
    count += 1.0;
  }
  if (count > 0.0) {
    motion.image /= count;
    motion.across /= count;
  }
  return motion;
}

/// The way in which the image moves most along the edges and least across them.
Vector6d leastDetermined(const Motion& motion) {
  Matrix6d image = motion.image;
  image.diagonal() *= 1.0 + kLeastMotion;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(motion.across, image);
  if (solver.info() != Eigen::Success) return Vector6d::Unit(2);
  return solver.eigenvectors().col(0);
}

/// The places as a displaced pose predicts them; which are hidden is left as it was.
std::vector<EdgePlace> displacedPlaces(const std::vector<EdgePlace>& places, const Camera& camera,
                                       const Pose& displaced_camera_from_station) {
  std::vector<EdgePlace> moved;
  moved.reserve(places.size());
  for (EdgePlace place : places) {
    Eigen::Vector2d pixel;
    if (!project(camera, displaced_camera_from_station * place.point_in_station_m, pixel)) continue;
    place.pixel = pixel;
    moved.push_back(place);
  }
  return moved;
}

/// The axis that moves the image most in a mixture of them.
std::string mainlyText(const Vector6d& xi, const Motion& motion) {
  Eigen::Index axis = 0;
  (xi.cwiseAbs2().cwiseProduct(motion.image.diagonal())).maxCoeff(&axis);
  return std::string("in the least determined way, mainly ") +
         kAxisNames[static_cast<std::size_t>(axis)];
}

}  // namespace

std::vector<FallOff> fallOffOf(const ImageEdges& image, const std::vector<EdgePlace>& places,
                               const Camera& camera, const Pose& camera_from_station,
                               const EvidenceSettings& settings) {
  std::vector<FallOff> all;
  if (places.empty()) return all;
  const Eigen::Vector3d middle_m = middleOf(places, camera_from_station);
  const Motion motion = motionOf(places, camera, camera_from_station, middle_m);
  const auto add = [&](const Vector6d& way, std::string name) {
    const double moves_px = std::sqrt(way.dot(motion.image * way));
    if (!(moves_px > 0.0)) return;
    double coverage = 0.0;
    for (const double sense : {-1.0, 1.0}) {
      const Vector6d xi = (sense * settings.displaced_px / moves_px) * way;
      const Pose displaced = perturbed(aboutCamera(xi, middle_m), camera_from_station);
      const auto moved = displacedPlaces(places, camera, displaced);
      coverage += 0.5 * coverageOf(lookAt(image, moved, settings), settings.near_px).value();
    }
    all.push_back({std::move(name), coverage});
  };
  for (int axis = 0; axis < 6; ++axis)
    add(Vector6d::Unit(axis), kAxisNames[static_cast<std::size_t>(axis)]);
  const Vector6d least = leastDetermined(motion);
  add(least, mainlyText(least, motion));
  return all;
}

}  // namespace boresight::sessions
