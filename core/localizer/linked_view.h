// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/geometry/pose.h"
#include "core/localizer/workspace.h"
#include "core/pnp/normal_equations.h"

namespace boresight {

/// A localizer's part when several views are solved as one (core/views): none, the one whose loop
/// is that of all, or one that does in its own image what the leader's loop asks for.
enum class ViewRole : std::uint8_t { kAlone = 0, kLeads, kFollows };

/// What a localizer that leads or follows waits for, once it has done what it can do alone.
enum class ViewNeed : std::uint8_t {
  kNothing = 0,
  kPlace,    ///< a follower: where the leader's loop stands
  kPose,     ///< its matches are there, or `failed` says why not
  kRound,    ///< a refinement round's edges have been searched
  kSupport,  ///< its edge support has been measured
};

/// State of a localizer that does not run alone.
struct LinkedView {
  ViewRole role = ViewRole::kAlone;    ///< whether it leads, follows, or runs alone
  ViewNeed need = ViewNeed::kNothing;  ///< what it waits for
  /// What left the view without a say in this hypothesis or refinement; kRunning: nothing.
  LocalizationStatus failed = LocalizationStatus::kRunning;
  std::uint8_t failed_at = 0;   ///< Stage
  SeedUncertainty uncertainty;  ///< a follower's, of this iteration
  NormalEquations round;        ///< the view's own, of the round at hand
};

}  // namespace boresight
