// SPDX-License-Identifier: Apache-2.0
#include "core/refine/error_groups.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/base/random.h"
#include "core/pnp/normal_equations.h"

namespace boresight {
namespace {

constexpr double kNoise_px = 0.3;

struct Sample {
  GroupedError error;
  Vector6d row;
  double residual_px = 0.0;
};

Sample randomSample(Random& random) {
  Sample sample;
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  sample.error.place = {random.uniform(), random.uniform()};
  sample.error.normal = {std::cos(angle), std::sin(angle)};
  sample.error.brighter = random.below(2) == 1;
  sample.error.kind = static_cast<std::uint8_t>(1 + random.below(3));
  for (int i = 0; i < 6; ++i) sample.row[i] = random.normal();
  return sample;
}

std::vector<Sample> noisySamples(Random& random, int count) {
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(randomSample(random));
    samples.back().residual_px = kNoise_px * random.normal();
  }
  return samples;
}

int sectorByAngle(const Eigen::Vector2d& direction) {
  const double angle = std::atan2(direction.y(), direction.x());
  const double turn = (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle) / std::numbers::pi;
  return static_cast<int>(turn * 8.0) % 16;
}

/// The sums of samples with unit weights, and their covariance.
struct Grouped {
  explicit Grouped(const std::vector<Sample>& samples) {
    std::array<std::byte, 16384> memory{};
    Arena arena(memory);
    ErrorGroups groups;
    EXPECT_EQ(groups.create(arena), Status::kOk);
    groups.clear();
    for (const Sample& sample : samples) {
      groups.add(sample.error, sample.residual_px, sample.row);
      sums.curvature += sample.row * sample.row.transpose();
    }
    groups.sum(sums);
    solved = sums.covariance(covariance);
  }
  ErrorSums sums;
  Matrix6d covariance = Matrix6d::Zero();
  bool solved = false;
};

TEST(ErrorGroups, SectorsAreThoseOfTheAngle) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Sample sample = randomSample(random);
    ASSERT_EQ(ErrorGroups::sectorOf(3.0 * sample.error.normal), sectorByAngle(sample.error.normal))
        << sample.error.normal.transpose();
  }
  EXPECT_EQ(ErrorGroups::sectorOf({1.0, 0.0}), 0);
  EXPECT_EQ(ErrorGroups::sectorOf({0.0, 1.0}), 4);
  EXPECT_EQ(ErrorGroups::sectorOf({-1.0, 0.0}), 8);
  EXPECT_EQ(ErrorGroups::sectorOf({0.0, -1.0}), 12);
}

