// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_refinement.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "core/base/random.h"
#include "tests/core/localizer/scene.h"
#include "tests/core/refine/step_edge.h"

namespace boresight::test {
namespace {

/// A refinement with all its memory.
struct Refined {
  std::vector<std::byte> memory;
  EdgeRefinement refinement;
  RefinementResult result;
  Status status = Status::kOk;
  int rounds = 0;
  int searches = 0;  ///< rounds that searched the image

  explicit Refined(const RefinementOptions& options = {}) : memory(std::size_t{4} << 20) {
    Arena arena(memory);
    EXPECT_EQ(refinement.create(options, arena), Status::kOk);
    result.samples = arena.allocate<EdgeSample>(static_cast<std::size_t>(options.max_samples));
    EXPECT_FALSE(arena.exhausted());
  }

  /// One pass from a pose.
  void pass(const Case& scene, const Pose& from, double radius_px,
            const PosePrior* anchor = nullptr, const PoseEstimate* matched = nullptr) {
    const Rendering rendering = renderEdges(scene.solid, scene.camera, from);
    status = refinement.begin(scene.picture->view(), scene.ignore, scene.camera, scene.solid.view(),
                              rendering.edges, radius_px, anchor, matched, result);
    rounds = 0;
    searches = 0;
    bool done = false;
    while (status == Status::kOk && !done && rounds < 1000) {
      searches += refinement.chunks() > 0 ? 1 : 0;
      status = refinement.step(done);
      ++rounds;
    }
    EXPECT_TRUE(done || rounds == 0);
  }
};

/// A pose whose image is `displacement_px` off on average.
Pose poseOff(const Case& scene, double displacement_px, std::uint64_t seed) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    const Pose pose = displacedSeed(scene.truth, scene.uncertainty, middle, seed);
    const bool beyond =
        meanDisplacement_px(scene.solid, scene.camera, scene.truth, pose) > displacement_px;
    (beyond ? high : low) = middle;
  }
  return displacedSeed(scene.truth, scene.uncertainty, low, seed);
}

TEST(EdgeRefinement, ConvergesFromPixelsAway) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(1, distorted);
    std::uint64_t seed = 0;
    for (const double displacement_px : {0.5, 1.0, 1.5, 2.0}) {
      SCOPED_TRACE(displacement_px);
      const Pose start = poseOff(scene, displacement_px, ++seed);
      Refined refined;
      refined.pass(scene, start, 3.0);
      ASSERT_EQ(refined.status, Status::kOk);
      EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, scene.truth,
                                    refined.result.camera_from_station),
                0.05);
      refined.pass(scene, refined.result.camera_from_station, 0.7);
      ASSERT_EQ(refined.status, Status::kOk);
      EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, scene.truth,
                                    refined.result.camera_from_station),
                0.03);
    }
  }
}

TEST(EdgeRefinement, SmallMotion_ReusesTheEdges) {
  const Case scene = stationCase(1);
  const Pose start = poseOff(scene, 1.0, 5);
  Refined refined;
  refined.pass(scene, start, 3.0);
  ASSERT_EQ(refined.status, Status::kOk);
  EXPECT_GE(refined.searches, 2);
  EXPECT_LT(refined.searches, refined.rounds);
  // The edges at the returned pose give the same pose.
  Refined again;
  again.pass(scene, refined.result.camera_from_station, 3.0);
  ASSERT_EQ(again.status, Status::kOk);
  EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, refined.result.camera_from_station,
                                again.result.camera_from_station),
            0.02);
}

TEST(EdgeRefinement, CountsAndRms_FollowFromTheSamples) {
  const Case scene = stationCase(1);
  Refined refined;
  refined.pass(scene, poseOff(scene, 1.0, 9), 3.0);
  ASSERT_EQ(refined.status, Status::kOk);
  const RefinementResult& result = refined.result;
  int found = 0;
  int used = 0;
  double squares = 0.0;
  double weights = 0.0;
  for (int i = 0; i < result.sample_count; ++i) {
    const EdgeSample& sample = result.samples[static_cast<std::size_t>(i)];
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
}

TEST(EdgeRefinement, CovarianceIsSymmetricAndPositive) {
  const Case scene = stationCase(1);
  Refined refined;
  refined.pass(scene, poseOff(scene, 1.0, 4), 3.0);
  ASSERT_EQ(refined.status, Status::kOk);
  const Matrix6d covariance = refined.result.covariance;
  EXPECT_EQ(covariance, covariance.transpose().eval());
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  // Of the size of the errors: within a tenth of a millimetre and of a degree.
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::sqrt(covariance(i, i)), i < 3 ? 2e-3 : 5e-4);
    EXPECT_GT(std::sqrt(covariance(i, i)), i < 3 ? 1e-6 : 1e-7);
  }
}

