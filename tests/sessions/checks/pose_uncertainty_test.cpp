// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/checks/edge_evidence.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "core/geometry/cahv_model.h"
#include "sessions/checks/generalized_eigen.h"
#include "sessions/io/cameras/camera_file.h"

#include "tests/sessions/checks/drawn_box.h"
#include "tests/support/coverage.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::DrawnBox;
using test::randomFor;
using test::randomPose;

/// Distances along the normals between what a wrong camera predicts from a pose and the true
/// places.
Eigen::VectorXd misfit(const PredictedEdges& edges, const Camera& camera, const Pose& pose) {
  Eigen::VectorXd distances(static_cast<Eigen::Index>(edges.places.size()));
  for (std::size_t i = 0; i < edges.places.size(); ++i) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(project(camera, pose * edges.places[i].point_in_station_m, pixel));
    distances(static_cast<Eigen::Index>(i)) =
        edges.places[i].normal.dot(pixel - edges.places[i].pixel);
  }
  return distances;
}

/// The pose of least squares, by derivatives that are differences.
Pose fitted(const PredictedEdges& edges, const Camera& camera, Pose pose) {
  for (int round = 0; round < 8; ++round) {
    const Eigen::VectorXd current = misfit(edges, camera, pose);
    Eigen::MatrixXd slopes(current.size(), 6);
    for (int i = 0; i < 6; ++i)
      slopes.col(i) =
          (misfit(edges, camera, perturbed(1e-6 * Vector6d::Unit(i), pose)) - current) / 1e-6;
    const Matrix6d information = slopes.transpose() * slopes;
    const Vector6d gradient = slopes.transpose() * current;
    pose = perturbed(-information.llt().solve(gradient), pose);
  }
  return pose;
}

TEST(PoseUncertainty, ThePoseFollowsTheCameraAsAFitWithTheWrongCameraDoes) {
  const DrawnBox box;
  const PredictedEdges edges = box.edges();
  const auto follow = poseByCamera(edges.places, box.camera_, box.camera_from_station_);
  ASSERT_TRUE(follow);
  for (int parameter = 0; parameter < 3; ++parameter) {
    Camera wrong = box.camera_;
    const double change_px = 0.2;
    if (parameter == 0) wrong.fx = wrong.fy = box.camera_.fx + change_px;
    if (parameter == 1) wrong.cx += change_px;
    if (parameter == 2) wrong.cy += change_px;
    ASSERT_EQ(prepareCamera(wrong), Status::kOk);
    const Vector6d found = perturbationBetween(box.camera_from_station_,
                                               fitted(edges, wrong, box.camera_from_station_));
    const Vector6d expected = change_px * follow->col(parameter);
    EXPECT_LT((found - expected).norm(), 0.01 * expected.norm()) << parameter;
  }
}

/// The box's camera with a CAHVOR lens, and places that are exactly where it sees them.
struct VectorScene {
  DrawnBox box;
  Camera camera;
  PredictedEdges edges;
  Random random = randomFor("PoseUncertainty.Vectors");
  /// Of a covariance of all vectors with correlations between all of them.
  Eigen::MatrixXd root{18, 18};

  VectorScene() {
    CahvModel vectors = cahvFromCamera(box.camera_, Pose());
    vectors.model = CameraModel::kCahvor;
    vectors.o = Eigen::Vector3d(0.01, -0.02, 1.0).normalized();
    vectors.r = {1e-4, -0.05, 0.02};
    Pose own;
    EXPECT_EQ(cameraFromCahv(vectors, 800, 600, camera, own), Status::kOk);
    edges = predictEdges(camera, box.scene_.view(), box.camera_from_station_);
    edges.places = thinned(edges.places, 150);
    for (EdgePlace& place : edges.places)
      EXPECT_TRUE(
          project(camera, box.camera_from_station_ * place.point_in_station_m, place.pixel));
    for (int i = 0; i < 18; ++i) {
      const double sigma = i < 3 ? 2e-4 : i < 6 ? 1e-4 : i < 12 ? 0.2 : i < 15 ? 1e-4 : 1e-3;
      for (int j = 0; j < 18; ++j) root(i, j) = sigma / std::sqrt(18.0) * random.normal();
    }
  }
};

