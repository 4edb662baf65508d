// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sessions/baselines/method_options.h"
#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// What an external matcher is shown.
enum class ExternalFrames {
  kWhole,      ///< image and render as a whole (LoFTR-R of Pham 2025, Sec. IV)
  kSubframes,  ///< from an attempt's second iteration on, in frames of the matcher's size (LoFTR-S)
};

/// Any matcher in a child process (MatcherClient): the render is the first image, the test image
/// the second. Of its pairs, those are taken that begin on the object and end in the search window
/// of their point, the best templates.count of them. The child is started by the first run and
/// serves all later ones.
std::unique_ptr<MatchingMethod> makeExternal(const std::string& command,
                                             const ExternalOptions& options, ExternalFrames frames);

}  // namespace boresight::sessions