TEST(EdgeRefinement, FindsTooFewEdgesInAFlatImage) {
  Case scene = stationCase(1);
  const Picture flat = flatPicture(512, 512, 100);
  scene.picture = &flat;
  Refined refined;
  refined.pass(scene, scene.truth, 3.0);
  EXPECT_EQ(refined.status, Status::kTooFewEdges);
  EXPECT_EQ(refined.rounds, 1);
  EXPECT_EQ(refined.result.found_count, 0);
  EXPECT_EQ(refined.result.used_count, 0);
  EXPECT_EQ(refined.result.camera_from_station.translation_m, scene.truth.translation_m);
}

TEST(EdgeRefinement, RenderWithTooFewEdges_IsReported) {
  const Case scene = stationCase(1);
  Pose far_away = scene.truth;
  far_away.translation_m *= 40.0;
  Refined refined;
  refined.pass(scene, far_away, 3.0);
  EXPECT_EQ(refined.status, Status::kTooFewEdges);
  EXPECT_GT(refined.result.sample_count, 0);
  EXPECT_EQ(refined.rounds, 0);  // at once
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
  Refined refined;
  const Pose start = poseOff(scene, 1.0, 5);
  refined.pass(scene, start, 3.0);
  ASSERT_EQ(refined.status, Status::kOk);
  int inside = 0;
  for (int i = 0; i < refined.result.sample_count; ++i) {
    const EdgeSample& sample = refined.result.samples[static_cast<std::size_t>(i)];
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(scene.camera, scene.truth * sample.point_in_station_m, pixel));
    // Some way inside, so that the edge that was found was, too.
    if (pixel.x() < 105 || pixel.x() > 294 || pixel.y() < 105 || pixel.y() > 254) continue;
    EXPECT_EQ(sample.gradient, 0.0);
    ++inside;
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, scene.truth,
                                refined.result.camera_from_station),
            0.08);
}

/// As `picture`, white on black.
Picture negativeOf(Picture picture) {
  for (std::uint8_t& gray : picture.gray) gray = static_cast<std::uint8_t>(255 - gray);
  return picture;
}

/// A sheet that covers the left of the image: one straight edge, all other edges hidden.
struct OneEdge {
  Picture picture;
  Case scene;

  OneEdge() {
    scene.solid.addPrism({{-1.0, -1.0}, {0.01, -1.0}, {0.01, 1.0}, {-1.0, 1.0}}, -0.001, 0.0, 0.9);
    scene.camera = pinholeCamera();
    // Not along the columns: there all rays of the picture's edge pixels would share one error.
    scene.truth.rotation = rotationExp({0.0, 0.0, 0.11}) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    scene.truth.translation_m = {0.0, 0.0, 0.45};
    picture = takePicture(scene.solid, scene.camera, scene.truth);
    scene.picture = &picture;
  }
  Eigen::Vector2d placeOf(const Pose& camera_from_station, double y_m) const {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(
        project(scene.camera, camera_from_station * Eigen::Vector3d(0.01, y_m, 0.0), pixel));
    return pixel;
  }
};

TEST(EdgeRefinement, SingleEdge_IsDegenerate) {
  const OneEdge edge;
  Refined refined;
  refined.pass(edge.scene, edge.scene.truth, 3.0);
  EXPECT_EQ(refined.status, Status::kDegenerate);
}

/// The edge is matched, and the undetermined direction keeps its value.
void expectHeld(const OneEdge& edge, const Pose& start, const Pose& end) {
  const Eigen::Vector2d along =
      (edge.placeOf(edge.scene.truth, 0.05) - edge.placeOf(edge.scene.truth, -0.05)).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  for (const double y_m : {-0.05, 0.0, 0.06}) {
    const Eigen::Vector2d end_px = edge.placeOf(end, y_m);
    EXPECT_NEAR(across.dot(end_px - edge.placeOf(edge.scene.truth, y_m)), 0.0, 0.05);
    EXPECT_NEAR(along.dot(end_px - edge.placeOf(start, y_m)), 0.0, 0.5);  // 2 px from the truth
    EXPECT_GT(std::abs(along.dot(end_px - edge.placeOf(edge.scene.truth, y_m))), 1.0);
  }
  EXPECT_NEAR(end.translation_m.z(), start.translation_m.z(), 1e-4);
}

Pose startOf(const OneEdge& edge) {
  Pose start = edge.scene.truth;
  start.translation_m += Eigen::Vector3d(0.0006, 0.001, 0.002);
  start.rotation = (rotationExp({0.0, 0.0, 0.004}) * start.rotation).normalized();
  return start;
}

