// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/pose_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/sessions/review/drawn_box.h"

namespace boresight::sessions {
namespace {

using test::DrawnBox;

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
    const Eigen::VectorXd now = misfit(edges, camera, pose);
    Eigen::MatrixXd slopes(now.size(), 6);
    for (int i = 0; i < 6; ++i)
      slopes.col(i) =
          (misfit(edges, camera, perturbed(1e-6 * Vector6d::Unit(i), pose)) - now) / 1e-6;
    const Eigen::VectorXd step = slopes.colPivHouseholderQr().solve(-now);
    pose = perturbed(Vector6d(step), pose);
  }
  return pose;
}

TEST(PoseUncertainty, ThePoseFollowsTheCameraAsAFitWithTheWrongCameraDoes) {
  const DrawnBox box;
  const PredictedEdges edges =
      predictEdges(box.camera_, box.scene_.view(), box.camera_from_station_);
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

/// A case whose only error is the mesh's scale.
SessionCase scaleCase(const DrawnBox& box, double mesh_scale_sigma) {
  SessionCase one;
  one.camera = box.camera_;
  one.mesh_scale_sigma = mesh_scale_sigma;
  one.calibration_sigma = CalibrationSigma{0.0, 0.0};
  return one;
}

TEST(PoseUncertainty, AMeshThatIsTooLargeMovesTheFittedPoseByTheSigmaOfItsScale) {
  const DrawnBox box;
  const double too_large = 0.001;
  PredictedEdges edges = predictEdges(box.camera_, box.scene_.view(), box.camera_from_station_);
  for (EdgePlace& place : edges.places) place.point_in_station_m *= 1.0 + too_large;
  const Vector6d moved = perturbationBetween(box.camera_from_station_,
                                             fitted(edges, box.camera_, box.camera_from_station_));
  EXPECT_NEAR(moved(5), 0.5e-3, 1e-6) << "a thousandth of half a metre";
  const PoseCovariance covariance =
      poseCovariance(scaleCase(box, too_large), box.scene_.view(), box.camera_from_station_,
                     1e-12 * Matrix6d::Identity());
  EXPECT_LT((covariance.mesh_scale - moved * moved.transpose()).norm(), 1e-3 * moved.squaredNorm());
  EXPECT_TRUE(covariance.calibration.isZero(0.0));
}

TEST(PoseUncertainty, WhereTheMeshLiesInTheStationDoesNotMatter) {
  const DrawnBox box;
  const auto sigma_m = [&](const Eigen::Vector3d& shift_m) {
    SceneMesh scene = box.scene_;
    for (Eigen::Vector3f& vertex : scene.vertices_in_station_m) vertex += shift_m.cast<float>();
    Pose pose = box.camera_from_station_;
    pose.translation_m -= pose.rotation * shift_m;
    const PoseCovariance covariance =
        poseCovariance(scaleCase(box, 0.001), scene.view(), pose, 1e-12 * Matrix6d::Identity());
    return std::sqrt(covariance.mesh_scale(5, 5));
  };
  EXPECT_NEAR(sigma_m({3.0, -2.0, 1.0}), sigma_m(Eigen::Vector3d::Zero()), 1e-7);
}

TEST(PoseUncertainty, APoseThatShowsNoEdgeIsStillOffByItsCalibration) {
  const DrawnBox box;
  Pose pose = box.camera_from_station_;
  pose.translation_m.x() = 2.0;  // out of the image
  SessionCase one = scaleCase(box, 0.0);
  one.calibration_sigma = CalibrationSigma{0.001, 1.0};
  const PoseCovariance covariance =
      poseCovariance(one, box.scene_.view(), pose, 1e-12 * Matrix6d::Identity());
  EXPECT_NEAR(std::sqrt(covariance.calibration(5, 5)), 0.5e-3, 1e-5);
  EXPECT_NEAR(std::sqrt(covariance.calibration(3, 3)), 0.5e-3, 1e-5) << "1 px at f = 1000 px";
}

TEST(PoseUncertainty, WithoutWhatThePictureSaysThereIsNoCovariance) {
  const DrawnBox box;
  const PoseCovariance covariance = poseCovariance(scaleCase(box, 0.001), box.scene_.view(),
                                                   box.camera_from_station_, Matrix6d::Zero());
  EXPECT_FALSE(covariance.known());
  EXPECT_TRUE(covariance.total().isZero(0.0));
}

}  // namespace
}  // namespace boresight::sessions
