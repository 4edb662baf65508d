// SPDX-License-Identifier: Apache-2.0
// Equations of one camera in the frame of another, against perturbations carried out and against
// one list of equations.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/base/random.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_options.h"
#include "core/pnp/pnp_ransac.h"
#include "core/pnp/refine_pose.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

double signedUniform(Random& random) { return 2.0 * random.uniform() - 1.0; }

Eigen::Vector3d randomVector(Random& random, double size) {
  return {size * signedUniform(random), size * signedUniform(random), size * signedUniform(random)};
}

Pose randomPose(Random& random, double turn_rad, double shift_m) {
  return {rotationExp(randomVector(random, turn_rad)), randomVector(random, shift_m)};
}

TEST(AdjointOf, CarriesSmallPerturbationsFromOneCameraToTheOther) {
  Random random(11);
  for (int i = 0; i < 50; ++i) {
    const Pose a_from_b = randomPose(random, 2.0, 0.5);
    const Pose b_from_station = randomPose(random, 2.0, 0.5);
    Vector6d xi;
    xi << randomVector(random, 1e-5), randomVector(random, 1e-5);
    const Pose moved = a_from_b * perturbed(xi, b_from_station);
    const Vector6d carried = perturbationBetween(a_from_b * b_from_station, moved);
    EXPECT_LT((carried - adjointOf(a_from_b) * xi).norm(), 1e-9);
  }
}

struct Seen {
  std::vector<Correspondence> correspondences;
  std::array<PnpView, 2> views;
};

/// Two cameras that see points about the station exactly from a pose.
Seen seenFrom(const Camera& camera, const Pose& second_from_first, const Pose& first_from_station,
              Random& random) {
  Seen made;
  made.views[0] = {&camera, Pose(), 0};
  made.views[1] = {&camera, second_from_first, 0};
  for (std::size_t v = 0; v < 2; ++v) {
    const Pose camera_from_station =
        v == 0 ? first_from_station : second_from_first * first_from_station;
    for (int i = 0; i < 20; ++i) {
      Correspondence one;
      one.point_in_station_m = randomVector(random, 0.05);
      EXPECT_TRUE(project(camera, camera_from_station * one.point_in_station_m, one.pixel));
      made.correspondences.push_back(one);
    }
    made.views[v].end = static_cast<std::int32_t>(made.correspondences.size());
  }
  return made;
}

TEST(RefinePoseOfViews, FindsThePoseThatBothCamerasSee) {
  Random random(12);
  const Camera camera = pinholeCamera();
  for (int i = 0; i < 20; ++i) {
    const Pose truth = truthPose();
    const Pose second_from_first{rotationExp({0.0, -0.2, 0.1}), {0.1, 0.0, 0.02}};
    const Seen seen = seenFrom(camera, second_from_first, truth, random);
    Vector6d xi;
    xi << randomVector(random, 0.05), randomVector(random, 0.01);
    Pose pose = perturbed(xi, truth);
    ASSERT_EQ(refinePose(seen.correspondences, {}, seen.views, nullptr, 30, pose), Status::kOk);
    EXPECT_LT(perturbationBetween(truth, pose).norm(), 1e-9);
  }
}

TEST(PnpRansacOfViews, BothSamplersFindThePoseDespiteWrongMatchesInEither) {
  Random random(13);
  const Camera camera = pinholeCamera();
  const Pose truth = truthPose();
  const Pose second_from_first{rotationExp({0.0, -0.2, 0.1}), {0.1, 0.0, 0.02}};
  for (const PnpSampler sampler : {PnpSampler::kP3p, PnpSampler::kGuided}) {
    Seen seen = seenFrom(camera, second_from_first, truth, random);
    for (std::size_t i = 0; i < seen.correspondences.size(); i += 4)
      seen.correspondences[i].pixel += Eigen::Vector2d(40.0, -25.0 - static_cast<double>(i));
    std::vector<std::byte> memory(100000);
    Arena arena(memory);
    PnpRansac ransac;
    ASSERT_EQ(ransac.create(40, arena), Status::kOk);
    std::vector<std::uint8_t> inlier(40);
    std::vector<double> residual_px(40);
    PnpSolution solution;
    solution.inlier = inlier;
    solution.residual_px = residual_px;
    PnpOptions options;
    options.sampler = sampler;
    Vector6d xi;
    xi << randomVector(random, 0.02), randomVector(random, 0.005);
    ASSERT_EQ(ransac.begin(seen.correspondences, seen.views, {perturbed(xi, truth), {}}, 2.0,
                           options, solution),
              Status::kOk);
    bool done = false;
    Status status = Status::kOk;
    while (!done) status = ransac.step(done);
    ASSERT_EQ(status, Status::kOk);
    EXPECT_EQ(solution.inlier_count, 30);
    EXPECT_LT(perturbationBetween(truth, solution.camera_from_station).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace boresight::test
