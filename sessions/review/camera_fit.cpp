// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/camera_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "sessions/review/inlier_spread.h"

namespace boresight::sessions {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr std::size_t kLeastFound = 60;
constexpr int kRounds = 10;
/// First the usual constant, so that what a wrong camera leaves does not count as outlying; then a
/// tighter one: shadows and bevels beside an edge are many and off to one side, and precision is to
/// spare.
constexpr double kWideTukey = 4.685;
constexpr double kTightTukey = 2.0;
/// Farther ones are mostly another edge.
constexpr double kFarthest_px = 2.5;
constexpr double kDeviationOfMedian = 1.4826;
constexpr double kLeastScale_px = 0.05;
/// Tiles along the longer side of what is looked at.
constexpr double kTiles = 12.0;
/// Against a matrix that cannot be inverted: of its diagonal.
constexpr double kLeastPivot = 1e-11;

struct Row {
  Vector9d by;  ///< of the predicted coordinate along the normal
  double residual_px = 0.0;
  std::pair<int, int> tile;
};

std::vector<Row> rowsOf(std::span<const LookedPlace> looked, const Camera& camera,
                        const Pose& camera_from_station) {
  std::vector<Row> rows;
  Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d most = -least;
  for (const LookedPlace& one : looked) {
    least = least.cwiseMin(one.place.pixel);
    most = most.cwiseMax(one.place.pixel);
  }
  const double tile_px = std::max((most - least).maxCoeff() / kTiles, 1.0);
  for (const LookedPlace& one : looked) {
    PlaceDerivative by;
    if (!one.found || std::abs(one.found->offset_px) > kFarthest_px ||
        !placeDerivative(camera, camera_from_station, one.place.point_in_station_m, by))
      continue;
    Row row;
    row.by.head<6>() = by.by_pose.transpose() * one.place.normal;
    row.by.tail<3>() = by.by_camera.transpose() * one.place.normal;
    row.residual_px = one.found->offset_px;
    const Eigen::Vector2d tile = (one.place.pixel - least) / tile_px;
    row.tile = {static_cast<int>(tile.x()), static_cast<int>(tile.y())};
    rows.push_back(row);
  }
  return rows;
}

double tukeyWeight(double residual_px, double cut_px) {
  const double u = residual_px / cut_px;
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

double scaleOf(const std::vector<Row>& rows, const Vector9d& solution) {
  std::vector<double> sizes;
  for (const Row& row : rows) sizes.push_back(std::abs(row.residual_px - row.by.dot(solution)));
  return std::max(kDeviationOfMedian * medianOf(sizes), kLeastScale_px);
}

struct Solved {
  Vector9d solution = Vector9d::Zero();
  Matrix9d inverse = Matrix9d::Zero();
  double cut_px = 0.0;  ///< beyond, a residual weighs nothing
};

std::optional<Solved> solveRobustly(const std::vector<Row>& rows) {
  Solved solved;
  for (int round = 0; round < kRounds; ++round) {
    solved.cut_px =
        (round < kRounds / 2 ? kWideTukey : kTightTukey) * scaleOf(rows, solved.solution);
    Matrix9d information = Matrix9d::Zero();
    Vector9d right = Vector9d::Zero();
    for (const Row& row : rows) {
      const double weight =
          tukeyWeight(row.residual_px - row.by.dot(solved.solution), solved.cut_px);
      information += weight * row.by * row.by.transpose();
      right += weight * row.residual_px * row.by;
    }
    const Vector9d scale = information.diagonal().cwiseSqrt();
    if (!(scale.minCoeff() > 0.0)) return {};
    const Vector9d inverse_scale = scale.cwiseInverse();
    const Matrix9d balanced = inverse_scale.asDiagonal() * information * inverse_scale.asDiagonal();
    const Eigen::LDLT<Matrix9d> factors(balanced);
    if (!(factors.vectorD().minCoeff() > kLeastPivot)) return {};
    solved.inverse = inverse_scale.asDiagonal() * factors.solve(Matrix9d(Matrix9d::Identity())) *
                     inverse_scale.asDiagonal();
    solved.solution = solved.inverse * right;
  }
  return solved;
}

Matrix9d clusteredCovariance(const std::vector<Row>& rows, const Solved& solved) {
  std::map<std::pair<int, int>, Vector9d> scores;
  for (const Row& row : rows) {
    const double residual_px = row.residual_px - row.by.dot(solved.solution);
    const auto place = scores.try_emplace(row.tile, Vector9d::Zero()).first;
    place->second += tukeyWeight(residual_px, solved.cut_px) * residual_px * row.by;
  }
  Matrix9d middle = Matrix9d::Zero();
  for (const auto& [tile, score] : scores) middle += score * score.transpose();
  return solved.inverse * middle * solved.inverse;
}

}  // namespace

std::optional<CameraFit> fitCamera(std::span<const LookedPlace> looked, const Camera& camera,
                                   const Pose& camera_from_station) {
  const std::vector<Row> rows = rowsOf(looked, camera, camera_from_station);
  if (rows.size() < kLeastFound) return {};
  const auto solved = solveRobustly(rows);
  if (!solved) return {};
  const Matrix9d covariance = clusteredCovariance(rows, *solved);
  CameraFit fit;
  fit.focal_px = solved->solution(6);
  fit.focal_sigma_px = std::sqrt(std::max(0.0, covariance(6, 6)));
  const Eigen::Vector2d centre = solved->solution.tail<2>();
  fit.centre_px = centre.norm();
  const Eigen::Vector2d along =
      fit.centre_px > 0.0 ? Eigen::Vector2d(centre / fit.centre_px) : Eigen::Vector2d::UnitX();
  fit.centre_sigma_px =
      std::sqrt(std::max(0.0, along.dot(covariance.bottomRightCorner<2, 2>() * along)));
  return fit;
}

}  // namespace boresight::sessions
