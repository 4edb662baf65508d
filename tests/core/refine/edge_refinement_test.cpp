// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_refinement.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/core/geometry/example_cameras.h"
#include "tests/core/localizer/scene.h"
#include "tests/core/refine/refined.h"
#include "tests/core/refine/step_edge.h"

namespace boresight::test {
namespace {

double error_px(const Case& scene, const Pose& pose) {
  return meanDisplacement_px(scene.solid, scene.camera, scene.truth, pose);
}

/// A pose whose image is `displacement_px` off on average.
Pose poseOff(const Case& scene, double displacement_px, std::uint64_t seed) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    const Pose pose = displacedSeed(scene.truth, scene.uncertainty, middle, seed);
    (error_px(scene, pose) > displacement_px ? high : low) = middle;
  }
  return displacedSeed(scene.truth, scene.uncertainty, low, seed);
}

TEST(EdgeRefinement, ConvergesFromPixelsAway) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(1, distorted);
    std::uint64_t seed = 0;
    for (const double displacement_px : {0.5, 1.0, 1.5, 2.0}) {
      SCOPED_TRACE(displacement_px);
      Refined refined(scene, poseOff(scene, displacement_px, ++seed), 3.0);
      EXPECT_LT(error_px(scene, refined.pose()), 0.05);
      refined.pass(scene, refined.pose(), 0.7);
      ASSERT_EQ(refined.status, Status::kOk);
      EXPECT_LT(error_px(scene, refined.pose()), 0.03);
    }
  }
}

TEST(EdgeRefinement, Result_FitsItsSamplesAndReusesTheirEdges) {
  const Case scene = stationCase(1);
  const Refined refined(scene, poseOff(scene, 1.0, 9), 3.0);
  EXPECT_GE(refined.searches, 2);
  EXPECT_LT(refined.searches, refined.rounds);
  // The edges at the returned pose give the same pose.
  const Refined again(scene, refined.pose(), 3.0);
  EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, refined.pose(), again.pose()), 0.02);
  const RefinementResult& result = refined.result;
  int found = 0;
  int used = 0;
  double squares = 0.0;
  double weights = 0.0;
  for (const EdgeSample& sample : refined.samples()) {
    EXPECT_NEAR(sample.normal().norm(), 1.0, 0.02);
    EXPECT_NE(sample.kind, 0);
    EXPECT_GE(sample.weight, 0.0);
    EXPECT_LE(sample.weight, 1.0);
    found += sample.gradient != 0.0 ? 1 : 0;
    used += sample.weight > 0.5 ? 1 : 0;
    const double weight = (sample.gradient > 0.0 ? 0.4 : 1.0) * sample.weight;
    squares += weight * sample.residual_px * sample.residual_px;
    weights += weight;
    EXPECT_TRUE(sample.gradient != 0.0 || sample.weight == 0.0);
    EXPECT_TRUE(sample.gradient == 0.0 || std::abs(sample.gradient) >= 2.0);
    EXPECT_LE(std::abs(sample.residual_px), 3.0 + 0.5 * EdgeSearch::kWideStep_px);
  }
  EXPECT_EQ(result.found_count, found);
  EXPECT_EQ(result.used_count, used);
  EXPECT_NEAR(result.rms_px, std::sqrt(squares / weights), 1e-9);
  EXPECT_LT(result.rms_px, 0.3);
  EXPECT_GT(used, 500);
  const Matrix6d& covariance = result.covariance;
  EXPECT_EQ(covariance, covariance.transpose().eval());
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  // Of the size of the errors: within a tenth of a millimetre and of a degree.
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::sqrt(covariance(i, i)), i < 3 ? 2e-3 : 5e-4);
    EXPECT_GT(std::sqrt(covariance(i, i)), i < 3 ? 1e-6 : 1e-7);
  }
}

TEST(EdgeRefinement, TooFewEdgesInRenderOrImage_AreReported) {
  Case scene = stationCase(1);
  Pose far_away = scene.truth;
  far_away.translation_m *= 40.0;
  Refined small;
  small.pass(scene, far_away, 3.0);
  EXPECT_EQ(small.status, Status::kTooFewEdges);
  EXPECT_GT(small.result.sample_count, 0);
  EXPECT_EQ(small.rounds, 0);  // at once
  const Picture flat = flatPicture(512, 512, 100);
  scene.picture = &flat;
  Refined unseen;
  unseen.pass(scene, scene.truth, 3.0);
  EXPECT_EQ(unseen.status, Status::kTooFewEdges);
  EXPECT_EQ(unseen.rounds, 1);
  EXPECT_EQ(unseen.result.found_count, 0);
  EXPECT_EQ(unseen.result.used_count, 0);
  EXPECT_EQ(unseen.pose().translation_m, scene.truth.translation_m);
}

