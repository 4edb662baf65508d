// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/pose_file.h"

namespace boresight::sessions {

/// Seeds for the frames of a sequence. Each starts from the last accepted pose with the stated
/// motion between two frames as its uncertainty. While frames are lost, the uncertainty doubles
/// with each; once it would exceed the first seed's, that one is taken. Until a first pose is
/// accepted, every frame starts from the first seed.
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
  /// How the next frame ended: with an accepted pose, or lost.
  void take(const std::optional<Pose>& camera_from_station);

 private:
  Pose camera_from_station_;
  DeclaredUncertainty first_;
  DeclaredUncertainty motion_;
  bool found_ = false;  ///< any frame
  int lost_ = 0;        ///< frames since the last accepted one
};

}  // namespace boresight::sessions
