// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/inlier_spread.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace boresight::sessions {
namespace {

Eigen::Matrix2d scatterOf(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& point : points)
    scatter += (point - mean) * (point - mean).transpose();
  return scatter / static_cast<double>(points.size());
}

}  // namespace

std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px) {
  if (points_px.size() < 2 || others_px.size() < 2) return {};
  const Eigen::Matrix2d floor = floor_px * floor_px * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d points = scatterOf(points_px) + floor;
  const Eigen::Matrix2d others = scatterOf(others_px) + floor;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solver(points, others,
                                                                         Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return {};
  return std::sqrt(std::max(0.0, solver.eigenvalues().minCoeff()));
}

double deviationOf(std::span<const double> values) {
  if (values.size() < 2) return 0.0;
  double mean = 0.0;
  for (const double value : values) mean += value;
  mean /= static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

double medianOf(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace boresight::sessions