TEST(EdgeRefinement, SamplesAndRounds_StayWithinTheirLimits) {
  const Case scene = stationCase(1);
  RefinementOptions options;
  options.max_samples = 300;
  Refined refined(options);
  refined.pass(scene, poseOff(scene, 2.0, 3), 3.0);
  EXPECT_EQ(refined.status, Status::kOk);
  EXPECT_LE(refined.result.sample_count, 300);
  EXPECT_GE(refined.result.sample_count, 100);
  EXPECT_LE(refined.rounds, EdgeRefinement::kRounds);
}

TEST(EdgeRefinement, IgnoredEdgesAreNotUsed) {
  Case scene = stationCase(1);
  Mask mask(512, 512);
  mask.fill(100, 100, 300, 260);
  scene.ignore = &mask.bits;
  const Refined refined(scene, poseOff(scene, 1.0, 5), 3.0);
  int inside = 0;
  for (const EdgeSample& sample : refined.samples()) {
    const Eigen::Vector2d pixel = pixelOf(scene.camera, scene.truth * sample.point_in_station_m);
    // Some way inside, so that the edge that was found was, too.
    if (pixel.x() < 105 || pixel.x() > 294 || pixel.y() < 105 || pixel.y() > 254) continue;
    EXPECT_EQ(sample.gradient, 0.0);
    ++inside;
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(error_px(scene, refined.pose()), 0.08);
}

/// A sheet across the image, without its picture.
Case sheetCase(double left_m, double right_m) {
  Case scene;
  scene.solid.addPrism({{left_m, -1.0}, {right_m, -1.0}, {right_m, 1.0}, {left_m, 1.0}}, -0.001,
                       0.0, 0.9);
  scene.camera = pinholeCamera();
  // Not along the columns: there all rays of the picture's edge pixels would share one error.
  scene.truth.rotation = rotationExp({0.0, 0.0, 0.11}) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  scene.truth.translation_m = {0.0, 0.0, 0.45};
  return scene;
}

/// A sheet that covers the left of the image: one straight edge, all other edges hidden.
struct OneEdge {
  Case scene = sheetCase(-1.0, 0.01);
  Picture picture = takePicture(scene.solid, scene.camera, scene.truth);
  Pose start = scene.truth;

  OneEdge() {
    scene.picture = &picture;
    start.translation_m += Eigen::Vector3d(0.0006, 0.001, 0.002);
    start.rotation = (rotationExp({0.0, 0.0, 0.004}) * start.rotation).normalized();
  }
  Eigen::Vector2d placeOf(const Pose& camera_from_station, double y_m) const {
    return pixelOf(scene.camera, camera_from_station * Eigen::Vector3d(0.01, y_m, 0.0));
  }
  /// The edge is matched, and the undetermined direction keeps its value.
  void expectHeld(const Pose& end) const {
    const Eigen::Vector2d along =
        (placeOf(scene.truth, 0.05) - placeOf(scene.truth, -0.05)).normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const double y_m : {-0.05, 0.0, 0.06}) {
      const Eigen::Vector2d end_px = placeOf(end, y_m);
      EXPECT_NEAR(across.dot(end_px - placeOf(scene.truth, y_m)), 0.0, 0.05);
      EXPECT_NEAR(along.dot(end_px - placeOf(start, y_m)), 0.0, 0.5);  // 2 px from the truth
      EXPECT_GT(std::abs(along.dot(end_px - placeOf(scene.truth, y_m))), 1.0);
    }
    EXPECT_NEAR(end.translation_m.z(), start.translation_m.z(), 1e-4);
  }
};

