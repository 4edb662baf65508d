// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/base/math.h"
#include "core/base/random.h"
#include "sessions/evaluation/model_error.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using Eigen::Vector3d;

Pose poseOf(const Vector3d& rotation_rad, const Vector3d& translation_m) {
  return {rotationExp(rotation_rad), translation_m};
}

/// The estimate for which E = camera_true_from_camera_estimated is the given one.
Pose estimateFor(const Pose& truth, const Pose& true_from_estimated) {
  return true_from_estimated.inverse() * truth;
}

const Pose kTruth = poseOf(Vector3d(0.3, -0.7, 1.1), Vector3d(0.02, -0.03, 0.4));

/// Of an estimate that is turned against the truth and not moved.
PoseError errorOfTurn(const Vector3d& rotation_rad) {
  return poseError(kTruth, estimateFor(kTruth, poseOf(rotation_rad, Vector3d::Zero())),
                   std::nullopt);
}

TEST(PoseError, IsMeasuredAtTheEndEffector) {
  // A tilt of 10 mrad about x moves a point 0.4 m ahead by (0, -0.4 sin, 0.4 (cos - 1)).
  const Pose effector = poseOf(Vector3d(1, 2, 3), Vector3d(0, 0, 0.4));
  const PoseError error = poseError(
      kTruth, estimateFor(kTruth, poseOf(Vector3d(0.01, 0, 0), Vector3d::Zero())), effector);
  EXPECT_NEAR(error.lateral_mm, 400.0 * std::sin(0.01), 1e-9);
  EXPECT_NEAR(error.normal_mm, 400.0 * (std::cos(0.01) - 1.0), 1e-9);
  // A compensating shift makes it vanish there, and appear at the camera.
  const Pose compensated =
      poseOf(Vector3d(0.01, 0, 0), Vector3d(0, 0.4 * std::sin(0.01), 0.4 * (1.0 - std::cos(0.01))));
  EXPECT_NEAR(poseError(kTruth, estimateFor(kTruth, compensated), effector).lateral_mm, 0.0, 1e-9);
  EXPECT_NEAR(poseError(kTruth, estimateFor(kTruth, compensated), std::nullopt).lateral_mm,
              400.0 * std::sin(0.01), 1e-9);
}

TEST(PoseError, KeepsTinyAnglesAndHalfTurnsExact) {
  EXPECT_NEAR(errorOfTurn({1e-9, 0, 0}).rotation_mrad, 1e-6, 1e-11);
  EXPECT_NEAR(errorOfTurn({0, 0, 3.1}).in_plane_mrad, 3100.0, 1e-9);
  EXPECT_NEAR(errorOfTurn({0, 0, -3.1}).in_plane_mrad, -3100.0, 1e-9);
  EXPECT_NEAR(errorOfTurn({kPi, 0, 0}).rotation_mrad, 1000.0 * kPi, 1e-9);
}

/// Independent of the formulas above: the tilt is the angle between the optical axes, the whole
/// rotation follows from the trace.
TEST(PoseError, AgreesWithAnglesTakenFromMatrices) {
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Pose e =
        poseOf(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
               Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.3));
    const PoseError error = poseError(kTruth, estimateFor(kTruth, e), std::nullopt);
    const Eigen::Matrix3d r = e.matrix();
    EXPECT_NEAR(error.rotation_mrad, 1e3 * std::acos(r(2, 2)), 1e-6);
    EXPECT_NEAR(error.geodesic_mrad, 1e3 * std::acos((r.trace() - 1.0) / 2.0), 1e-6);
    // Taking the tilt away leaves the twist: R = swing * twist, and swing turns z to R z.
    const Eigen::Quaterniond swing =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), r.col(2));
    const Eigen::Matrix3d twist = swing.toRotationMatrix().transpose() * r;
    EXPECT_NEAR(error.in_plane_mrad, 1e3 * std::atan2(twist(1, 0), twist(0, 0)), 1e-6);
    EXPECT_NEAR(error.normal_mm, 300.0, 1e-9);
    EXPECT_NEAR(error.lateral_mm, 1e3 * e.translation_m.head<2>().norm(), 1e-9);
    EXPECT_FALSE(error.projection_px);
  }
}

