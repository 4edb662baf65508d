// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/first_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include "core/base/random.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kFewestPosePoints = 4;
/// All triples of ten points. Of more points, with 40 % of them wrong, 26 triples are right.
constexpr std::size_t kMostTriples = 120;
constexpr std::size_t kMostPoses = 12;
/// Residuals beyond this number of sigmas count by their logarithm.
constexpr double kLogarithmicFrom_sigmas = 3.0;
constexpr double kUnseen_sigmas = 1e6;  ///< of a point that the pose does not project
/// Nearer poses lead to the same one.
constexpr double kApart_rad = 0.05;
constexpr double kLeastArea = 1e-6;  ///< of a triangle: squared sine of its angle

/// A point and the direction in which it is seen.
struct Sight {
  Eigen::Vector3d point_m;
  Eigen::Vector3d bearing;  ///< of unit length
  Eigen::Vector2d pixel;
  double sigma_px;
};

/// Of the camera's centre also where the pupil moves: exact enough for a start.
std::vector<Sight> sightsOf(const AnnotatedView& view) {
  std::vector<Sight> sights;
  for (const PointPair& point : view.annotations.points) {
    Ray ray;
    if (point.used() && unprojectRay(view.camera, *point.pixel, ray))
      sights.push_back(
          {*point.point_in_station_m, ray.direction.normalized(), *point.pixel, point.sigma_px});
  }
  return sights;
}

using Triple = std::array<std::size_t, 3>;

/// All triples, or as many random ones.
std::vector<Triple> triplesOf(std::size_t count) {
  std::vector<Triple> triples;
  if (count * (count - 1) * (count - 2) / 6 <= kMostTriples) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        for (std::size_t k = j + 1; k < count; ++k) triples.push_back({i, j, k});
    return triples;
  }
  Random random(1);
  const auto draw = [&] { return random.below(static_cast<std::uint32_t>(count)); };
  while (triples.size() < kMostTriples) {
    const Triple triple = {draw(), draw(), draw()};
    if (triple[0] != triple[1] && triple[1] != triple[2] && triple[2] != triple[0])
      triples.push_back(triple);
  }
  return triples;
}

using Points = std::array<Eigen::Vector3d, 3>;
using Places = std::array<Eigen::Vector2d, 3>;  ///< in the plane z = 1

