// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sessions/baselines/method_options.h"
#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// SSD and NCC (Pham 2025, Sec. IV): every template's shaded intensities against the image's, at
/// all offsets of its search window, by OpenCV's matchTemplate. Templates without any contrast are
/// not found. Places are refined by a parabola per axis where loop.subpixel_matches asks for it.
std::unique_ptr<MatchingMethod> makeSsd(const SsdOptions& options);
std::unique_ptr<MatchingMethod> makeNcc(const NccOptions& options);

}  // namespace boresight::sessions