TEST(ProjectionError, AveragesDistancesOfVerticesAndCountsADiagonalForTheHidden) {
  const Camera camera = test::makePinhole(640, 480, 1000.0);
  const Pose front = poseOf(Vector3d::Zero(), Vector3d(0, 0, 2));
  // Shifted by 1 mm in x at 1 m and 4 m: 1 px and 0.25 px.
  std::vector<Eigen::Vector3f> vertices = {{0, 0, -1}, {0.5F, 0.25F, 2}};
  const Pose shifted = poseOf(Vector3d::Zero(), Vector3d(0.001, 0, 2));
  EXPECT_NEAR(projectionError(camera, front, shifted, vertices).value(), 0.625, 1e-9);
  EXPECT_NEAR(*projectionError(camera, front, front, vertices), 0.0, 1e-12);
  vertices = {{0, 0, 0}};
  const Pose behind = poseOf(Vector3d::Zero(), Vector3d(0, 0, -2));
  EXPECT_NEAR(*projectionError(camera, front, behind, vertices), 800.0, 1e-12);
  EXPECT_FALSE(projectionError(camera, behind, front, vertices).has_value());
  EXPECT_FALSE(projectionError(camera, front, front, {}).has_value());
}

TEST(MeetsRequirement, JudgesWhatIsNamed) {
  const Requirement normal{0.4, {}, {}, {}}, rotation{{}, {}, 0.25, {}}, pixels{{}, {}, {}, 5.0};
  const struct {
    PoseError error;
    Requirement requirement;
    bool meets, gross;
  } cases[] = {{{-0.4, 100.0, 0.0, 0.0, 0.0, {}}, normal, true, false},
               {{-0.41, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, false},
               {{0.41, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, false},
               {{-1.21, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, true},
               {{-9.0, 9.0, 4.36, 0.0, 0.0, {}}, rotation, true, false},
               {{-9.0, 9.0, 4.37, 0.0, 0.0, {}}, rotation, false, false},
               {{-9.0, 9.0, 13.1, 0.0, 0.0, {}}, rotation, false, true},
               {{-9.0, 100.0, 0.0, 0.0, 0.0, {}}, {{}, 100.0, {}, {}}, true, false},
               {{-9.0, 100.0, 0.0, 0.0, 0.0, {}}, {{}, 99.0, {}, {}}, false, false},
               {{0.0, 0.0, 0.0, 0.0, 0.0, {}}, pixels, false, true},  // it is not known
               {{0.0, 0.0, 0.0, 0.0, 0.0, 5.0}, pixels, true, false},
               {{0.0, 0.0, 0.0, 0.0, 0.0, 15.1}, pixels, false, true}};
  for (const auto& judged : cases) {
    EXPECT_EQ(meetsRequirement(judged.error, judged.requirement), judged.meets) << &judged - cases;
    EXPECT_EQ(isGross(judged.error, judged.requirement), judged.gross) << &judged - cases;
  }
}

TEST(StatisticsOf, HandComputedValues) {
  const Statistics result =
      statistics(std::vector<double>{2.0, -4.0, 4.0, 4.0, -5.0, 5.0, 1.0, 9.0});
  EXPECT_EQ(result.count, 8);
  EXPECT_DOUBLE_EQ(result.mean, 2.0);
  EXPECT_DOUBLE_EQ(result.deviation, std::sqrt((0.0 + 36 + 4 + 4 + 49 + 9 + 1 + 49) / 8.0));
  EXPECT_DOUBLE_EQ(result.maximum, 9.0);
  EXPECT_DOUBLE_EQ(statistics(std::vector<double>{-3.0, 1.0}).maximum, 3.0);
  EXPECT_EQ(statistics({}).count, 0);
  EXPECT_EQ(statistics({}).mean, 0.0);
}

TEST(PoseSigma, IsWhatPoseErrorsOfRandomPosesSpread) {
  Random random = test::randomFor("PoseSigma");
  const Pose pose = test::randomCameraFromStation(random, 0.5);
  Pose effector;
  effector.translation_m = {0.02, -0.05, 0.4};
  Matrix6d root = Matrix6d::Zero();  // covariance = root root', correlated
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) root(row, column) = 1e-4 * random.normal();
  const auto sigma = poseSigma(root * root.transpose(), effector);
  ASSERT_TRUE(sigma);
  double normal = 0.0, lateral = 0.0, rotation = 0.0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    // The estimate is the truth displaced; seen from the truth that is the displacement back.
    const PoseError error =
        poseError(perturbed(root * test::normalVector6(random), pose), pose, effector);
    normal += error.normal_mm * error.normal_mm / kCount;
    lateral += error.lateral_mm * error.lateral_mm / kCount;
    rotation += error.rotation_mrad * error.rotation_mrad / kCount;
  }
  EXPECT_NEAR(sigma->normal_mm / std::sqrt(normal), 1.0, 0.03);
  EXPECT_NEAR(sigma->lateral_mm / std::sqrt(lateral), 1.0, 0.03);
  EXPECT_NEAR(sigma->out_of_plane_mrad / std::sqrt(rotation), 1.0, 0.03);
}

TEST(PoseSigma, IsNothingWithoutACovariance) {
  EXPECT_FALSE(poseSigma(Matrix6d::Zero(), std::nullopt));
  Matrix6d covariance = Matrix6d::Identity();
  for (const double variance : {-1.0, std::numeric_limits<double>::infinity()}) {
    covariance(2, 2) = variance;
    EXPECT_FALSE(poseSigma(covariance, std::nullopt));
  }
}

TEST(SigmaExcess, NamesWhatIsWorstByFiguresAndWhere) {
  Vector6d sigma;
  sigma << 1e-3, 0.0, 0.0, 3e-3, 0.0, 10.4e-3;
  const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
  EXPECT_EQ(sigmaExcessText(covariance, {}, {0.4, 0.4, 0.25, {}}),
            "10.4 mm along the view axis at the camera, 26 times the 0.4 mm required");
  const Pose effector;
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, 0.5, 0.25, {}}),
            "3 mm across the view axis at the end effector, 6 times the 0.5 mm required");
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, {}, 0.01, {}}),
            "0.0573 deg of the view axis, 5.73 times the 0.01 deg required");
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, 4.0, 0.25, {}}), "");
  EXPECT_EQ(sigmaExcessText(Matrix6d::Zero(), effector, {0.0, 0.0, 0.0, {}}), "");
}

