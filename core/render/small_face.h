// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/render/camera_scene.h"
#include "core/render/rasterizer.h"
#include "core/render/ray_grid.h"

namespace boresight {

/// A face as its vertices' fixed pixels show it. The true vertices are at most half a step away
/// along each axis, so the value of a line through two of them, at a point of the face's box, is
/// wrong by at most the box's extents; an eighth more covers the bend of lines, four steps the
/// box's slack and terms of second order.
struct FixedFace {
  int a_x, a_y, b_x, b_y, c_x, c_y;
  int low_x, high_x, low_y, high_y;
  int area2;      ///< twice the area, positive when the inner side is seen
  int tolerance;  ///< values of lines (and the area) beyond this have the right sign

  FixedFace(const FixedPixel& a, const FixedPixel& b, const FixedPixel& c)
      : a_x(a.x), a_y(a.y), b_x(b.x), b_y(b.y), c_x(c.x), c_y(c.y) {
    low_x = lower(lower(a_x, b_x), c_x);
    low_y = lower(lower(a_y, b_y), c_y);
    high_x = higher(higher(a_x, b_x), c_x);
    high_y = higher(higher(a_y, b_y), c_y);
    const int extent = (high_x - low_x) + (high_y - low_y);
    tolerance = extent + extent / 8 + 4;
    area2 = (b_x - a_x) * (c_y - a_y) - (b_y - a_y) * (c_x - a_x);
  }

  /// > 0 when the inner side is seen, < 0 when the outer one is, 0 when this cannot be told.
  int sideSeen() const { return area2 > tolerance ? 1 : area2 < -tolerance ? -1 : 0; }

  /// Whether a point of the box lies inside (> 0), outside (< 0), or too near to a line (0).
  int locate(int x, int y) const {
    const int ab = (b_x - a_x) * (y - a_y) - (b_y - a_y) * (x - a_x);
    const int bc = (c_x - b_x) * (y - b_y) - (c_y - b_y) * (x - b_x);
    const int ca = area2 - ab - bc;
    const int side = sideSeen();
    if (side == 0) return 0;
    const int least = side > 0 ? lower(lower(ab, bc), ca) : -higher(higher(ab, bc), ca);
    return least > tolerance ? 1 : least < -tolerance ? -1 : 0;
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
/// inside or outside, clearly nearer or farther, and only the others need the face's exact edges
/// and plane. The result is that of `drawFace`, bit for bit, except that depths may stay unknown.
class SmallFaces {
 public:
  /// Largest extent along each image axis.
  static constexpr int kLargest_px = 8;

  /// Everything that is the same for all faces of a render.
  SmallFaces(const CameraScene& scene, const RayGrid& rays);
  SmallFaces() = default;

  /// Steps by which a small face may reach beyond its vertices' pixels.
  int slack() const { return slack_; }
  /// Whether faces may be drawn this way: where pixels without a ray may lie, none is.
  bool possible() const { return possible_; }
  /// The same, for one face that has pixels.
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
  const FixedScale& scale() const { return scale_; }

  void draw(const CameraScene& scene, std::int32_t face, RasterBand& band) const;

 private:
  int slack_ = 1;
  int largest_ = 0;
  bool possible_ = false;
  FixedScale scale_;
};

/// Computes the depths that small faces left unknown.
void resolveDepths(const CameraScene& scene, RasterBand& band);

}  // namespace boresight
