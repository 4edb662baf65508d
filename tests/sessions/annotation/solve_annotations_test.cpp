// SPDX-License-Identifier: Apache-2.0
// Errors and covariances agree over many draws of noise.
#include "sessions/annotation/solve_annotations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "core/pnp/normal_equations.h"
#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/support/coverage.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::addLine;
using test::addPoint;
using test::AnnotatedScene;
using test::randomFor;
using test::randomScene;

/// The solution; a failure where there is none.
AnnotationsSolution solved(const std::vector<AnnotatedView>& views,
                           const SolveAnnotationsOptions& options = {}) {
  const AnnotationsResult result = solveAnnotations(views, options);
  EXPECT_TRUE(result.solution) << result.reason;
  return result.solution.value_or(AnnotationsSolution());
}

double distance(const Pose& a, const Pose& b) { return perturbationBetween(a, b).norm(); }

TEST(SolveAnnotations, FindsTheTruthWithEveryCamera) {
  Random random = randomFor("SolveMarks.Truth");
  for (const CameraModel model :
       {CameraModel::kPinhole, CameraModel::kBrownConrady, CameraModel::kKannalaBrandt}) {
    for (int trial = 0; trial < 30; ++trial) {
      const AnnotatedScene scene = randomScene(random, model, 4 + trial % 5, trial % 4, 0.0);
      const AnnotationsSolution solution = solved(scene.views());
      EXPECT_LT(distance(solution.rig_from_station, scene.camera_from_station), 1e-7);
      EXPECT_LT(solution.rms_px, 1e-5);
    }
  }
}

TEST(SolveAnnotations, LinesAlone_FromAnInitialPose_AreSolved) {
  Random random = randomFor("SolveMarks.Lines");
  for (int trial = 0; trial < 30; ++trial) {
    const AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 0, 8, 0.0);
    EXPECT_THAT(solveAnnotations(scene.views(), {}).reason, HasSubstr("initial pose"));
    SolveAnnotationsOptions options;
    options.rig_from_station_guess =
        perturbed(Vector6d{{0.03, -0.05, 0.04, 0.01, -0.01, 0.02}}, scene.camera_from_station);
    EXPECT_LT(distance(solved(scene.views(), options).rig_from_station, scene.camera_from_station),
              1e-7);
  }
}

cv::Mat cameraMatrix(const Camera& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
}

std::pair<std::vector<cv::Point3d>, std::vector<cv::Point2d>> toOpenCv(
    const Annotations& annotations) {
  std::pair<std::vector<cv::Point3d>, std::vector<cv::Point2d>> pairs;
  for (const PointPair& point : annotations.points) {
    const Eigen::Vector3d& p = *point.point_in_station_m;
    pairs.first.emplace_back(p.x(), p.y(), p.z());
    pairs.second.emplace_back(point.pixel->x(), point.pixel->y());
  }
  return pairs;
}

Pose fromOpenCv(const cv::Mat1d& rotation, const cv::Mat1d& translation) {
  return {rotationExp({rotation(0), rotation(1), rotation(2)}),
          {translation(0), translation(1), translation(2)}};
}

TEST(SolveAnnotations, AgreesWithOpenCvsIterativeSolution) {
  Random random = randomFor("SolveMarks.OpenCv");
  for (int trial = 0; trial < 30; ++trial) {
    const AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 12, 0, 0.5);
    const auto [places, pixels] = toOpenCv(scene.view.annotations);
    const std::vector<double> distortion(scene.view.camera.distortion.begin(),
                                         scene.view.camera.distortion.begin() + 5);
    cv::Mat rotation, translation;
    ASSERT_TRUE(cv::solvePnP(places, pixels, cameraMatrix(scene.view.camera), distortion, rotation,
                             translation, false, cv::SOLVEPNP_SQPNP));
    cv::solvePnPRefineLM(
        places, pixels, cameraMatrix(scene.view.camera), distortion, rotation, translation,
        cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-14));
    EXPECT_LT(distance(solved(scene.views()).rig_from_station, fromOpenCv(rotation, translation)),
              1e-5);
  }
}

