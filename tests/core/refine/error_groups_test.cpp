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
#include "tests/support/coverage.h"

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
  std::vector<Sample> samples = noisySamples(random, 3000);
  for (Sample& sample : samples) sample.error.blur_px = random.uniform(0.0, 4.0);
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
  // An offset of all edges by 0.05 px outwards, along x and along y leaves no residual, nor one
  // outwards by a tenth of the blur.
  Eigen::Matrix<double, 6, 3> common = Eigen::Matrix<double, 6, 3>::Zero();
  for (const Sample& sample : samples)
    common += sample.row * Eigen::RowVector3d(std::hypot(0.05, 0.1 * sample.error.blur_px),
                                              0.05 * sample.error.normal.x(),
                                              0.05 * sample.error.normal.y());
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

/// Shared errors of one draw.
struct SharedErrors {
  std::array<double, 64> of_cell_px{};
  std::array<double, 16> of_side_px{};
  Eigen::Vector3d common_px = Eigen::Vector3d::Zero();  ///< outwards, along x, along y

  SharedErrors(double cell_px, double side_px, double all_px, Random& random) {
    for (double& error : of_cell_px) error = cell_px * random.normal();
    for (double& error : of_side_px) error = side_px * random.normal();
    for (double& error : common_px) error = all_px * random.normal();
  }
  double at_px(const GroupedError& error) const {
    const std::array<int, 3> groups = ErrorGroups::groupsOf(error);
    return of_cell_px[static_cast<std::size_t>(groups[0])] +
           of_side_px[static_cast<std::size_t>(groups[1])] + common_px[0] +
           common_px.tail<2>().dot(error.normal);
  }
};

/// A pose by Tukey's weights, and its covariance, as the refinement computes them.
struct RobustFit {
  Vector6d pose = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();

  explicit RobustFit(const std::vector<Sample>& samples) {
    std::array<std::byte, 16384> memory{};
    Arena arena(memory);
    ErrorGroups groups;
    EXPECT_EQ(groups.create(arena), Status::kOk);
    ErrorSums sums;
    for (int round = 0; round < 5; ++round) {
      std::vector<float> sizes;
      for (const Sample& sample : samples)
        sizes.push_back(static_cast<float>(std::abs(sample.residual_px - sample.row.dot(pose))));
      const double cut_px = kTukey * robustScale_px(sizes);
      Matrix6d information = Matrix6d::Zero();
      Vector6d gradient = Vector6d::Zero();
      groups.clear();
      sums = ErrorSums();
      for (const Sample& sample : samples) {
        const double residual_px = sample.residual_px - sample.row.dot(pose);
        const double square = residual_px * residual_px / (cut_px * cut_px);
        if (square >= 1.0) continue;
        const double weight = (1.0 - square) * (1.0 - square);
        information += weight * sample.row * sample.row.transpose();
        gradient += weight * residual_px * sample.row;
        sums.curvature +=
            (1.0 - square) * (1.0 - 5.0 * square) * sample.row * sample.row.transpose();
        groups.add(sample.error, residual_px, weight * sample.row);
      }
      pose += information.ldlt().solve(gradient);
    }
    groups.sum(sums);
    EXPECT_TRUE(sums.covariance(covariance));
  }
};

/// Errors of all components in units of their sigmas, by 1000 draws of one set of edges.
std::array<std::vector<double>, 6> poseErrors(double noise_px, double cell_px, double side_px,
                                              double all_px, std::uint64_t seed) {
  Random random(seed);
  std::vector<Sample> samples;
  for (int i = 0; i < 400; ++i) {
    Sample sample = randomSample(random);
    // Motions of a plane seen from the front: across, turned, nearer; and two tilts.
    const Eigen::Vector2d at = sample.error.place - Eigen::Vector2d(0.5, 0.5);
    const Eigen::Vector2d& normal = sample.error.normal;
    sample.row << normal, normal.x() * at.y() - normal.y() * at.x(), normal.dot(at),
        4.0 * normal.dot(at) * at.x(), 4.0 * normal.dot(at) * at.y();
    samples.push_back(sample);
  }
  std::array<std::vector<double>, 6> errors;
  for (int draw = 0; draw < 1000; ++draw) {
    const SharedErrors shared(cell_px, side_px, all_px, random);
    for (Sample& sample : samples)
      sample.residual_px = noise_px * random.normal() + shared.at_px(sample.error);
    const RobustFit fit(samples);
    for (int i = 0; i < 6; ++i)
      errors[static_cast<std::size_t>(i)].push_back(fit.pose[i] / std::sqrt(fit.covariance(i, i)));
  }
  return errors;
}

/// The sigmas of a localized pose.
TEST(ErrorGroups, Sigmas_HoldIndependentSharedAndCommonErrors) {
  struct Errors {
    double noise_px, cell_px, side_px, all_px;
  };
  std::uint64_t seed = 7;
  for (const auto& [noise_px, cell_px, side_px, all_px] :
       {Errors{0.3, 0.0, 0.0, 0.0}, Errors{0.3, 0.15, 0.0, 0.0}, Errors{0.3, 0.0, 0.1, 0.0},
        Errors{0.1, 0.0, 0.0, ErrorGroups::kCommonOffset_px}})
    for (const std::vector<double>& component :
         poseErrors(noise_px, cell_px, side_px, all_px, seed++)) {
      SCOPED_TRACE(testing::Message()
                   << noise_px << " " << cell_px << " " << side_px << " " << all_px);
      test::expectGaussianCoverage(component, true);
    }
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
