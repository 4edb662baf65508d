// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/frame_tree.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/geometry/pose.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/io/cameras/joined_frames.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::joining;
using test::randomPose;

const FrameName kBase{"ARM_BASE", {}};
const FrameName kSite{"SITE_FRAME", {3}};

Eigen::Matrix4d matrixOf(const Pose& pose) {
  return (Eigen::Translation3d(pose.translation_m) * pose.rotation).matrix();
}

/// A shift along z.
Pose along(double z_m) { return {Eigen::Quaterniond::Identity(), {0.0, 0.0, z_m}}; }

Matrix6d diagonal(double rotation_rad, double translation_m) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(rotation_rad * rotation_rad),
      Eigen::Vector3d::Constant(translation_m * translation_m);
  return variances.asDiagonal();
}

auto building(const std::vector<FrameTransform>& transforms) {
  return [transforms] { (void)FrameTree(transforms); };
}

TEST(FrameTree, Chain_IsTheProductOfMatrices) {
  Random random = test::randomFor("FrameTree.Chain");
  for (int trial = 0; trial < 50; ++trial) {
    const Pose camera_from_tool = randomPose(random);
    const Pose base_from_tool = randomPose(random);
    const Pose base_from_site = randomPose(random);
    const FrameTree tree({joining(kBase, kEndEffectorFrame, base_from_tool),
                          joining(kSite, kBase, base_from_site.inverse()),
                          joining(kEndEffectorFrame, kCameraFrame, camera_from_tool.inverse())});
    const auto chain = tree.chain(kCameraFrame, kSite);
    ASSERT_TRUE(chain);
    EXPECT_EQ(chain->path(), "CAMERA - END_EFFECTOR - ARM_BASE - SITE_FRAME (3)");
    const Eigen::Matrix4d expected =
        matrixOf(camera_from_tool) * matrixOf(base_from_tool).inverse() * matrixOf(base_from_site);
    EXPECT_LT((matrixOf(chain->a_from_b) - expected).norm(), 1e-12);
    const auto back = tree.chain(kSite, kCameraFrame);
    ASSERT_TRUE(back);
    EXPECT_LT((matrixOf(back->a_from_b) - expected.inverse()).norm(), 1e-12);
    EXPECT_FALSE(tree.chain(kCameraFrame, kStationFrame));
  }
}

/// The scatter of chains over draws of each transform, against the covariance of the chain.
TEST(FrameTree, Covariance_IsTheScatterOfDraws) {
  Random random = test::randomFor("FrameTree.Covariance");
  std::vector<FrameTransform> transforms = {
      joining(kBase, kEndEffectorFrame, randomPose(random)),
      joining(kBase, kSite, randomPose(random)),
      joining(kEndEffectorFrame, kCameraFrame, randomPose(random))};
  transforms[0].covariance = diagonal(1e-4, 2e-4);
  transforms[1].covariance = diagonal(5e-5, 4e-4);
  transforms[2].covariance = diagonal(2e-4, 1e-4);
  const FrameTree tree(transforms);
  const auto chain = tree.chain(kCameraFrame, kSite);
  ASSERT_TRUE(chain && chain->covariance_stated);
  Matrix6d sum = Matrix6d::Zero();
  for (const FrameLink& link : chain->links) sum += link.contribution;
  EXPECT_LT((sum - chain->covariance).norm(), 1e-20);

  Matrix6d scatter = Matrix6d::Zero();
  constexpr int kDraws = 40000;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<FrameTransform> drawn = transforms;
    for (FrameTransform& transform : drawn) {
      const Vector6d xi =
          test::normalVector6(random).cwiseProduct(transform.covariance->diagonal().cwiseSqrt());
      transform.target_from_source = perturbed(xi, transform.target_from_source);
    }
    const Pose pose = FrameTree(drawn).chain(kCameraFrame, kSite)->a_from_b;
    const Vector6d xi = perturbationBetween(chain->a_from_b, pose);
    scatter += xi * xi.transpose() / kDraws;
  }
  const Vector6d sigma = sigmasOf(chain->covariance);
  const Matrix6d difference =
      (scatter - chain->covariance).cwiseQuotient(sigma * sigma.transpose());
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), 0.03) << difference;
}