TEST(SolveAnnotations, ShowsBothPosesOfAPlaneAsIppeDoes) {
  Random random = randomFor("SolveMarks.Plane");
  int ambiguous = 0;
  for (int trial = 0; trial < 40; ++trial) {
    // Small and far away: nearly parallel rays, where both poses fit.
    AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 0, 0, 0.0);
    const double azimuth = random.uniform(-kPi, kPi);
    const Eigen::Vector3d tilt_axis(std::cos(azimuth), std::sin(azimuth), 0.0);
    scene.camera_from_station.rotation = rotationExp(random.uniform(0.3, 0.9) * tilt_axis) *
                                         rotationExp({0.0, 0.0, random.uniform(-kPi, kPi)});
    scene.camera_from_station.translation_m = {0.05, -0.03, 1.2};
    const auto corner = [&](double x, double y) {
      return Eigen::Vector3d(0.015 * x, 0.015 * y, 0.0);
    };
    for (const Eigen::Vector3d& place_m : {corner(-1, -1), corner(1, -1), corner(1, 1),
                                           corner(-1, 1), corner(0, 0.5), corner(-0.5, 0)})
      ASSERT_TRUE(addPoint(scene.view, scene.camera_from_station, place_m, 0.3, 0.3, random));
    const auto [places, pixels] = toOpenCv(scene.view.annotations);
    std::vector<cv::Mat> rotations, translations;
    std::vector<double> errors;
    cv::solvePnPGeneric(places, pixels, cameraMatrix(scene.view.camera), cv::noArray(), rotations,
                        translations, false, cv::SOLVEPNP_IPPE, cv::noArray(), cv::noArray(),
                        errors);
    const AnnotationsSolution solution = solved(scene.views());
    const double least = *std::min_element(errors.begin(), errors.end());
    EXPECT_LE(solution.rms_px, least * 1.001 + 1e-6) << "never worse than IPPE's best";
    const Pose poses[] = {fromOpenCv(rotations[0], translations[0]),
                          fromOpenCv(rotations[1], translations[1])};
    const double apart_rad = poses[0].rotation.angularDistance(poses[1].rotation);
    if (apart_rad > 0.3 && std::max(errors[0], errors[1]) < least + 0.3) {
      ++ambiguous;
      EXPECT_TRUE(solution.ambiguous) << errors[0] << " " << errors[1] << " " << apart_rad;
    }
    if (!solution.ambiguous) continue;
    EXPECT_GE(solution.ambiguous->rms_px, solution.rms_px - 1e-9);
    const Pose& other = solution.ambiguous->rig_from_station;
    EXPECT_LT(std::min(distance(other, poses[0]), distance(other, poses[1])), 0.2);
  }
  EXPECT_GT(ambiguous, 5);
}

TEST(SolveAnnotations, Robust_IgnoresFarOutliers) {
  Random random = randomFor("SolveMarks.Robust");
  SolveAnnotationsOptions robust;
  robust.robust = true;
  for (int trial = 0; trial < 30; ++trial) {
    AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 14, 4, 0.3);
    const auto errorOf = [&](const AnnotationsSolution& solution) {
      return distance(solution.rig_from_station, scene.camera_from_station);
    };
    const double clean_error = errorOf(solved(scene.views(), robust));
    *scene.view.annotations.points[2].pixel += Eigen::Vector2d(60.0, -25.0);
    *scene.view.annotations.points[9].pixel += Eigen::Vector2d(-8.0, 12.0);
    scene.view.annotations.lines[1].line->start += Eigen::Vector2d(30.0, 30.0);
    const AnnotationsSolution solution = solved(scene.views(), robust);
    ASSERT_EQ(solution.annotations.size(), 18u);
    EXPECT_LT(errorOf(solution), 3.0 * clean_error + 2e-3);
    EXPECT_EQ(solution.annotations[2].weight, 0.0);
    EXPECT_EQ(solution.annotations[9].weight, 0.0);
    EXPECT_GT(solution.annotations[2].normalized, 3.0);
    EXPECT_GT(errorOf(solved(scene.views())), errorOf(solution));
  }
}

