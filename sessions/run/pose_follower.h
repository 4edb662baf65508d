// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/pose_file.h"

namespace boresight::sessions {

/// Seeds for the frames of a sequence. Each starts from the last accepted pose with the stated
/// motion between two frames as its uncertainty. While frames are lost, the uncertainty doubles
/// with each; once it would exceed the first seed's, the first seed's is used. Until a first pose
/// is accepted, every frame starts from the first seed.
class PoseFollower {
 public:
  /// `motion` is the largest motion between two frames.
  PoseFollower(const Pose& camera_from_station_seed, const DeclaredUncertainty& uncertainty,
               const DeclaredUncertainty& motion)
      : camera_from_station_(camera_from_station_seed), first_(uncertainty), motion_(motion) {}

  /// Seed of the next frame.
  const Pose& camera_from_station() const { return camera_from_station_; }
  /// Uncertainty of that seed.
  DeclaredUncertainty uncertainty() const;
  /// Takes the result of the next frame: its accepted pose, or empty when lost.
  void take(const std::optional<Pose>& camera_from_station);

 private:
  Pose camera_from_station_;
  DeclaredUncertainty first_;
  DeclaredUncertainty motion_;
  bool found_ = false;  ///< a frame was accepted
  int lost_ = 0;        ///< frames since the last accepted one
};

}  // namespace boresight::sessions