void addP3p(const Points& points_m, const Places& places, std::vector<Pose>& poses) {
  std::array<cv::Point3d, 3> points;
  std::array<cv::Point2d, 3> seen;
  for (std::size_t i = 0; i < 3; ++i) {
    points[i] = {points_m[i].x(), points_m[i].y(), points_m[i].z()};
    seen[i] = {places[i].x(), places[i].y()};
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solveP3P(points, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations,
               cv::SOLVEPNP_AP3P);
  const auto vector = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  for (std::size_t i = 0; i < rotations.size(); ++i)
    poses.push_back({rotationExp(vector(rotations[i])), vector(translations[i])});
}

/// Orthonormal axes of a triangle's plane, by two of its sides.
Eigen::Matrix3d axesOf(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::Matrix3d axes;
  axes.col(0) = first.normalized();
  axes.col(2) = first.cross(second).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Two poses, mirrored in depth: the larger root of the scale's equation, by which both sides are
/// as long as in the station and have the same angle.
void addScaledOrthography(const Points& points_m, const Places& places, std::vector<Pose>& poses) {
  const Eigen::Vector3d a = points_m[1] - points_m[0];
  const Eigen::Vector3d b = points_m[2] - points_m[0];
  const Eigen::Vector2d u = places[1] - places[0];
  const Eigen::Vector2d v = places[2] - places[0];
  const double area = a.cross(b).squaredNorm();
  if (!(area > kLeastArea * a.squaredNorm() * b.squaredNorm())) return;
  const double half = 0.5 * (a.squaredNorm() * v.squaredNorm() + b.squaredNorm() * u.squaredNorm() -
                             2.0 * a.dot(b) * u.dot(v));
  const double seen = u.squaredNorm() * v.squaredNorm() - u.dot(v) * u.dot(v);
  const double square = (half + std::sqrt(std::max(0.0, half * half - area * seen))) / area;
  if (!(square > 0.0)) return;
  const double depth_a = std::sqrt(std::max(0.0, square * a.squaredNorm() - u.squaredNorm()));
  const double depth_b = std::copysign(
      std::sqrt(std::max(0.0, square * b.squaredNorm() - v.squaredNorm())),
      square * a.dot(b) - u.dot(v));
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d first(u.x(), u.y(), side * depth_a);
    const Eigen::Vector3d second(v.x(), v.y(), side * depth_b);
    const Eigen::Matrix3d turn = axesOf(first, second) * axesOf(a, b).transpose();
    Pose pose;
    pose.rotation = Eigen::Quaterniond(turn).normalized();
    pose.translation_m = places[0].homogeneous() / std::sqrt(square) - pose.rotation * points_m[0];
    poses.push_back(pose);
  }
}

/// All solutions of a triple, in the frame of the camera.
void addPosesOf(const std::vector<Sight>& sights, const Triple& triple, std::vector<Pose>& poses) {
  Points points_m;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    points_m[i] = sights[triple[i]].point_m;
    axis += sights[triple[i]].bearing;
  }
  // Seen along z: also bearings beyond 90 degrees have places then, and the scale is even.
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ());
  Places places;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d bearing = turned * sights[triple[i]].bearing;
    if (!(bearing.z() > 1e-3)) return;
    places[i] = bearing.hnormalized();
  }
  const std::size_t first = poses.size();
  addP3p(points_m, places, poses);
  addScaledOrthography(points_m, places, poses);
  for (std::size_t i = first; i < poses.size(); ++i) {
    poses[i].rotation = (turned.conjugate() * poses[i].rotation).normalized();
    poses[i].translation_m = turned.conjugate() * poses[i].translation_m;
  }
}

struct JudgedPose {
  Pose camera_from_station;
  double cost = 0.0;
};

double costOf(const AnnotatedView& view, const std::vector<Sight>& sights, const Pose& pose) {
  double cost = 0.0;
  for (const Sight& sight : sights) {
    Eigen::Vector2d pixel;
    const double off_sigmas = project(view.camera, pose * sight.point_m, pixel)
                                  ? (pixel - sight.pixel).norm() / sight.sigma_px
                                  : kUnseen_sigmas;
    const double ratio = std::min(off_sigmas, kUnseen_sigmas) / kLogarithmicFrom_sigmas;
    cost += std::log1p(ratio * ratio);
  }
  return cost;
}

bool areNear(const Pose& a, const Pose& b) {
  const double shift_m = (a.translation_m - b.translation_m).norm();
  return a.rotation.angularDistance(b.rotation) < kApart_rad &&
         shift_m < kApart_rad * b.translation_m.norm();
}

}  // namespace

std::vector<Pose> firstPoses(const AnnotatedView& view) {
  const std::vector<Sight> sights = sightsOf(view);
  if (sights.size() < kFewestPosePoints) return {};
  std::vector<Pose> poses;
  for (const Triple& triple : triplesOf(sights.size())) addPosesOf(sights, triple, poses);
  std::vector<JudgedPose> judged;
  for (const Pose& pose : poses)
    if (pose.isFinite()) judged.push_back({pose, costOf(view, sights, pose)});
  std::ranges::stable_sort(judged, {}, &JudgedPose::cost);
  std::vector<Pose> first;
  for (const auto& [pose, cost] : judged) {
    if (first.size() == kMostPoses) break;
    if (std::ranges::none_of(first, [&pose](const Pose& other) { return areNear(pose, other); }))
      first.push_back(pose);
  }
  return first;
}

}  // namespace boresight::sessions