TEST(SolveAnnotations, Rig_IsSolvedTogether) {
  Random random = randomFor("SolveMarks.Rig");
  double single = 0.0, together = 0.0;
  for (int trial = 0; trial < 40; ++trial) {
    const AnnotatedScene left = randomScene(random, CameraModel::kBrownConrady, 6, 2, 0.5);
    AnnotatedView right;
    right.name = "right";
    right.camera = test::annotatedCamera(CameraModel::kPinhole);
    right.camera_from_rig = {rotationExp({0.02, 0.25, -0.03}), {-0.15, 0.01, 0.0}};
    const Pose right_from_station = right.camera_from_rig * left.camera_from_station;
    for (const PointPair& point : left.view.annotations.points)
      addPoint(right, right_from_station, *point.point_in_station_m, 0.5, 0.5, random);
    const AnnotationsSolution both = solved({left.view, right});
    ASSERT_EQ(both.camera_from_station.size(), 2u);
    EXPECT_LT(distance(both.camera_from_station[1], right.camera_from_rig * both.rig_from_station),
              1e-12);
    const AnnotationsSolution alone = solved(left.views());
    const auto off_m = [&](const AnnotationsSolution& solution) {
      return (solution.rig_from_station.translation_m - left.camera_from_station.translation_m)
          .norm();
    };
    single += off_m(alone);
    together += off_m(both);
    const auto stated = [](const AnnotationsSolution& solution) {
      const double noise = std::max(1.0, solution.noise_factor);
      return solution.covariance.trace() / (noise * noise);
    };
    EXPECT_LT(stated(both), stated(alone));
  }
  EXPECT_LT(together, 0.7 * single);
}

TEST(SolveAnnotations, RigFrame_DoesNotChangeTheSolution) {
  Random random = randomFor("SolveMarks.RigFrame");
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 8, 0, 0.5);
  const AnnotationsSolution plain = solved(scene.views());
  scene.view.camera_from_rig = test::randomPose(random);
  const AnnotationsSolution framed = solved(scene.views());
  ASSERT_EQ(framed.camera_from_station.size(), 1u);
  EXPECT_LT(distance(plain.rig_from_station, framed.camera_from_station[0]), 1e-8);
  EXPECT_LT((cameraCovariance(framed, scene.view) - plain.covariance).norm(),
            1e-6 * plain.covariance.norm());
}

TEST(SolveAnnotations, LeavingOneOutIsSolvingWithoutIt) {
  Random random = randomFor("SolveMarks.LeaveOneOut");
  const AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 6, 2, 0.5);
  const AnnotationsSolution whole = solved(scene.views());
  const std::vector<LeftOut> left_out = leaveOneOut(scene.views(), whole);
  ASSERT_EQ(left_out.size(), 8u);
  for (std::size_t i = 0; i < 6; ++i) {
    AnnotatedScene without = scene;
    without.view.annotations.points[i].enabled = false;
    ASSERT_TRUE(left_out[i].determined);
    const double rotation_rad =
        solved(without.views())
            .rig_from_station.rotation.angularDistance(whole.rig_from_station.rotation);
    // Steps on lines converge linearly: they hold the lines' scale fixed.
    EXPECT_NEAR(left_out[i].rotation_mrad, 1000.0 * rotation_rad, 1e-4);
    EXPECT_GT(left_out[i].translation_mm, 0.0);
  }
}

TEST(SolveAnnotations, LeaveOneOut_WithoutRedundancy_IsUndetermined) {
  Random random = randomFor("SolveMarks.Exact");
  const AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 3, 0, 0.0);
  SolveAnnotationsOptions options;
  options.rig_from_station_guess = scene.camera_from_station;
  const AnnotationsSolution solution = solved(scene.views(), options);
  EXPECT_EQ(solution.degrees_of_freedom, 0);
  EXPECT_EQ(solution.noise_factor, 1.0);
  for (const LeftOut& left_out : leaveOneOut(scene.views(), solution))
    EXPECT_FALSE(left_out.determined);
}

TEST(SolveAnnotations, DisabledOrIncompletePairs_AreNotUsed) {
  Random random = randomFor("SolveMarks.Off");
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 6, 0, 0.4);
  const AnnotationsSolution before = solved(scene.views());
  auto& points = scene.view.annotations.points;
  const Eigen::Vector3d place_m(1.0, 2.0, 3.0);
  points.insert(points.begin(), {"off", place_m, Eigen::Vector2d(1.0, 2.0), 1.0, false, false, ""});
  points.push_back({"half", place_m, {}, 1.0, true, false, ""});
  const AnnotationsSolution after = solved(scene.views());
  EXPECT_EQ(before.rig_from_station, after.rig_from_station);
  ASSERT_FALSE(after.annotations.empty());
  EXPECT_EQ(after.annotations[0].address, (AnnotationAddress{0, AnnotationKind::kPoint, 1}));
}

