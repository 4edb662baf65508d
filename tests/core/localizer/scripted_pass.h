// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <gtest/gtest.h>

#include "core/localizer/pass_plan.h"
#include "core/localizer/workspace.h"

namespace boresight::test {

/// Stands in for a pass: fills in what a policy reads of a record, without an image.
class ScriptedPass {
 public:
  ScriptedPass() {
    camera_.width = camera_.height = 2048;
    camera_.fx = camera_.fy = 3000.0;
    camera_.cx = camera_.cy = 1023.5;
    EXPECT_EQ(prepareCamera(camera_), Status::kOk);
    scene_.minimum_m = {-0.05, -0.05, -0.05};
    scene_.maximum_m = {0.05, 0.05, 0.05};
    ProblemSize size;
    size.width = size.height = 2048;
    levels_ = levelsOf(size, options);
  }

  RunContext context() const { return {options, camera_, scene_, levels_}; }

  /// The record of a match pass that found a pose.
  Agreement match(const PassPlan& plan, const Pose& found, int inliers, int matches = 90) {
    Iteration& record = start(plan, IterationKind::kMatch);
    record.correspondence_count = 0;
    record.pnp.camera_from_station = found;
    record.pnp.covariance = Matrix6d::Identity() * 1e-8;
    record.pnp.inlier_count = inliers;
    outcome = {};
    outcome.reached = Stage::kPose;
    return {inliers, matches};
  }
  /// The record of a match pass that failed.
  Agreement fail(const PassPlan& plan, Stage stage, LocalizationStatus status) {
    Iteration& record = start(plan, IterationKind::kMatch);
    record.status = status;
    record.pnp.inlier_count = 0;
    record.pnp.camera_from_station = plan.camera_from_station;
    outcome = {};
    outcome.reached = stage;
    return {};
  }
  /// The record of a refinement that found a pose.
  void refine(const PassPlan& plan, const Pose& found) {
    Iteration& record = start(plan, IterationKind::kRefine);
    record.refinement.camera_from_station = found;
    record.refinement.covariance = Matrix6d::Identity() * 1e-10;
    outcome = {};
    outcome.reached = Stage::kRefine;
  }

  LocalizerOptions options;
  std::array<Iteration, 2> records;
  PassOutcome outcome;

 private:
  Iteration& start(const PassPlan& plan, IterationKind kind) {
    Iteration& record = records[static_cast<std::size_t>(plan.record)];
    record.kind = kind;
    record.attempt = plan.attempt;
    record.level = plan.level;
    record.threshold_px = plan.threshold_px;
    record.camera_from_station_before = plan.camera_from_station;
    record.uncertainty = plan.uncertainty;
    record.status = LocalizationStatus::kRunning;
    return record;
  }

  Camera camera_;
  BoundingBox scene_;
  RunLevels levels_;
};

/// A seed half a metre in front of the camera, with the default uncertainty about the camera.
inline Seed seedInFront() {
  Seed seed;
  seed.camera_from_station.translation_m = {0.0, 0.0, 0.5};
  return seed;
}

inline Pose movedBy(Pose pose, double x_m) {
  pose.translation_m.x() += x_m;
  return pose;
}

}  // namespace boresight::test