/// The corners of a cube of side 2 mm about the origin.
std::vector<Eigen::Vector3f> cube() {
  std::vector<Eigen::Vector3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? 1e-3f : -1e-3f, i & 2 ? 1e-3f : -1e-3f, i & 4 ? 1e-3f : -1e-3f);
  return corners;
}

struct ModelError : testing::Test {
  const Camera camera = test::makePinhole(200, 200, 100.0);
  const std::vector<Eigen::Vector3f> vertices = cube();
  const ModelView model{vertices, nullptr};
};

std::vector<Eigen::Vector3f> randomVertices(Random& random, int count) {
  std::vector<Eigen::Vector3f> vertices;
  for (int i = 0; i < count; ++i)
    vertices.push_back(test::randomVector(random, 0.05).cast<float>());
  return vertices;
}

TEST_F(ModelError, ShiftMovesEveryVertexByItself) {
  const PoseError error =
      wholeError(camera, poseOf(Vector3d::Zero(), {0.0, 0.0, 2.0}),
                 poseOf(Vector3d::Zero(), {0.3e-3, 0.0, 2.0 + 0.4e-3}), std::nullopt, model);
  EXPECT_NEAR(*error.mssd_mm, 0.5, 1e-9);
  EXPECT_NEAR(*error.add_mm, 0.5, 1e-9);
  // A corner's nearest is its own: all others are at least 1.7 mm away.
  EXPECT_NEAR(*error.adi_mm, 0.5, 1e-9);
  EXPECT_NEAR(error.lateral_mm, 0.3, 1e-9);
  EXPECT_NEAR(error.normal_mm, -0.4, 1e-9);
}

TEST_F(ModelError, QuarterTurnAndHidingOfACube) {
  const Pose truth = poseOf(Vector3d::Zero(), {0.0, 0.0, 1.0});
  const Pose estimate = poseOf({0.0, 0.0, 0.5 * kPi}, {0.0, 0.0, 1.0});
  // Every corner goes to the next one, a side away; none lies where none was.
  EXPECT_NEAR(surfaceDistance_m(truth, estimate, model), 2e-3, 1e-9);
  EXPECT_NEAR(meanDistance_m(truth, estimate, model), 2e-3, 1e-9);
  EXPECT_NEAR(meanNearestDistance_m(truth, estimate, model), 0.0, 1e-9);
  // The nearer corners, at 0.999 m, move farthest: 100 px * 2 mm / 0.999 m.
  EXPECT_NEAR(*projectionDistance_px(camera, truth, estimate, model), 0.2 / 0.999, 1e-6);
  // A vertex that only the estimate hides counts as a diagonal.
  const Pose behind = poseOf(Vector3d::Zero(), {0.0, 0.0, -1.0});
  EXPECT_NEAR(*projectionDistance_px(camera, truth, behind, model), std::hypot(200.0, 200.0), 1e-9);
  EXPECT_FALSE(projectionDistance_px(camera, behind, truth, model));
}