TEST(ErrorGroups, EqualsSumsOverMaps) {
  Random random(2);
  const std::vector<Sample> samples = noisySamples(random, 3000);
  const Grouped grouped(samples);
  ASSERT_TRUE(grouped.solved);
  std::array<std::map<std::array<int, 2>, Vector6d>, 3> ways;
  for (const Sample& sample : samples) {
    const int sector = sectorByAngle(sample.error.normal);
    const std::array<std::array<int, 2>, 3> keys = {
        {{static_cast<int>(8.0 * sample.error.place.x()),
          static_cast<int>(8.0 * sample.error.place.y())},
         {sector / 2, sample.error.brighter ? 1 : 0},
         {sector, sample.error.kind}}};
    for (std::size_t way = 0; way < 3; ++way) {
      const auto at = ways[way].try_emplace(keys[way], Vector6d::Zero()).first;
      at->second += sample.residual_px * sample.row;
    }
  }
  Matrix6d squares = Matrix6d::Zero();
  for (const auto& way : ways) {
    const auto count = static_cast<double>(way.size());
    for (const auto& [key, sum] : way) squares += sum * sum.transpose() * count / (count - 1.0);
  }
  // An offset of all edges by 0.05 px outwards, along x and along y leaves no residual.
  Eigen::Matrix<double, 6, 3> common = Eigen::Matrix<double, 6, 3>::Zero();
  for (const Sample& sample : samples)
    common += 0.05 * sample.row *
              Eigen::RowVector3d(1.0, sample.error.normal.x(), sample.error.normal.y());
  squares += common * common.transpose();
  const Matrix6d inverse = grouped.sums.curvature.inverse();
  const Matrix6d expected = inverse * squares * inverse;
  EXPECT_LT((grouped.covariance - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(grouped.covariance, grouped.covariance.transpose());
}

/// Mean normalized squared error of least squares over many draws: six when the covariance is what
/// the estimates' scatter is.
double meanSquaredError(double shared_px, std::uint64_t seed) {
  constexpr int kDraws = 400;
  Random random(seed);
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Sample> samples;
    std::array<double, 64> of_cell{};
    for (double& error : of_cell) error = shared_px * random.normal();
    Vector6d gradient = Vector6d::Zero();
    Matrix6d information = Matrix6d::Zero();
    for (int i = 0; i < 2000; ++i) {
      Sample sample = randomSample(random);
      // Rows that neighbours share, too, as those of a pose: else shared errors average out.
      sample.row.head<2>() = sample.error.normal;
      sample.row[2] = sample.error.place.x() - 0.5;
      const auto cell =
          static_cast<std::size_t>(8 * static_cast<int>(8.0 * sample.error.place.x()) +
                                   static_cast<int>(8.0 * sample.error.place.y()));
      sample.residual_px = kNoise_px * random.normal() + of_cell[cell];
      gradient += sample.residual_px * sample.row;
      information += sample.row * sample.row.transpose();
      samples.push_back(sample);
    }
    const Vector6d error = information.ldlt().solve(gradient);
    for (Sample& sample : samples) sample.residual_px -= sample.row.dot(error);
    const Grouped grouped(samples);
    EXPECT_TRUE(grouped.solved);
    sum += error.dot(grouped.covariance.ldlt().solve(error));
  }
  return sum / kDraws;
}

TEST(ErrorGroups, CovarianceCoversIndependentAndSharedErrors) {
  // Each of the three ways of grouping counts independent errors: 6 / 3, and less, as the offset of
  // all edges that is assumed is not in these errors.
  const double independent = meanSquaredError(0.0, 3);
  EXPECT_GT(independent, 0.7 * 6.0 / 3.0);
  EXPECT_LT(independent, 1.4 * 6.0 / 3.0);
  const double shared = meanSquaredError(0.3, 4);
  EXPECT_GT(shared, 2.0);
  EXPECT_LT(shared, 6.6) << "larger would be a covariance that is too small";
}

TEST(ErrorGroups, TwoViews_AddTheirErrorsInOneFrame) {
  Random random(6);
  const ErrorSums own = Grouped(noisySamples(random, 500)).sums;
  const Pose camera_from_first{rotationExp({0.1, -0.3, 0.2}), {0.2, -0.1, 0.05}};
  const Matrix6d adjoint = adjointOf(camera_from_first);
  Matrix6d alone, brought, both;
  ASSERT_TRUE(own.covariance(alone));
  // The same covariance in another frame.
  const ErrorSums in_first = own.inFirst(camera_from_first);
  ASSERT_TRUE(in_first.covariance(brought));
  const Matrix6d back = adjoint * brought * adjoint.transpose();
  EXPECT_LT((back - alone).norm(), 1e-9 * alone.norm());
  // Twice the same edges with errors of their own: half the covariance.
  ErrorSums sum = own;
  sum.add(own);
  ASSERT_TRUE(sum.covariance(both));
  EXPECT_LT((2.0 * both - alone).norm(), 1e-9 * alone.norm());
  sum.add(Grouped({}).sums);
  EXPECT_FALSE(sum.covariance(both));
}

TEST(ErrorGroups, SingleGroup_GivesNoCovariance) {
  Random random(5);
  std::vector<Sample> samples(20, randomSample(random));
  for (Sample& sample : samples) {
    sample.residual_px = 0.1;
    for (int i = 0; i < 6; ++i) sample.row[i] = random.normal();
  }
  EXPECT_FALSE(Grouped(samples).solved);
  EXPECT_FALSE(Grouped({}).solved);
}

}  // namespace
}  // namespace boresight