TEST(SolveAnnotations, SaysWhyThereIsNoPose) {
  Random random = randomFor("SolveMarks.Reason");
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 3, 0, 0.0);
  EXPECT_THAT(solveAnnotations(scene.views(), {}).reason, HasSubstr("needs at least 4"));
  scene = randomScene(random, CameraModel::kPinhole, 6, 0, 0.0);
  for (PointPair& point : scene.view.annotations.points)
    point.point_in_station_m = Eigen::Vector3d(point.point_in_station_m->x(), 0.0, 0.0);
  EXPECT_THAT(solveAnnotations(scene.views(), {}).reason, HasSubstr("one line"));
  EXPECT_THAT(solveAnnotations({}, {}).reason, HasSubstr("too few"));
}

struct Setting {
  const char* name;
  CameraModel model;
  int points;
  int lines;
  double noise_px;
  double stated_factor;  ///< the stated sigma by the noise
};

class SolveAnnotationsStatistics : public testing::TestWithParam<Setting> {};

/// e' C^-1 e / 6 with the variance estimated from f degrees of freedom follows F(6, f).
TEST_P(SolveAnnotationsStatistics, NormalizedErrorSquaredHasTheRightMean) {
  const Setting& setting = GetParam();
  Random random = randomFor(setting.name);
  double sum = 0.0, noise_squared = 0.0;
  constexpr int kDraws = 1000;
  int freedom = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    AnnotatedScene scene =
        randomScene(random, setting.model, setting.points, setting.lines, setting.noise_px);
    for (PointPair& point : scene.view.annotations.points) point.sigma_px *= setting.stated_factor;
    for (LinePair& line : scene.view.annotations.lines) line.sigma_px *= setting.stated_factor;
    const AnnotationsSolution solution = solved(scene.views());
    freedom = solution.degrees_of_freedom;
    ASSERT_EQ(freedom, 2 * (setting.points + setting.lines) - 6);
    const Vector6d error =
        perturbationBetween(solution.rig_from_station, scene.camera_from_station);
    Matrix6d information;
    ASSERT_TRUE(invert(solution.covariance, information));
    const double variance = solution.noise_factor * solution.noise_factor;
    information *= std::max(1.0, variance) / variance;
    sum += error.dot(information.selfadjointView<Eigen::Lower>() * error) / 6.0;
    noise_squared += variance;
  }
  const double f = freedom;
  const double mean = f / (f - 2.0);
  const double variance = 2.0 * f * f * (6.0 + f - 2.0) / (6.0 * (f - 2.0) * (f - 2.0) * (f - 4.0));
  EXPECT_NEAR(sum / kDraws, mean, 4.0 * std::sqrt(variance / kDraws));
  const double expected = 1.0 / (setting.stated_factor * setting.stated_factor);
  EXPECT_NEAR(noise_squared / kDraws, expected, 4.0 * expected * std::sqrt(2.0 / f / kDraws));
}

/// Four annotations often have residuals far below their sigma by chance.
TEST(SolveAnnotations, SigmasOfFourPoints_HoldTheErrors) {
  Random random = randomFor("SolveAnnotations.FourPoints");
  std::vector<double> errors;
  for (int draw = 0; draw < 400; ++draw) {
    AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 0, 0, 0.0);
    for (const Eigen::Vector3d& place_m :
         {Eigen::Vector3d(0.1, 0.1, 0.1), Eigen::Vector3d(-0.1, -0.1, 0.1),
          Eigen::Vector3d(-0.1, 0.1, -0.1), Eigen::Vector3d(0.1, -0.1, -0.1)})
      addPoint(scene.view, scene.camera_from_station, place_m, 1.0, 1.0, random);
    if (scene.view.annotations.points.size() < 4) continue;  // outside of the image
    SolveAnnotationsOptions options;
    options.rig_from_station_guess = scene.camera_from_station;
    const AnnotationsSolution solution = solved(scene.views(), options);
    const Vector6d sigma = solution.covariance.diagonal().cwiseSqrt();
    const Vector6d error =
        perturbationBetween(scene.camera_from_station, solution.rig_from_station);
    for (int i = 0; i < 6; ++i) errors.push_back(error[i] / sigma[i]);
  }
  ASSERT_GT(errors.size(), 1000u);
  test::expectGaussianCoverage(errors, true);
}

