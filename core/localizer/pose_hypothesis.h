// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/accept/pose_evidence.h"
#include "core/geometry/pose.h"

namespace boresight {

/// Start of the attempt that found a hypothesis.
enum class HypothesisOrigin : std::uint8_t {
  kCandidate = 0,  ///< a candidate of the search
  kTemplates,      ///< templates matched around the first candidate
  kSeed,           ///< templates matched around the seed
  kRestart,        ///< the best pose, moved along a direction that the image determines weakly
};
inline constexpr HypothesisOrigin kLastHypothesisOrigin = HypothesisOrigin::kRestart;

/// A pose of a run that was refined and whose evidence was measured.
struct PoseHypothesis {
  Pose camera_from_station;                                ///< refined
  HypothesisOrigin origin = HypothesisOrigin::kCandidate;  ///< start of its attempt
  std::int32_t number = 0;                                 ///< of its origin, from 0
  PoseEvidence evidence;     ///< of the image; with several views, of the first one's
  double score = 0.0;        ///< scoreOf() the evidence of all views
  double probability = 0.0;  ///< PoseEvidence::probability(), the largest of several views
};

}  // namespace boresight