/// The pose that is fitted to the same places with other vectors, in the frame of the right ones.
Pose fittedWith(const VectorScene& scene, const Eigen::VectorXd& change) {
  CahvModel vectors = cahvFromCamera(scene.camera, Pose());
  Eigen::Index first = 0;
  forVectors(vectors, [&](const char*, Eigen::Vector3d& vector) {
    vector += change.segment<3>(first);
    first += 3;
  });
  Camera wrong;
  Pose wrong_from_camera;
  EXPECT_EQ(cameraFromCahv(vectors, 800, 600, wrong, wrong_from_camera), Status::kOk);
  return wrong_from_camera.inverse() *
         fitted(scene.edges, wrong, wrong_from_camera * scene.box.camera_from_station_);
}

/// Range of the eigenvalues of `covariance` in units of `expected`: 1 and 1 where they are equal.
Eigen::Vector2d ratios(const Matrix6d& covariance, const Matrix6d& expected) {
  const auto eigen = generalizedEigen<6>(covariance, expected);
  return eigen ? Eigen::Vector2d(eigen->values[0], eigen->values[5])
               : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

TEST(PoseUncertainty, TheCamerasCovariance_GivesThatOfPosesFittedWithDrawnCameras) {
  VectorScene scene;
  const Eigen::MatrixXd vectors = scene.root * scene.root.transpose();
  const auto by = poseByVectors(scene.edges.places, scene.camera, scene.box.camera_from_station_);
  ASSERT_TRUE(by);
  const Matrix6d expected = *by * vectors * by->transpose();
  constexpr int kDraws = 400;
  Matrix6d sampled = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd normal(18);
    for (double& value : normal) value = scene.random.normal();
    const Vector6d moved =
        perturbationBetween(scene.box.camera_from_station_, fittedWith(scene, scene.root * normal));
    sampled += moved * moved.transpose() / kDraws;
  }
  // Of 400 draws the eigenvalues lie between 0.77 and 1.26 (Marchenko-Pastur).
  const Eigen::Vector2d found = ratios(sampled, expected);
  EXPECT_GT(found[0], 0.7);
  EXPECT_LT(found[1], 1.35);
  const Eigen::MatrixXd diagonal = vectors.diagonal().asDiagonal();
  const Eigen::Vector2d without = ratios(sampled, Matrix6d(*by * diagonal * by->transpose()));
  EXPECT_TRUE(without[0] < 0.7 || without[1] > 1.35) << "the correlations count";
}

TEST(PoseUncertainty, TheCamerasCovariance_CountsInPlaceOfTheStatedSigmas) {
  const VectorScene scene;
  SessionCase session_case;
  session_case.camera = scene.camera;
  session_case.mesh_scale_sigma = 0.0;
  session_case.camera_covariance = CameraCovariance{scene.root * scene.root.transpose()};
  const auto termOf = [&](const SessionCase& known) {
    return poseCovariance(known, scene.box.scene_.view(), scene.box.camera_from_station_,
                          1e-12 * Matrix6d::Identity())
        .calibration;
  };
  const Matrix6d term = termOf(session_case);
  session_case.calibration_sigma = StatedCalibration{0.1, 100.0};
  EXPECT_EQ(termOf(session_case), term);
  session_case.camera_covariance->of_vectors *= 4.0;
  EXPECT_LT((termOf(session_case) - 4.0 * term).norm(), 1e-9 * term.norm());
  session_case.camera_covariance.reset();
  EXPECT_GT((termOf(session_case) - term).norm(), term.norm());
}

/// A case whose only error is the mesh's scale, and an image that leaves next to none.
class BoxUncertainty : public testing::Test {
 protected:
  SessionCase scaleCase(double mesh_scale_sigma) const {
    SessionCase session_case;
    session_case.camera = box_.camera_;
    session_case.mesh_scale_sigma = mesh_scale_sigma;
    session_case.calibration_sigma = StatedCalibration{0.0, 0.0};
    return session_case;
  }
  static PoseCovariance covarianceOf(const SessionCase& session_case, const SceneMesh& scene,
                                     const Pose& pose) {
    return poseCovariance(session_case, scene.view(), pose, 1e-12 * Matrix6d::Identity());
  }

  const DrawnBox box_;
  const Pose& pose_ = box_.camera_from_station_;
};