TEST_F(ModelError, DiscreteSymmetryCountsInEveryError) {
  Symmetries symmetries;
  symmetries.discrete = {poseOf({0.0, 0.0, 0.5 * kPi}, {0.0, 0.0, 0.0})};
  const Pose truth = poseOf({0.4, 0.1, -0.3}, {0.01, -0.02, 1.0});
  const Pose turned = truth * symmetries.discrete[0];
  const PoseError none = wholeError(camera, truth, turned, std::nullopt, {vertices, &symmetries});
  for (const double value :
       {none.normal_mm, none.lateral_mm, none.rotation_mrad, none.in_plane_mrad, none.geodesic_mrad,
        *none.projection_px, *none.mssd_mm, *none.mspd_px, *none.add_mm, *none.adi_mm})
    EXPECT_NEAR(value, 0.0, 1e-6);
  // Not the other way about: the symmetry that is not listed is an error.
  const Pose back = truth * symmetries.discrete[0].inverse();
  EXPECT_NEAR(1e3 * surfaceDistance_m(truth, back, {vertices, &symmetries}), 2.0, 1e-6);
}

/// BOP's own list: turns in 315 steps after each discrete symmetry.
double bruteForceSurfaceDistance(const Pose& truth, const Pose& estimate,
                                 const std::vector<Eigen::Vector3f>& vertices,
                                 const Symmetries& symmetries) {
  double best = 1e9;
  std::vector<Pose> discrete = symmetries.discrete;
  discrete.emplace_back();
  for (const Pose& pose : discrete)
    for (int i = 0; i < 315; ++i) {
      const AxisSymmetry& axis = symmetries.continuous[0];
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(i * 2.0 * kPi / 315, axis.axis).toRotationMatrix();
      double largest = 0.0;
      for (const Eigen::Vector3f& vertex : vertices) {
        const Vector3d p = pose * vertex.cast<double>();
        const Vector3d same = turn * (p - axis.point_m) + axis.point_m;
        largest = std::max(largest, (truth * same - estimate * vertex.cast<double>()).norm());
      }
      best = std::min(best, largest);
    }
  return best;
}

TEST_F(ModelError, TurnsAboutAnAxisAreTheChallengesAndFiner) {
  Random random = test::randomFor("ModelError.Turns");
  for (int i = 0; i < 10; ++i) {
    const auto cloud = randomVertices(random, 40);
    Symmetries symmetries;
    symmetries.discrete = {poseOf({kPi, 0.0, 0.0}, {0.0, 0.002, 0.0})};
    symmetries.continuous = {{Vector3d(0.0, 0.6, 0.8), Vector3d(0.01, 0.0, 0.003)}};
    const Pose truth = test::randomPose(random);
    const Pose equal = truth * turnAbout(symmetries.continuous[0], random.uniform(0.0, 2.0 * kPi)) *
                       symmetries.discrete[0];
    const ModelView turned_model{cloud, &symmetries};
    EXPECT_NEAR(surfaceDistance_m(truth, equal, turned_model), 0.0, 1e-9);
    EXPECT_NEAR(meanDistance_m(truth, equal, turned_model), 0.0, 1e-9);
    Vector6d offset;
    for (int k = 0; k < 6; ++k) offset[k] = random.uniform(-0.03, 0.03);
    const Pose estimate = perturbed(offset, equal);
    const double sampled = bruteForceSurfaceDistance(truth, estimate, cloud, symmetries);
    const double found = surfaceDistance_m(truth, estimate, turned_model);
    EXPECT_LE(found, sampled + 1e-12);
    // Half a step of 0.02 rad moves nothing by more than 0.01 times its distance from the axis.
    EXPECT_GE(found, sampled - 0.01 * 0.1);
  }
}

