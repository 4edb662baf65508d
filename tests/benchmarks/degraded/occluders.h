// SPDX-License-Identifier: Apache-2.0
// Things before the object that cover a stated share of its silhouette.
#pragma once

#include <opencv2/core.hpp>

#include "core/base/random.h"

namespace boresight::test {

/// A pixel of the silhouette, or the picture's middle where there is none.
cv::Point placeWithin(const cv::Mat& silhouette, Random& random);

/// An ellipse of one gray, with a little noise.
void coverGray(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture);
/// An ellipse that shows another place of the picture.
void coverTexture(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture);
/// Dark straight bands across the object.
void coverCables(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture);

}  // namespace boresight::test