TEST_F(BoxUncertainty, AMeshThatIsTooLargeMovesTheFittedPoseByTheSigmaOfItsScale) {
  const double too_large = 0.001;
  PredictedEdges edges = box_.edges();
  for (EdgePlace& place : edges.places) place.point_in_station_m *= 1.0 + too_large;
  const Vector6d moved = perturbationBetween(pose_, fitted(edges, box_.camera_, pose_));
  EXPECT_NEAR(moved(5), 0.5e-3, 1e-6) << "a thousandth of half a metre";
  const PoseCovariance covariance = covarianceOf(scaleCase(too_large), box_.scene_, pose_);
  EXPECT_LT((covariance.mesh_scale - moved * moved.transpose()).norm(), 1e-3 * moved.squaredNorm());
  EXPECT_TRUE(covariance.calibration.isZero(0.0));
}

TEST_F(BoxUncertainty, WhereTheMeshLiesInTheStationDoesNotMatter) {
  const auto sigma_m = [&](const Eigen::Vector3d& shift_m) {
    SceneMesh scene = box_.scene_;
    for (Eigen::Vector3f& vertex : scene.vertices_in_station_m) vertex += shift_m.cast<float>();
    Pose pose = pose_;
    pose.translation_m -= pose.rotation * shift_m;
    return std::sqrt(covarianceOf(scaleCase(0.001), scene, pose).mesh_scale(5, 5));
  };
  EXPECT_NEAR(sigma_m({3.0, -2.0, 1.0}), sigma_m(Eigen::Vector3d::Zero()), 1e-7);
}

TEST_F(BoxUncertainty, APoseThatShowsNoEdgeIsStillOffByItsCalibration) {
  Pose pose = pose_;
  pose.translation_m.x() = 2.0;  // out of the image
  SessionCase session_case = scaleCase(0.0);
  session_case.calibration_sigma = StatedCalibration{0.001, 1.0};
  const PoseCovariance covariance = covarianceOf(session_case, box_.scene_, pose);
  EXPECT_NEAR(std::sqrt(covariance.calibration(5, 5)), 0.5e-3, 1e-5);
  EXPECT_NEAR(std::sqrt(covariance.calibration(3, 3)), 0.5e-3, 1e-5) << "1 px at f = 1000 px";
}

TEST_F(BoxUncertainty, WithoutImageCovariance_IsUnknown) {
  const PoseCovariance covariance =
      poseCovariance(scaleCase(0.001), box_.scene_.view(), pose_, Matrix6d::Zero());
  EXPECT_FALSE(covariance.known());
  EXPECT_TRUE(covariance.total().isZero(0.0));
}

Matrix6d randomCovariance(Random& random, double scale) {
  Matrix6d root;
  for (int i = 0; i < 6; ++i) root.col(i) = scale * test::normalVector6(random);
  return root * root.transpose();
}

TEST(EndEffectorPose, StationPoint_IsEqualThroughBothChains) {
  Random random = randomFor("EndEffectorPose.Chain");
  for (int i = 0; i < 100; ++i) {
    const Pose seed = randomPose(random);
    const Pose estimate = randomPose(random);
    const Pose camera_from_end_effector = randomPose(random);
    const EndEffectorPose end_effector_pose =
        endEffectorPose(seed, estimate, camera_from_end_effector, Matrix6d::Zero());
    // A point held by the end effector, placed in the station by the estimate.
    const Eigen::Vector3d held(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d in_station = end_effector_pose.station_from_end_effector * held;
    EXPECT_LT((estimate * in_station - camera_from_end_effector * held).norm(), 1e-12);
    // The same place, seen from where the seed thought the end effector to be.
    const Eigen::Vector3d by_seed = camera_from_end_effector.inverse() * (seed * in_station);
    EXPECT_LT(
        (end_effector_pose.end_effector_seed_from_end_effector_estimated * held - by_seed).norm(),
        1e-12);
  }
}

/// The scatter of the results over draws of the pose, against what is said of it.
TEST(EndEffectorPose, TheCovarianceIsTheScatterOfDraws) {
  Random random = randomFor("EndEffectorPose.Covariance");
  const Pose seed = randomPose(random);
  const Pose estimate = randomPose(random);
  const Pose camera_from_end_effector = randomPose(random);
  const Matrix6d covariance = randomCovariance(random, 1e-4);
  const EndEffectorPose end_effector_pose =
      endEffectorPose(seed, estimate, camera_from_end_effector, covariance);
  const Matrix6d root = covariance.llt().matrixL();
  Matrix6d scatter = Matrix6d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose drawn = perturbed(root * test::normalVector6(random), estimate);
    const Pose correction = endEffectorPose(seed, drawn, camera_from_end_effector, covariance)
                                .end_effector_seed_from_end_effector_estimated;
    // Right perturbation: made * Exp(xi) == drawn.
    const Vector6d xi = perturbationBetween(
        Pose(),
        end_effector_pose.end_effector_seed_from_end_effector_estimated.inverse() * correction);
    scatter += xi * xi.transpose() / kDraws;
  }
  const Vector6d sigma = end_effector_pose.covariance.diagonal().cwiseSqrt();
  const Matrix6d off =
      (scatter - end_effector_pose.covariance).cwiseQuotient(sigma * sigma.transpose());
  EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.03) << off;
}

