// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/core/localizer/scene.h"

// Scenes of repeated features: equal sleeves on a bar whose ends tell them apart.
namespace boresight::test {

inline constexpr double kPitch_m = 0.022;

/// Visibility of a rail's ends in the picture.
enum class Ends { kSeen, kHidden, kOutside };

/// A bar along x with `sleeves` equal sleeves; between its ends, a box and a prism, unless it goes
/// on beyond the picture.
Solid railMesh(int sleeves, bool with_ends);
/// The rail before the pinhole camera, the seed `off_pitches` along the bar from the truth (and a
/// little off in everything else), the uncertainty as wide as `declared_pitches` along it.
Case railCase(Ends ends, double off_pitches, double declared_pitches, std::uint64_t seed);
/// Number of pitches along the bar between an estimate and the truth, and the remaining distance.
struct PitchError {
  double pitches = 0.0;
  double rest_m = 0.0;
};
PitchError pitchError(const Case& scene, const Pose& estimate);

}  // namespace boresight::test
