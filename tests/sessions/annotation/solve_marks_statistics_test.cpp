// SPDX-License-Identifier: Apache-2.0
// Errors and covariances agree over many draws of noise.
#include <gtest/gtest.h>

#include <cmath>

#include "core/pnp/normal_equations.h"
#include "sessions/annotation/solve_marks.h"
#include "tests/sessions/annotation/marked_scene.h"

namespace boresight::sessions {
namespace {

using test::MarkedScene;
using test::randomFor;
using test::randomScene;

struct Setting {
  const char* name;
  CameraModel model;
  int points;
  int lines;
  double noise_px;
  double stated_factor;  ///< the stated sigma by the noise
};

class SolveMarksStatistics : public testing::TestWithParam<Setting> {};

/// e' C^-1 e / 6 with the variance estimated from f degrees of freedom follows F(6, f).
TEST_P(SolveMarksStatistics, NormalizedErrorSquaredHasTheRightMean) {
  const Setting& setting = GetParam();
  Random random = randomFor(setting.name);
  double sum = 0.0;
  double noise_squared = 0.0;
  constexpr int kDraws = 1000;
  int freedom = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    MarkedScene scene =
        randomScene(random, setting.model, setting.points, setting.lines, setting.noise_px);
    for (PointPair& point : scene.view.marks.points) point.sigma_px *= setting.stated_factor;
    for (LinePair& line : scene.view.marks.lines) line.sigma_px *= setting.stated_factor;
    const MarksResult result = solveMarks(scene.views(), {});
    ASSERT_TRUE(result.solution) << result.reason;
    const MarksSolution& solution = *result.solution;
    freedom = solution.degrees_of_freedom;
    ASSERT_EQ(freedom, 2 * (setting.points + setting.lines) - 6);
    const Vector6d error =
        perturbationBetween(solution.rig_from_station, scene.camera_from_station);
    Matrix6d information;
    ASSERT_TRUE(invert(solution.covariance, information));
    sum += error.dot(information.selfadjointView<Eigen::Lower>() * error) / 6.0;
    noise_squared += solution.noise_factor * solution.noise_factor;
  }
  const double f = freedom;
  const double mean = f / (f - 2.0);
  const double variance = 2.0 * f * f * (6.0 + f - 2.0) / (6.0 * (f - 2.0) * (f - 2.0) * (f - 4.0));
  EXPECT_NEAR(sum / kDraws, mean, 4.0 * std::sqrt(variance / kDraws));
  const double expected = 1.0 / (setting.stated_factor * setting.stated_factor);
  EXPECT_NEAR(noise_squared / kDraws, expected, 4.0 * expected * std::sqrt(2.0 / f / kDraws));
}

INSTANTIATE_TEST_SUITE_P(
    Settings, SolveMarksStatistics,
    testing::Values(Setting{"Points", CameraModel::kPinhole, 10, 0, 0.3, 1.0},
                    Setting{"LargeNoise", CameraModel::kPinhole, 20, 0, 1.0, 1.0},
                    Setting{"SmallNoise", CameraModel::kBrownConrady, 8, 0, 0.1, 1.0},
                    Setting{"Fisheye", CameraModel::kKannalaBrandt, 10, 0, 0.2, 1.0},
                    Setting{"PointsAndLines", CameraModel::kBrownConrady, 6, 6, 0.3, 1.0},
                    Setting{"SigmasStatedWrong", CameraModel::kPinhole, 12, 0, 0.5, 3.0}),
    [](const testing::TestParamInfo<Setting>& setting) { return setting.param.name; });

}  // namespace
}  // namespace boresight::sessions
