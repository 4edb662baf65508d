// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mark_equations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sessions/annotation/marked_scene.h"

namespace boresight::sessions {
namespace {

using test::MarkedScene;
using test::randomFor;
using test::randomScene;

constexpr CameraModel kModels[] = {CameraModel::kPinhole, CameraModel::kBrownConrady,
                                   CameraModel::kKannalaBrandt, CameraModel::kCahvor,
                                   CameraModel::kCahvore};

TEST(MarkEquations, ResidualsVanishAtTheTruth) {
  Random random = randomFor("MarkEquations.Truth");
  for (const CameraModel model : kModels) {
    const MarkedScene scene = randomScene(random, model, 5, 5, 0.0);
    for (const MarkAddress& at : usedMarks(scene.views())) {
      const MarkResidual mark = markResidual(scene.view, at, scene.camera_from_station);
      ASSERT_TRUE(mark.valid);
      EXPECT_LT(mark.residual_px.norm(), 1e-6);
      EXPECT_NEAR(mark.depth_m, 0.5, 0.2);
    }
  }
}

TEST(MarkEquations, JacobiansAreTheDifferencesOfResiduals) {
  Random random = randomFor("MarkEquations.Jacobian");
  constexpr double kStep = 1e-6;
  for (const CameraModel model : kModels) {
    const MarkedScene scene = randomScene(random, model, 10, 10, 0.0);
    for (const MarkAddress& at : usedMarks(scene.views())) {
      const MarkResidual mark = markResidual(scene.view, at, scene.camera_from_station);
      for (int i = 0; i < 6; ++i) {
        const Vector6d xi = kStep * Vector6d::Unit(i);
        const MarkResidual ahead =
            markResidual(scene.view, at, perturbed(xi, scene.camera_from_station));
        const MarkResidual behind =
            markResidual(scene.view, at, perturbed(-xi, scene.camera_from_station));
        const Eigen::Vector2d difference = (behind.residual_px - ahead.residual_px) / (2.0 * kStep);
        EXPECT_LT((difference - mark.predicted_by_xi.col(i)).norm(),
                  1e-5 * (1.0 + difference.norm()));
      }
    }
  }
}

TEST(MarkEquations, ALinesResidualIsItsDistanceFromTheProjectedEdge) {
  // By brute force: the nearest of many points of the edge, projected with distortion and all.
  Random random = randomFor("MarkEquations.Distance");
  for (const CameraModel model : kModels) {
    for (int trial = 0; trial < 20; ++trial) {
      const MarkedScene scene = randomScene(random, model, 0, 1, 0.5);
      const LinePair& pair = scene.view.marks.lines[0];
      const MarkResidual mark =
          markResidual(scene.view, {0, MarkKind::kLine, 0}, scene.camera_from_station);
      ASSERT_TRUE(mark.valid);
      const Eigen::Vector2d ends[2] = {pair.line->start, pair.line->end};
      for (int end = 0; end < 2; ++end) {
        double nearest_px = 1e9;
        for (int i = -20000; i <= 120000; ++i) {
          const double t = i / 100000.0;
          Eigen::Vector2d pixel;
          if (project(scene.view.camera,
                      scene.camera_from_station * ((1.0 - t) * pair.edge->start_in_station_m +
                                                   t * pair.edge->end_in_station_m),
                      pixel))
            nearest_px = std::min(nearest_px, (pixel - ends[end]).norm());
        }
        EXPECT_NEAR(std::abs(mark.residual_px[end]), nearest_px, 0.01 * nearest_px + 2e-3);
      }
    }
  }
}

TEST(MarkEquations, TheAdjointMovesARigsPerturbationToItsCamera) {
  Random random = randomFor("MarkEquations.Adjoint");
  for (int trial = 0; trial < 50; ++trial) {
    const Pose camera_from_rig = test::randomPose(random);
    const Pose rig_from_station = test::randomPose(random);
    const Vector6d xi = 1e-7 * Vector6d::Ones() * random.normal();
    const Pose moved = camera_from_rig * perturbed(xi, rig_from_station);
    const Vector6d seen = perturbationBetween(camera_from_rig * rig_from_station, moved);
    EXPECT_LT((seen - adjointOf(camera_from_rig) * xi).norm(), 1e-12);
  }
}

TEST(MarkEquations, WhatDoesNotProjectCountsAsMissing) {
  Random random = randomFor("MarkEquations.Missing");
  const MarkedScene scene = randomScene(random, CameraModel::kPinhole, 4, 2, 0.0);
  Pose behind = scene.camera_from_station;
  behind.translation_m.z() = -5.0;
  const NormalEquations equations =
      markEquations(scene.views(), usedMarks(scene.views()), {}, behind);
  EXPECT_EQ(equations.missing, 6);
  EXPECT_EQ(equations.projected, 0);
}

}  // namespace
}  // namespace boresight::sessions