/// The least squares from the truth are the least of all.
TEST(SolveAnnotations, FourPointsWithoutAGuess_HaveTheLeastSquares) {
  Random random = randomFor("SolveAnnotations.FourPoints.Global");
  for (int draw = 0; draw < 200; ++draw) {
    const AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 4, 0, 1.0);
    SolveAnnotationsOptions options;
    options.rig_from_station_guess = scene.camera_from_station;
    EXPECT_LE(solved(scene.views()).rms_px, solved(scene.views(), options).rms_px + 1e-6) << draw;
  }
}

/// Six points, or a plane of five, `size_m` wide, at a distance, seen about 32 px wide.
AnnotatedScene distantScene(Random& random, double size_m, double distance_m, bool flat) {
  AnnotatedScene scene;
  scene.view.name = "camera";
  scene.view.camera = test::makePinhole(1280, 960, 32.0 * distance_m / size_m);
  scene.camera_from_station = test::randomCameraFromStation(random, distance_m);
  scene.camera_from_station.translation_m = {0.3 * size_m, -0.2 * size_m, distance_m};
  if (flat)
    scene.camera_from_station.rotation =
        rotationExp({0.7, 0.2, 0.0}) * rotationExp({0.0, 0.0, random.uniform(-kPi, kPi)});
  const std::array<Eigen::Vector3d, 6> corners = {{{-1.0, -1.0, 0.0},
                                                   {1.0, -0.9, 0.0},
                                                   {0.8, 1.0, 0.0},
                                                   {-1.0, 0.7, 0.0},
                                                   {0.1, 0.2, 0.0},
                                                   {0.2, -0.3, 0.9}}};
  for (std::size_t i = 0; i < (flat ? 5u : 6u); ++i)
    EXPECT_TRUE(addPoint(scene.view, scene.camera_from_station, 0.5 * size_m * corners[i], 0.0, 1.0,
                         random));
  return scene;
}

TEST(SolveAnnotations, FarAndSmallObjects_AreSolvedWithoutAGuess) {
  Random random = randomFor("SolveAnnotations.Far");
  struct Place {
    double size_m, distance_m;
  };
  for (const auto& [size_m, distance_m] :
       {Place{0.2, 1.0}, Place{0.2, 36.0}, Place{0.2, 40.0}, Place{0.2, 300.0}, Place{2.0, 400.0},
        Place{10.0, 5000.0}, Place{2e-4, 1e-3}, Place{2e-4, 0.01}})
    for (const bool flat : {false, true}) {
      const AnnotatedScene scene = distantScene(random, size_m, distance_m, flat);
      const AnnotationsSolution solution = solved(scene.views());
      EXPECT_LT(solution.rms_px, 1e-5) << size_m << " " << distance_m << " " << flat;
      EXPECT_LT((solution.rig_from_station.translation_m - scene.camera_from_station.translation_m)
                    .norm(),
                1e-4 * distance_m)
          << size_m << " " << distance_m << " " << flat;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, SolveAnnotationsStatistics,
    testing::Values(Setting{"Points", CameraModel::kPinhole, 10, 0, 0.3, 1.0},
                    Setting{"LargeNoise", CameraModel::kPinhole, 20, 0, 1.0, 1.0},
                    Setting{"SmallNoise", CameraModel::kBrownConrady, 8, 0, 0.1, 1.0},
                    Setting{"Fisheye", CameraModel::kKannalaBrandt, 10, 0, 0.2, 1.0},
                    Setting{"PointsAndLines", CameraModel::kBrownConrady, 6, 6, 0.3, 1.0},
                    Setting{"SigmasStatedWrong", CameraModel::kPinhole, 12, 0, 0.5, 3.0}),
    [](const testing::TestParamInfo<Setting>& setting) { return setting.param.name; });

}  // namespace
}  // namespace boresight::sessions