/// After the move, the end effector is over the station where the seed had it.
TEST(Correction, MoveReachesWhatWasPlannedFromTheSeed) {
  Random random = randomFor("Correction.Move");
  const FrameName base{"ARM_BASE", {}};
  for (int trial = 0; trial < 20; ++trial) {
    SessionCase session_case;
    session_case.camera_from_station_seed = randomPose(random);
    session_case.camera_from_end_effector = randomPose(random);
    FrameTransform hand_eye;
    hand_eye.target = kCameraFrame;
    hand_eye.source = kEndEffectorFrame;
    hand_eye.target_from_source = *session_case.camera_from_end_effector;
    hand_eye.covariance = randomCovariance(random, 1e-5);
    FrameTransform telemetry = hand_eye;
    telemetry.target = base;
    telemetry.target_from_source = randomPose(random);
    telemetry.covariance = randomCovariance(random, 1.0);  // common to both poses: does not enter
    session_case.frames = {hand_eye, telemetry};
    const Pose estimate = randomPose(random);
    const Matrix6d covariance = randomCovariance(random, 1e-4);
    const auto corrections = correctionsOf(session_case, estimate, covariance);
    ASSERT_EQ(corrections.size(), 3u);  // END_EFFECTOR, CAMERA, ARM_BASE
    const Correction& in_base = corrections.back();
    EXPECT_EQ(in_base.frame, base);

    const Pose base_from_station =
        telemetry.target_from_source * hand_eye.target_from_source.inverse() * estimate;
    Pose moved = telemetry.target_from_source;  // of the end effector, in the base
    moved.translation_m += in_base.translation_m;
    moved.rotation = rotationExp(in_base.rotation_rad) * moved.rotation;
    const Pose planned =
        session_case.camera_from_station_seed.inverse() * *session_case.camera_from_end_effector;
    EXPECT_LT(perturbationBetween(planned, base_from_station.inverse() * moved).norm(), 1e-9);
    const double trace = corrections.front().covariance.trace();
    EXPECT_NEAR(in_base.covariance.trace(), trace, 1e-9 * trace);
    session_case.frames[0].covariance.reset();
    EXPECT_GT(trace, correctionsOf(session_case, estimate, covariance).front().covariance.trace());
  }
}

/// The end effector is far from where the seed has it, so that turning moves the translation.
TEST(Correction, SigmasHoldTheScatterOfDrawnPoses) {
  Random random = randomFor("Correction.Sigmas");
  SessionCase session_case;
  session_case.has_seed = true;
  session_case.camera_from_station_seed = randomPose(random);
  session_case.camera_from_end_effector = randomPose(random);
  const Pose estimate = randomPose(random);
  const Matrix6d covariance = randomCovariance(random, 1e-4);
  const Matrix6d root = covariance.llt().matrixL();
  const Correction stated = correctionsOf(session_case, estimate, covariance).front();
  const Vector6d sigma = stated.covariance.diagonal().cwiseSqrt();
  std::array<std::vector<double>, 6> errors;
  Matrix6d scatter = Matrix6d::Zero();
  constexpr int kDraws = 4000;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Pose drawn = perturbed(root * test::normalVector6(random), estimate);
    const Correction found = correctionsOf(session_case, drawn, covariance).front();
    Vector6d error;
    error.head<3>() = rotationLog(
        (rotationExp(found.rotation_rad) * rotationExp(-stated.rotation_rad)).normalized());
    error.tail<3>() = found.translation_m - stated.translation_m;
    scatter += error * error.transpose() / kDraws;
    for (int i = 0; i < 6; ++i) errors[static_cast<std::size_t>(i)].push_back(error[i] / sigma[i]);
  }
  for (const std::vector<double>& component : errors) test::expectGaussianCoverage(component);
  const Matrix6d off = (scatter - stated.covariance).cwiseQuotient(sigma * sigma.transpose());
  EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.1) << off;
}

}  // namespace
}  // namespace boresight::sessions
