// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sessions/baselines/method_options.h"
#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// ORB (Rublee 2011; Pham 2025, Sec. IV): features of the shaded render against those of the image
/// that lie in their search windows, by the distance of their descriptors.
std::unique_ptr<MatchingMethod> makeOrb(const OrbOptions& options);

}  // namespace boresight::sessions
