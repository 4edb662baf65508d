// SPDX-License-Identifier: Apache-2.0
// Factories of the methods, for the .cpp files of this folder.
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "sessions/baselines/method_options.h"
#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// A read-only cv::Mat on the image's pixels, without a copy.
inline cv::Mat matOf(const ImageView& image) {
  return {image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.data),
          static_cast<std::size_t>(image.stride)};
}

/// SSD and NCC (Pham 2025, Sec. V): every template's shaded intensities against the image's, at
/// all offsets of its search window, by OpenCV's matchTemplate. Templates without any contrast are
/// not found. Positions are refined by a parabola per axis when loop.subpixel_matches is set.
std::unique_ptr<MatchingMethod> makeSsd(const SsdOptions& options);
std::unique_ptr<MatchingMethod> makeNcc(const NccOptions& options);

/// ORB (Rublee 2011; Pham 2025, Sec. V): features of the shaded render against those of the image
/// that lie in their search windows, by the distance of their descriptors.
std::unique_ptr<MatchingMethod> makeOrb(const OrbOptions& options);

/// Images that an external matcher receives.
enum class ExternalFrames {
  kWhole,      ///< image and render as a whole (LoFTR-R of Pham 2025, Sec. V)
  kSubframes,  ///< from an attempt's second iteration on, in frames of the matcher's size (LoFTR-S)
};

/// Any matcher in a child process (MatcherClient): the render is the first image, the test image
/// the second. Pairs that begin on the object and end in the search window of their point are used:
/// the best templates.count of them. The child is started by the first run and serves all later
/// ones.
std::unique_ptr<MatchingMethod> makeExternal(const std::string& command,
                                             const ExternalOptions& options, ExternalFrames frames);

}  // namespace boresight::sessions