TEST(EdgeRefinement, AnchorOrMatchedPose_HoldsDirectionsThatOneEdgeDoesNotDetermine) {
  const OneEdge edge;
  Refined alone;
  alone.pass(edge.scene, edge.scene.truth, 3.0);
  EXPECT_EQ(alone.status, Status::kDegenerate);
  PosePrior anchor;
  anchor.camera_from_station = edge.start;
  anchor.sigma.translation_m.setConstant(0.005);
  anchor.sigma.rotation_rad.setConstant(0.02);
  anchor.sigma.pivot_in_camera_m = {0.0, 0.0, 0.45};
  const Refined anchored(edge.scene, edge.start, 4.0, &anchor);
  edge.expectHeld(anchored.pose());
  // The uncertainty along the edge is unchanged; across it, it is far smaller.
  const Matrix6d& covariance = anchored.result.covariance;
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  EXPECT_GT(std::sqrt(covariance(4, 4)), 0.004);
  PoseEstimate matched;
  matched.camera_from_station = edge.start;
  matched.information.diagonal() << 2500.0, 2500.0, 2500.0, 4e4, 4e4, 4e4;
  edge.expectHeld(Refined(edge.scene, edge.start, 4.0, nullptr, &matched).pose());
}

/// Holds all but the translation along the image's rows.
PoseEstimate holdingAllButX(const Pose& camera_from_station) {
  PoseEstimate held;
  held.camera_from_station = camera_from_station;
  held.information.diagonal() << 1e14, 1e14, 1e14, 1.0, 1e14, 1e14;
  return held;
}

/// A strip across the image, gray before black on the left and before white on the right, where
/// its edge lies `aside_px` further out than in the mesh.
struct Strip {
  static constexpr double kHalf_m = 0.03;
  Case scene = sheetCase(-kHalf_m, kHalf_m);
  Picture picture;

  explicit Strip(double aside_px) {
    const StepEdge one = edgeAlong(kHalf_m, 0.0);
    const StepEdge other = edgeAlong(-kHalf_m, 0.0);
    const double right_m = one.distance_px > other.distance_px ? kHalf_m : -kHalf_m;
    picture = drawSteps(scene.camera.width, scene.camera.height, 60.0,
                        {edgeAlong(-right_m, 0.0), edgeAlong(right_m, aside_px)});
    scene.picture = &picture;
  }
  StepEdge edgeAlong(double x_m, double aside_px) const {
    const Eigen::Vector2d from =
        pixelOf(scene.camera, scene.truth * Eigen::Vector3d(x_m, -0.01, 0.0));
    const Eigen::Vector2d to = pixelOf(scene.camera, scene.truth * Eigen::Vector3d(x_m, 0.01, 0.0));
    Eigen::Vector2d normal = Eigen::Vector2d(to.y() - from.y(), from.x() - to.x()).normalized();
    if (normal.x() < 0.0) normal = -normal;
    return {normal, normal.dot(from) + aside_px, 60.0};
  }
  /// How far to the right the strip ends up, in pixels along the edges' normal.
  double shift_px() const {
    const PoseEstimate held = holdingAllButX(scene.truth);
    const Refined refined(scene, scene.truth, 2.0, nullptr, &held);
    return edgeAlong(kHalf_m, 0.0)
        .normal.dot(pixelOf(scene.camera, refined.pose().translation_m) -
                    pixelOf(scene.camera, scene.truth.translation_m));
  }
};

/// Both edges are as long: the one that rises pulls by its weight, 0.4 next to 1.
TEST(EdgeRefinement, RisingEdge_WeighsLessThanAFallingEdge) {
  constexpr double kAside_px = 0.3;
  const double pulled_px = Strip(kAside_px).shift_px() - Strip(0.0).shift_px();
  EXPECT_NEAR(pulled_px, kAside_px * 0.4 / 1.4, 0.02);
}

TEST(EdgeRefinement, OnlyRisingEdges_AreUsed) {
  OneEdge edge;
  const PoseEstimate held = holdingAllButX(edge.start);
  const auto across_px = [&edge, &held] {
    const Refined refined(edge.scene, edge.start, 4.0, nullptr, &held);
    EXPECT_GT(refined.result.used_count, 60);
    return edge.placeOf(refined.pose(), 0.0).x();
  };
  const double of_falling_px = across_px();
  for (std::uint8_t& gray : edge.picture.gray) gray = static_cast<std::uint8_t>(255 - gray);
  EXPECT_NEAR(of_falling_px, across_px(), 2e-2);
}

}  // namespace
}  // namespace boresight::test