TEST(FrameTree, Loop_IsRefusedWithBothWays) {
  EXPECT_THAT(
      building({joining(kCameraFrame, kEndEffectorFrame, along(1.0), "hand_eye.json"),
                joining(kEndEffectorFrame, kBase, along(1.0), "telemetry.json"),
                joining(kCameraFrame, kBase, along(2.01), "label.json")}),
      testing::ThrowsMessage<InputError>(
          "label.json: leads from ARM_BASE to CAMERA, as does the way CAMERA - END_EFFECTOR - "
          "ARM_BASE of hand_eye.json, telemetry.json; the two differ by 10.000 mm and 0.000 deg; "
          "give only the valid one"));
  // The same transform twice, once inverted, is no loop.
  EXPECT_NO_THROW(building({joining(kCameraFrame, kBase, along(1.0), "a.json"),
                            joining(kBase, kCameraFrame, along(-1.0), "b.json")})());
  EXPECT_THAT(building({joining(kBase, kBase, along(1.0), "base.json")}),
              testing::ThrowsMessage<InputError>(
                  "base.json: leads from ARM_BASE to itself: a transform joins two frames"));
}

TEST(FrameTree, CameraModel_IsALink) {
  CameraReference reference{{Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0}}, kSite};
  const auto chain = frameTree(reference, {}).chain(kCameraFrame, kSite);
  ASSERT_TRUE(chain);
  EXPECT_EQ(chain->a_from_b, reference.camera_from_reference);
  reference.frame.name.clear();
  EXPECT_TRUE(frameTree(reference, {}).frames().empty());
}

/// A sigma is stated at the source's origin: half a metre away, a turn does not shift it.
TEST(FramesFile, Sigma_HoldsAtTheOriginOfTheSource) {
  const test::TemporaryFolder folder;
  const auto transforms = readFrameTransforms(folder.write("frames.json", R"(
      {"format": "boresight-frames", "version": 1, "transforms": [
        {"target": {"name": "ARM_BASE"}, "source": {"name": "END_EFFECTOR"},
         "target_from_source": [[1,0,0,0.5],[0,1,0,0],[0,0,1,0],[0,0,0,1]],
         "sigma": {"translation_mm": [1, 2, 3], "rotation_mrad": [4, 5, 6]},
         "origin": "telemetry", "comment": "joint angles of sol 12"}]})"));
  ASSERT_EQ(transforms.size(), 1u);
  EXPECT_EQ(transforms[0].origin, TransformSource::kTelemetry);
  const Matrix6d covariance = *transforms[0].covariance;
  // The shift of a point p by xi = (w, v) is w x p + v.
  Eigen::Matrix<double, 3, 6> at_source;
  const Eigen::Vector3d p(0.5, 0.0, 0.0);
  at_source << 0, p.z(), -p.y(), 1, 0, 0,  //
      -p.z(), 0, p.x(), 0, 1, 0,           //
      p.y(), -p.x(), 0, 0, 0, 1;
  const Eigen::Matrix3d shift = at_source * covariance * at_source.transpose();
  EXPECT_LT((shift.diagonal().cwiseSqrt() - Eigen::Vector3d(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT(
      (covariance.diagonal().head<3>().cwiseSqrt() - Eigen::Vector3d(4e-3, 5e-3, 6e-3)).norm(),
      1e-15);
  // At the target's origin it does.
  EXPECT_NEAR(std::sqrt(covariance(4, 4)), std::hypot(2e-3, 0.5 * 6e-3), 1e-12);
}

TEST(FrameRows, HangOnTheCameraAndParentsComeFirst) {
  // Stated the other way round.
  FrameTransform hand_eye = joining(kEndEffectorFrame, kCameraFrame, along(-0.4));
  hand_eye.covariance = 1e-6 * Matrix6d::Identity();
  const auto rows = frameRows(FrameTree({joining(kBase, kEndEffectorFrame, Pose()),
                                         joining({"SITE", {1}}, {"SITE", {2}}, Pose()), hand_eye}));
  std::vector<int> parents;
  for (const auto& row : rows) parents.push_back(row.parent);
  ASSERT_THAT(parents, testing::ElementsAre(-1, 0, 1, -1, 3))
      << "SITE is not joined with the camera";
  EXPECT_EQ(rows[0].frame, kCameraFrame);
  EXPECT_EQ(rows[1].frame, kEndEffectorFrame);
  EXPECT_NEAR(rows[1].parent_from_frame.translation_m.z(), 0.4, 1e-12);
  ASSERT_TRUE(rows[1].sigma);
  EXPECT_NEAR((*rows[1].sigma)[2], 1e-3, 1e-12);
  EXPECT_EQ(rows[2].frame, kBase);
  EXPECT_FALSE(rows[2].sigma);
  EXPECT_EQ(frameRows(FrameTree()).size(), 1u);
}

}  // namespace
}  // namespace boresight::sessions
