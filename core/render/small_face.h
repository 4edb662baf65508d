// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/render/camera_scene.h"
#include "core/render/rasterizer.h"
#include "core/render/ray_grid.h"

namespace boresight {

/// A face by the fixed pixels of its vertices. The true vertices are at most half a step away
/// along each axis, so the value of a line through two of them, at a point of the face's box, is
/// wrong by at most the box's extents; the bend of lines adds its share of them, and four steps
/// cover the box's slack and terms of second order.
struct FixedFace {
  int a_x, a_y, b_x, b_y, c_x, c_y;
  int low_x, high_x, low_y, high_y;

  FixedFace(const FixedPixel& a, const FixedPixel& b, const FixedPixel& c)
      : a_x(a.x), a_y(a.y), b_x(b.x), b_y(b.y), c_x(c.x), c_y(c.y) {
    low_x = lower(lower(a_x, b_x), c_x);
    low_y = lower(lower(a_y, b_y), c_y);
    high_x = higher(higher(a_x, b_x), c_x);
    high_y = higher(higher(a_y, b_y), c_y);
  }

  /// Twice the area, positive when the inner side is seen.
  int area2() const { return (b_x - a_x) * (c_y - a_y) - (b_y - a_y) * (c_x - a_x); }
  /// Values of lines a to b and b to c at a point; all three add up to area2().
  int lineAb(int x, int y) const { return (b_x - a_x) * (y - a_y) - (b_y - a_y) * (x - a_x); }
  int lineBc(int x, int y) const { return (c_x - b_x) * (y - b_y) - (c_y - b_y) * (x - b_x); }

  /// Whether a point with these values lies inside (> 0), outside (< 0), or too near to a line (0).
  /// Inside, all three values have the same sign, which depends on the side that is seen.
  static int locate(int ab, int bc, int ca, int tolerance) {
    const int least = lower(lower(ab, bc), ca);
    const int most = higher(higher(ab, bc), ca);
    if (least < -tolerance && most > tolerance) return -1;
    return least > tolerance || most < -tolerance ? 1 : 0;
  }

 private:
  static int lower(int a, int b) { return a < b ? a : b; }
  static int higher(int a, int b) { return a > b ? a : b; }
};

/// Pixels counted from the middle of the image.
struct PixelBox {
  int x_first, x_last, y_first, y_last;
};

/// Faces this small are drawn by their vertices' fixed pixels: most of their pixels are clearly
/// inside or outside, clearly nearer or farther, and only the remaining pixels need the face's
/// exact edges and plane. The result is that of `drawFace`, bit for bit, except that depths may
/// stay unknown.
class SmallFaces {
 public:
  /// Largest extent along each image axis.
  static constexpr int kLargest_px = 12;

  /// Computes the data that all faces of a render share.
  SmallFaces(const CameraScene& scene, const RayGrid& rays);
  SmallFaces() = default;

  /// Steps by which a small face may reach beyond its vertices' pixels.
  int slack() const { return slack_; }
  /// Whether faces may be drawn this way; false when some pixels may have no ray.
  bool possible() const { return possible_; }
  /// Whether a face whose vertices have pixels is drawn this way.
  bool isSmall(const FixedFace& face) const {
    return possible_ && face.high_x - face.low_x <= largest_ &&
           face.high_y - face.low_y <= largest_;
  }
  /// The pixels whose centres a small face may cover.
  PixelBox box(const FixedFace& face) const {
    const int up = scale_.steps() - 1 - slack_;
    return {(face.low_x + up) >> scale_.shift, (face.high_x + slack_) >> scale_.shift,
            (face.low_y + up) >> scale_.shift, (face.high_y + slack_) >> scale_.shift};
  }
  /// Values of lines and areas larger than this have the correct sign.
  int tolerance(const FixedFace& face) const {
    const int extent = (face.high_x - face.low_x) + (face.high_y - face.low_y);
    return extent + ((extent * bend_) >> 3) + 4;
  }
  const FixedScale& scale() const { return scale_; }

  void draw(const CameraScene& scene, std::int32_t face, RasterBand& band) const;

 private:
  int slack_ = 1;
  int bend_ = 0;  ///< eighths of a step by which lines may bend
  int largest_ = 0;
  bool possible_ = false;
  FixedScale scale_;
};

/// Computes the depths that small faces left unknown.
void resolveDepths(const CameraScene& scene, RasterBand& band);

}  // namespace boresight
