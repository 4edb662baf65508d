// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"

namespace boresight {

/// Undistorted rays of an image's pixels, interpolated on a coarse grid: the camera stays the same
/// between iterations, and unprojecting a distorted pixel is iterative. Interpolated (x/z, y/z) is
/// within 1e-9 (1 + (x/z)^2 + (y/z)^2) of `unproject` where the model is smooth on the grid's
/// scale: nodes every 16 px, Newton's polynomial through 4 x 4 of them, or within 2e-8 through 6 x
/// 6 where that is not enough. Other cells, and those that touch pixels outside the model's valid
/// field, are unprojected pixel by pixel. Pinhole rays are computed directly.
class RayGrid {
 public:
  /// Takes a grid for the camera from `arena`. kInvalidCamera, kArenaTooSmall.
  static Status create(const Camera& camera, Arena& arena, RayGrid& grid);
  /// (x/z, y/z) of pixels (x_begin .. x_begin + count - 1, y); NaN-free: pixels outside the model's
  /// valid field get `valid[i] == 0`.
  void row(int y, int x_begin, int count, double* x_over_z, double* y_over_z,
           std::uint8_t* valid) const;
  /// The camera that the rays are of.
  const Camera& camera() const { return camera_; }

  /// True when every pixel of the image (and some beyond) has a ray, so that rays vary smoothly
  /// and the two bounds below hold.
  bool smooth() const { return smooth_; }
  /// True when y/z is the same all along each row (pinhole).
  bool level() const { return camera_.model == CameraModel::kPinhole; }
  /// Bound on the second derivatives of (x/z, y/z) along the image axes, per px^2; 0 for pinhole.
  double rayBend_per_px2() const { return ray_bend_per_px2_; }
  /// Bound on the curvature of the image of a straight line in space, 1/px; 0 for pinhole.
  double lineBend_per_px() const { return line_bend_per_px_; }

  /// Conservative range of rows (columns) that hold a pixel whose y/z (x/z) lies in
  /// [minimum, maximum]; empty when last < first.
  struct Range {
    int first = 0;  ///< the first row (column)
    int last = -1;  ///< the last row (column)
  };
  /// The range as above; of rows by y/z, of columns by x/z.
  ///@{
  Range rowsWithin(double minimum, double maximum) const;
  Range columnsWithin(double minimum, double maximum) const;
  ///@}

  static constexpr int kSpacing_px = 16;  ///< px between nodes
  /// Nodes before the first cell: the widest stencil begins two nodes before its cell.
  static constexpr int kMargin = 2;

 private:
  struct Node {
    double x = 0.0;
    double y = 0.0;
  };
  struct Hull {
    double minimum = 0.0;
    double maximum = 0.0;
  };

  const Node& node(int column, int row) const;
  bool nodeValid(int column, int row) const;
  bool nodesValid(int first_column, int first_row, int count) const;
  void fillNodes();
  void measureBends();
  void fillHulls();
  bool chooseStencils();
  template <int kNodes>
  bool checkCell(int cell_x, int cell_y, double tolerance) const;
  template <int kNodes>
  void interpolateRow(int y, int x_begin, int x_end, double* x_over_z, double* y_over_z,
                      std::uint8_t* valid) const;
  static Range rangeWithin(std::span<const Hull> hulls, int size, double minimum, double maximum);
  void unprojectRun(int y, int x_begin, int x_end, double* x_over_z, double* y_over_z,
                    std::uint8_t* valid) const;

  Camera camera_;
  int cells_x_ = 0;
  int cells_y_ = 0;
  int nodes_x_ = 0;
  int nodes_y_ = 0;
  bool wide_stencil_ = false;
  bool smooth_ = true;
  double ray_bend_per_px2_ = 0.0;
  double line_bend_per_px_ = 0.0;
  std::span<Node> nodes_;
  std::span<std::uint8_t> node_valid_;
  std::span<std::uint8_t> cell_exact_;  ///< 1: unproject pixel by pixel
  std::span<Hull> row_hull_;            ///< of y/z, per row of cells
  std::span<Hull> column_hull_;         ///< of x/z, per column of cells
};

}  // namespace boresight
