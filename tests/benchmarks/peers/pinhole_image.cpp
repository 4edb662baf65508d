// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tests/benchmarks/peers/peer.h"

namespace boresight::peers {

PinholeImage atLevel(const PinholeImage& image, int level) {
  if (level == 0) return image;
  const double scale = std::ldexp(1.0, -level);
  PinholeImage smaller;
  cv::resize(image.gray, smaller.gray, {}, scale, scale, cv::INTER_AREA);
  if (!image.colour.empty())
    cv::resize(image.colour, smaller.colour, {}, scale, scale, cv::INTER_AREA);
  smaller.fx = image.fx * scale;
  smaller.fy = image.fy * scale;
  smaller.cx = (image.cx + 0.5) * scale - 0.5;
  smaller.cy = (image.cy + 0.5) * scale - 0.5;
  return smaller;
}

int levelsOf(const PinholeImage& image, int levels, int least_side_px) {
  int fitting = 1;
  while (fitting < levels &&
         (std::min(image.gray.cols, image.gray.rows) >> fitting) >= least_side_px)
    ++fitting;
  return fitting;
}

}  // namespace boresight::peers
