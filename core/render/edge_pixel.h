// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/image.h"
#include "core/base/nth.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

/// A salient edge pixel. It belongs to the *nearer* of the two surfaces that meet in it.
struct EdgePixel {
  std::int16_t x = 0;  ///< px
  std::int16_t y = 0;  ///< px
  /// z of the nearer surface's plane at the pixel's centre, extended by at most one pixel. For a
  /// face seen at less than 9 deg, whose extended plane is uncertain, z at the line.
  float depth_m = 0.0F;
  /// The nearer surface's face (its part and normal follow): the one seen at the pixel, or, where
  /// the pixel lies beyond the surface, the one that ends at the line.
  std::int32_t face = 0;
  std::int8_t normal_x = 0;  ///< unit normal of the line in the image, times 127, pointing from the
  std::int8_t normal_y = 0;  ///< nearer surface to the other side
  std::int8_t offset =
      0;  ///< signed distance from pixel centre to the line along that normal, 1/100 px
  std::uint8_t kind = 0;  ///< EdgeKind bits

  /// normal_x and normal_y as a vector of about unit length.
  Eigen::Vector2d normal() const { return Eigen::Vector2d(normal_x, normal_y) / 127.0; }
  /// The point of the line nearest to the pixel's centre, px.
  Eigen::Vector2d onLine_px() const { return Eigen::Vector2d(x, y) + 0.01 * offset * normal(); }
};

/// An edge pixel as stored in a render, without its row, which follows from EdgeRender::row_begin.
class PackedEdgePixel {
 public:
  static constexpr std::size_t kMostFaces = std::size_t{1} << 21;  ///< of a mesh

  PackedEdgePixel() = default;
  /// Packs everything but the row.
  explicit PackedEdgePixel(const EdgePixel& pixel)
      : depth_m_(pixel.depth_m),
        face_kind_offset_(static_cast<std::uint32_t>(pixel.face) << 11 |
                          static_cast<std::uint32_t>(pixel.kind & 7) << 8 |
                          static_cast<std::uint8_t>(pixel.offset)),
        x_(pixel.x),
        normal_x_(pixel.normal_x),
        normal_y_(pixel.normal_y) {}

  std::int16_t x() const { return x_; }  ///< px
  /// The pixel, of row `y`.
  EdgePixel unpacked(int y) const {
    return {x_,
            static_cast<std::int16_t>(y),
            depth_m_,
            static_cast<std::int32_t>(face_kind_offset_ >> 11),
            normal_x_,
            normal_y_,
            static_cast<std::int8_t>(face_kind_offset_ & 255),
            static_cast<std::uint8_t>(face_kind_offset_ >> 8 & 7)};
  }

 private:
  float depth_m_ = 0.0F;
  std::uint32_t face_kind_offset_ = 0;  ///< 21, 3 and 8 bits
  std::int16_t x_ = 0;
  std::int8_t normal_x_ = 0;
  std::int8_t normal_y_ = 0;
};
static_assert(sizeof(PackedEdgePixel) == 12);

enum EdgeKind : std::uint8_t {
  kEdgeCrease = 1,     ///< the normals differ
  kEdgeOccluding = 2,  ///< the depths differ
  kEdgeBorder = 4,     ///< the other side is background
};

/// Whether the pixel is between the object and the background.
inline bool isBorder(const EdgePixel& pixel) { return (pixel.kind & kEdgeBorder) != 0; }

class EdgePixelRange;

/// Salient edges of the scene from one pose (Pham 2025, Sec. III-B): the baseline edge map, its
/// mask, and depth, normal and sub-pixel place at the edge pixels, in raster order.
struct EdgeRender {
  BitImage edges;  ///< 1 at salient edges
  BitImage mask;   ///< 1 where a matched part is the nearest surface, and at every edge pixel
  /// Capacity; the first `pixel_count` are valid, raster order.
  std::span<PackedEdgePixel> pixels;
  std::span<std::int32_t> row_begin;  ///< height + 1 indices into pixels
  std::int32_t pixel_count = 0;       ///< salient edge pixels
  /// Words for the largest image; `edges` and `mask` use the words that the current camera needs.
  std::span<std::uint64_t> edge_words;
  std::span<std::uint64_t> mask_words;  ///< words of the mask
  Camera camera;                        ///< the camera at this level
  Pose camera_from_station;             ///< the pose rendered

  /// An edge pixel by its index; searches its row.
  EdgePixel pixel(std::int32_t index) const;
  /// The stride that leaves at most `most` edge pixels.
  std::int32_t strideFor(std::int32_t most) const {
    return std::max(1, (pixel_count + most - 1) / most);
  }
  /// Every `stride`-th edge pixel, to iterate over.
  EdgePixelRange eachPixel(std::int32_t stride = 1) const;
};

/// Every n-th edge pixel of a render, in raster order.
class EdgePixelRange {
 public:
  /// Yields each pixel with its row.
  class Iterator {
   public:
    /// At a pixel of a render.
    Iterator(const EdgeRender& render, std::int32_t index, std::int32_t stride)
        : render_(&render), index_(index), stride_(stride) {
      findRow();
    }
    /// The pixel.
    EdgePixel operator*() const { return nth(render_->pixels, index_).unpacked(y_); }
    /// The next pixel.
    Iterator& operator++() {
      index_ += stride_;
      findRow();
      return *this;
    }
    /// True before the end.
    bool operator!=(const Iterator& end) const { return index_ < end.index_; }

   private:
    void findRow() {
      while (y_ + 1 < render_->edges.height &&
             render_->row_begin[static_cast<std::size_t>(y_) + 1] <= index_)
        ++y_;
    }

    const EdgeRender* render_;
    std::int32_t index_;
    std::int32_t stride_;
    int y_ = 0;
  };

  /// `render` must outlive the range.
  EdgePixelRange(const EdgeRender& render, std::int32_t stride)
      : render_(render), stride_(stride) {}
  Iterator begin() const { return {render_, 0, stride_}; }                  ///< First pixel
  Iterator end() const { return {render_, render_.pixel_count, stride_}; }  ///< Behind the last

 private:
  const EdgeRender& render_;
  std::int32_t stride_;
};

inline EdgePixelRange EdgeRender::eachPixel(std::int32_t stride) const { return {*this, stride}; }

inline EdgePixel EdgeRender::pixel(std::int32_t index) const {
  const auto first = row_begin.begin();
  const auto row = std::upper_bound(first, first + edges.height, index);
  return nth(pixels, index).unpacked(static_cast<int>(row - first) - 1);
}

}  // namespace boresight