TEST_F(ModelError, NearestEquivalent_IsTheTruthThatErrorsAreMeasuredTo) {
  Random random = test::randomFor("ModelError.Nearest");
  const auto cloud = randomVertices(random, 40);
  Symmetries symmetries;
  symmetries.continuous = {{Vector3d(0.0, 0.6, 0.8), Vector3d(0.01, 0.0, 0.003)}};
  const ModelView model{cloud, &symmetries};
  const Pose truth = test::randomPose(random);
  Vector6d offset;
  for (int k = 0; k < 6; ++k) offset[k] = random.uniform(-0.01, 0.01);
  const Pose estimate = perturbed(offset, truth * turnAbout(symmetries.continuous[0], 2.5));
  const Pose nearest = nearestEquivalent(truth, estimate, model);
  EXPECT_NEAR(surfaceDistance_m(nearest, estimate, {cloud}),
              surfaceDistance_m(truth, estimate, model), 1e-9);
  EXPECT_EQ(nearestEquivalent(truth, truth, model), truth) << "to the bit";
  EXPECT_EQ(nearestEquivalent(truth, estimate, {cloud}), truth) << "without symmetries";
}

/// A motion and the same without its turn about the axis move vertices apart by a turn alone.
TEST_F(ModelError, DeterminedCovariance_HasNoTurnAboutTheAxis) {
  Random random = test::randomFor("ModelError.Determined");
  const auto tube = randomVertices(random, 60);
  Symmetries symmetries;
  symmetries.continuous = {{Vector3d(0.0, 0.6, 0.8), Vector3d(0.01, 0.0, 0.003)}};
  const ModelView model{tube, &symmetries};
  const Pose pose = poseOf({0.4, 0.1, -0.3}, {0.01, -0.02, 0.5});
  const Vector6d turn = symmetricMotions(pose, symmetries);
  const Pose turned = pose * turnAbout(symmetries.continuous[0], 1e-6);
  EXPECT_LT((perturbationBetween(pose, turned) - 1e-6 * turn).norm(), 1e-11);
  const Matrix6d known = 1e-6 * Matrix6d::Identity();
  const Matrix6d determined = determinedCovariance(known, pose, model);
  EXPECT_LT((determinedCovariance(known + 10.0 * turn * turn.transpose(), pose, model) - determined)
                .norm(),
            1e-12);
  EXPECT_LT((determinedCovariance(determined, pose, model) - determined).norm(), 1e-16);
  // Motions that remain move the vertices across the turn on the whole.
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(determined);
  EXPECT_LT(eigen.eigenvalues()[0], 1e-18);
  EXPECT_GT(eigen.eigenvalues()[1], 1e-9);
  EXPECT_EQ(determinedCovariance(known, pose, {tube}), known);
}

TEST_F(ModelError, TubeTurnedAboutItsAxisIsNoError) {
  Random random = test::randomFor("ModelError.Tube");
  const auto tube = randomVertices(random, 60);
  Symmetries symmetries;
  symmetries.continuous = {{Vector3d::UnitZ(), Vector3d::Zero()}};
  const Pose truth = poseOf({0.1, -0.2, 0.0}, {0.01, 0.02, 0.5});
  const Pose estimate = truth * poseOf({0.0, 0.0, 1.2345}, {0.0, 0.0, 0.0});
  const PoseError error = wholeError(camera, truth, estimate, std::nullopt, {tube, &symmetries});
  EXPECT_NEAR(error.geodesic_mrad, 0.0, 1e-5);
  EXPECT_NEAR(error.in_plane_mrad, 0.0, 1e-5);
  EXPECT_NEAR(*error.projection_px, 0.0, 1e-6);
  EXPECT_NEAR(*error.mspd_px, 0.0, 1e-6);
}

TEST(NearestPoint, IsWhatBruteForceFinds) {
  Random random = test::randomFor("NearestPoint");
  for (const int count : {1, 2, 3, 50, 777}) {
    std::vector<Vector3d> points;
    for (const Eigen::Vector3f& v : randomVertices(random, count))
      points.push_back(v.cast<double>());
    points.push_back(points.front());  // the same twice
    const NearestPoint nearest(points);
    for (int i = 0; i < 100; ++i) {
      const Vector3d query = 1.5 * randomVertices(random, 1)[0].cast<double>();
      double expected = 1e9;
      for (const Vector3d& p : points) expected = std::min(expected, (p - query).norm());
      EXPECT_DOUBLE_EQ(nearest.distance(query), expected);
    }
  }
  EXPECT_TRUE(std::isinf(NearestPoint({}).distance({0.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace boresight::sessions