TEST(EdgeRefinement, Anchor_HoldsDirectionsThatOneEdgeDoesNotDetermine) {
  const OneEdge edge;
  const Pose start = startOf(edge);
  PosePrior anchor;
  anchor.camera_from_station = start;
  anchor.sigma.translation_m.setConstant(0.005);
  anchor.sigma.rotation_rad.setConstant(0.02);
  anchor.sigma.pivot_in_camera_m = {0.0, 0.0, 0.45};
  Refined refined;
  refined.pass(edge.scene, start, 4.0, &anchor);
  ASSERT_EQ(refined.status, Status::kOk);
  expectHeld(edge, start, refined.result.camera_from_station);
  // The uncertainty along the edge is unchanged; across it, it is far smaller.
  const Matrix6d& covariance = refined.result.covariance;
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  EXPECT_GT(std::sqrt(covariance(4, 4)), 0.004);
}

TEST(EdgeRefinement, MatchedPose_HoldsDirectionsThatOneEdgeDoesNotDetermine) {
  const OneEdge edge;
  const Pose start = startOf(edge);
  PoseEstimate matched;
  matched.camera_from_station = start;
  matched.information.diagonal() << 2500.0, 2500.0, 2500.0, 4e4, 4e4, 4e4;
  Refined refined;
  refined.pass(edge.scene, start, 4.0, nullptr, &matched);
  ASSERT_EQ(refined.status, Status::kOk);
  expectHeld(edge, start, refined.result.camera_from_station);
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
  Picture picture;
  Case scene;

  explicit Strip(double aside_px) {
    scene.solid.addPrism({{-kHalf_m, -1.0}, {kHalf_m, -1.0}, {kHalf_m, 1.0}, {-kHalf_m, 1.0}},
                         -0.001, 0.0, 0.9);
    scene.camera = pinholeCamera();
    scene.truth.rotation = rotationExp({0.0, 0.0, 0.11}) * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    scene.truth.translation_m = {0.0, 0.0, 0.45};
    const StepEdge one = edgeAlong(kHalf_m, 0.0, 60.0);
    const StepEdge other = edgeAlong(-kHalf_m, 0.0, 60.0);
    const bool one_is_right = one.distance_px > other.distance_px;
    picture = drawSteps(scene.camera.width, scene.camera.height, 60.0,
                        {edgeAlong(one_is_right ? -kHalf_m : kHalf_m, 0.0, 60.0),
                         edgeAlong(one_is_right ? kHalf_m : -kHalf_m, aside_px, 60.0)});
    scene.picture = &picture;
  }
  StepEdge edgeAlong(double x_m, double aside_px, double contrast) const {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
    EXPECT_TRUE(project(scene.camera, scene.truth * Eigen::Vector3d(x_m, -0.01, 0.0), from));
    EXPECT_TRUE(project(scene.camera, scene.truth * Eigen::Vector3d(x_m, 0.01, 0.0), to));
    StepEdge edge;
    edge.normal = Eigen::Vector2d(to.y() - from.y(), from.x() - to.x()).normalized();
    if (edge.normal.x() < 0.0) edge.normal = -edge.normal;
    edge.distance_px = edge.normal.dot(from) + aside_px;
    edge.contrast = contrast;
    return edge;
  }
  /// How far to the right the strip ends up, in pixels along the edges' normal.
  double shift_px() const {
    Refined refined;
    const PoseEstimate held = holdingAllButX(scene.truth);
    refined.pass(scene, scene.truth, 2.0, nullptr, &held);
    EXPECT_EQ(refined.status, Status::kOk);
    const Pose& pose = refined.result.camera_from_station;
    Eigen::Vector2d before;
    Eigen::Vector2d after;
    EXPECT_TRUE(project(scene.camera, scene.truth.translation_m, before));
    EXPECT_TRUE(project(scene.camera, pose.translation_m, after));
    return edgeAlong(kHalf_m, 0.0, 1.0).normal.dot(after - before);
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
  const Picture negative = negativeOf(edge.picture);
  const PoseEstimate held = holdingAllButX(startOf(edge));
  std::vector<double> across_px;
  for (const Picture* picture : {&std::as_const(edge.picture), &negative}) {
    edge.scene.picture = picture;
    Refined refined;
    refined.pass(edge.scene, startOf(edge), 4.0, nullptr, &held);
    ASSERT_EQ(refined.status, Status::kOk);
    EXPECT_GT(refined.result.used_count, 60);
    across_px.push_back(edge.placeOf(refined.result.camera_from_station, 0.0).x());
  }
  EXPECT_NEAR(across_px[0], across_px[1], 2e-2);
}

}  // namespace
}  // namespace boresight::test
