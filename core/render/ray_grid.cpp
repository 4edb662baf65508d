// SPDX-License-Identifier: Apache-2.0
#include "core/render/ray_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/render/ray_stencil.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

constexpr int kSpacing = RayGrid::kSpacing_px;
static_assert(kSpacing == stencil::kSpacing);
constexpr double kEverything = 1e300;
/// Largest errors in (x/z, y/z), times 1 + (x/z)^2 + (y/z)^2, that a stencil may make: the wide one
/// stays below a millionth of the depth of faces up to 80 deg off.
constexpr double kTolerance = 1e-9;
constexpr double kWideTolerance = 2e-8;

RayGrid::Range pinholeRange(double minimum, double maximum, double focal_px, double centre_px,
                            int size) {
  double low = minimum * focal_px + centre_px;
  double high = maximum * focal_px + centre_px;
  if (low > high) std::swap(low, high);
  RayGrid::Range range;
  // One pixel of slack covers rounding.
  range.first = floorClamped(low - 1.0, 0, size);
  range.last = floorClamped(high + 1.0, -1, size - 1);
  return range;
}

}  // namespace

Status RayGrid::create(const Camera& camera, Arena& arena, RayGrid& grid) {
  grid = RayGrid();
  if (camera.width <= 0 || camera.height <= 0 || camera.width > 32767 || camera.height > 32767 ||
      !(std::abs(camera.fx) > 0.0) || !(std::abs(camera.fy) > 0.0) ||
      !(std::abs(camera.fx) < 1e12) || !(std::abs(camera.fy) < 1e12) ||
      !(std::abs(camera.cx) < 1e12) || !(std::abs(camera.cy) < 1e12))
    return Status::kInvalidCamera;
  grid.camera_ = camera;
  if (camera.model == CameraModel::kPinhole) return Status::kOk;

  grid.cells_x_ = (camera.width - 1) / kSpacing + 1;
  grid.cells_y_ = (camera.height - 1) / kSpacing + 1;
  grid.nodes_x_ = grid.cells_x_ + 2 * kMargin + 1;
  grid.nodes_y_ = grid.cells_y_ + 2 * kMargin + 1;
  const auto nodes =
      static_cast<std::size_t>(grid.nodes_x_) * static_cast<std::size_t>(grid.nodes_y_);
  grid.nodes_ = arena.allocate<Node>(nodes);
  grid.node_valid_ = arena.allocate<std::uint8_t>(nodes);
  grid.cell_exact_ = arena.allocate<std::uint8_t>(static_cast<std::size_t>(grid.cells_x_) *
                                                  static_cast<std::size_t>(grid.cells_y_));
  grid.row_hull_ = arena.allocate<Hull>(static_cast<std::size_t>(grid.cells_y_));
  grid.column_hull_ = arena.allocate<Hull>(static_cast<std::size_t>(grid.cells_x_));
  if (arena.countsOnly()) return Status::kOk;
  if (arena.exhausted()) return Status::kArenaTooSmall;

  grid.fillNodes();
  grid.measureBends();
  grid.fillHulls();
  // Four nodes are enough for a camera with little distortion, and cheaper at every pixel.
  if (!grid.chooseStencils()) {
    grid.wide_stencil_ = true;
    (void)grid.chooseStencils();  // what is still too coarse is unprojected pixel by pixel
  }
  return Status::kOk;
}

const RayGrid::Node& RayGrid::node(int column, int row) const {
  return nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_x_) +
                static_cast<std::size_t>(column)];
}

bool RayGrid::nodeValid(int column, int row) const {
  return node_valid_[static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_x_) +
                     static_cast<std::size_t>(column)] != 0;
}

void RayGrid::fillNodes() {
  std::size_t index = 0;
  for (int row = 0; row < nodes_y_; ++row) {
    for (int column = 0; column < nodes_x_; ++column, ++index) {
      const Eigen::Vector2d pixel((column - kMargin) * kSpacing, (row - kMargin) * kSpacing);
      Eigen::Vector3d ray;
      if (!unproject(camera_, pixel, ray)) continue;
      nodes_[index] = {ray.x(), ray.y()};
      node_valid_[index] = 1;
    }
  }
}

/// Second differences over the image and one node beyond; a factor of two covers what happens
/// between nodes. A straight line a.(r - r0) = 0 in ray space has the image p(s) with
/// J p'' = -H[p', p'], so its curvature is at most |H| / (smallest singular value of J).
void RayGrid::measureBends() {
  double ray_bend = 0.0;
  double line_bend = 0.0;
  for (int row = kMargin - 1; row <= cells_y_ + kMargin; ++row) {
    for (int column = kMargin - 1; column <= cells_x_ + kMargin; ++column) {
      bool valid = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) valid = valid && nodeValid(column + dx, row + dy);
      smooth_ = smooth_ && valid;
      if (!valid) continue;
      const Node& centre = node(column, row);
      const Node& left = node(column - 1, row);
      const Node& right = node(column + 1, row);
      const Node& up = node(column, row - 1);
      const Node& down = node(column, row + 1);
      const double xx_x = left.x - 2.0 * centre.x + right.x;
      const double xx_y = left.y - 2.0 * centre.y + right.y;
      const double yy_x = up.x - 2.0 * centre.x + down.x;
      const double yy_y = up.y - 2.0 * centre.y + down.y;
      const double xy_x = 0.25 * (node(column + 1, row + 1).x - node(column - 1, row + 1).x -
                                  node(column + 1, row - 1).x + node(column - 1, row - 1).x);
      const double xy_y = 0.25 * (node(column + 1, row + 1).y - node(column - 1, row + 1).y -
                                  node(column + 1, row - 1).y + node(column - 1, row - 1).y);
      ray_bend =
          std::max({ray_bend, std::abs(xx_x), std::abs(xx_y), std::abs(yy_x), std::abs(yy_y)});
      const double h2 =
          xx_x * xx_x + xx_y * xx_y + yy_x * yy_x + yy_y * yy_y + 2.0 * (xy_x * xy_x + xy_y * xy_y);
      const double jxx = 0.5 * (right.x - left.x);
      const double jyx = 0.5 * (right.y - left.y);
      const double jxy = 0.5 * (down.x - up.x);
      const double jyy = 0.5 * (down.y - up.y);
      const double determinant = std::abs(jxx * jyy - jxy * jyx);
      const double norm = std::sqrt(jxx * jxx + jyx * jyx + jxy * jxy + jyy * jyy);
      const double bend = std::sqrt(h2) * norm / std::max(determinant, 1e-300) / kSpacing;
      line_bend = std::max(line_bend, bend);
    }
  }
  ray_bend_per_px2_ = 2.0 * ray_bend / (kSpacing * kSpacing);
  line_bend_per_px_ = std::min(2.0 * line_bend, 1e6);
}

/// A row (column) of cells lies within the hull of the nodes on its two sides and the next ones;
/// unbounded where one of those has no ray.
void RayGrid::fillHulls() {
  for (int cell = 0; cell < cells_y_; ++cell) {
    Hull hull{kEverything, -kEverything};
    for (int row = cell + kMargin - 1; row <= cell + kMargin + 2; ++row)
      for (int column = kMargin - 1; column <= cells_x_ + kMargin + 1; ++column) {
        const double value = node(column, row).y;
        hull.minimum = nodeValid(column, row) ? std::min(hull.minimum, value) : -kEverything;
        hull.maximum = nodeValid(column, row) ? std::max(hull.maximum, value) : kEverything;
      }
    row_hull_[static_cast<std::size_t>(cell)] = hull;
  }
  for (int cell = 0; cell < cells_x_; ++cell) {
    Hull hull{kEverything, -kEverything};
    for (int column = cell + kMargin - 1; column <= cell + kMargin + 2; ++column)
      for (int row = kMargin - 1; row <= cells_y_ + kMargin + 1; ++row) {
        const double value = node(column, row).x;
        hull.minimum = nodeValid(column, row) ? std::min(hull.minimum, value) : -kEverything;
        hull.maximum = nodeValid(column, row) ? std::max(hull.maximum, value) : kEverything;
      }
    column_hull_[static_cast<std::size_t>(cell)] = hull;
  }
}

/// Marks the cells that the present stencil cannot interpolate; true when there are none but those
/// without rays at their nodes.
bool RayGrid::chooseStencils() {
  bool enough = true;
  const int before = wide_stencil_ ? 2 : 1;
  const int after = wide_stencil_ ? 3 : 2;
  for (int cell_y = 0; cell_y < cells_y_; ++cell_y) {
    for (int cell_x = 0; cell_x < cells_x_; ++cell_x) {
      bool valid = true;
      for (int dy = -before; dy <= after; ++dy)
        for (int dx = -before; dx <= after; ++dx)
          valid = valid && nodeValid(cell_x + kMargin + dx, cell_y + kMargin + dy);
      bool exact = !valid;
      if (valid) {
        const bool good = wide_stencil_ ? checkCell<6>(cell_x, cell_y, kWideTolerance)
                                        : checkCell<4>(cell_x, cell_y, kTolerance);
        enough = enough && good;
        exact = !good;
      }
      cell_exact_[static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(cells_x_) +
                  static_cast<std::size_t>(cell_x)] = exact ? 1 : 0;
    }
  }
  return enough;
}

/// Compares the interpolation with `unproject` at the cell's centre, where it is worst.
template <int kNodes>
bool RayGrid::checkCell(int cell_x, int cell_y, double tolerance) const {
  const int x = cell_x * kSpacing + kSpacing / 2;
  const int y = cell_y * kSpacing + kSpacing / 2;
  Eigen::Vector3d ray;
  if (!unproject(camera_, Eigen::Vector2d(x, y), ray)) return false;
  const auto weights = stencil::lagrangeWeights<kNodes>(kSpacing / 2);
  double x_over_z = 0.0;
  double y_over_z = 0.0;
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const Node& at =
          node(cell_x + kMargin + i - (kNodes / 2 - 1), cell_y + kMargin + j - (kNodes / 2 - 1));
      const double weight =
          weights[static_cast<std::size_t>(i)] * weights[static_cast<std::size_t>(j)];
      x_over_z += weight * at.x;
      y_over_z += weight * at.y;
    }
  const double allowed = tolerance * ray.squaredNorm();
  return std::abs(x_over_z - ray.x()) <= allowed && std::abs(y_over_z - ray.y()) <= allowed;
}

void RayGrid::unprojectRun(int y, int x_begin, int x_end, double* x_over_z, double* y_over_z,
                           std::uint8_t* valid) const {
  for (int x = x_begin; x < x_end; ++x) {
    Eigen::Vector3d ray;
    const bool ok = unproject(camera_, Eigen::Vector2d(x, y), ray);
    x_over_z[x - x_begin] = ok ? ray.x() : 0.0;
    y_over_z[x - x_begin] = ok ? ray.y() : 0.0;
    valid[x - x_begin] = ok ? 1 : 0;
  }
}

template <int kNodes>
void RayGrid::interpolateRow(int y, int x_begin, int x_end, double* x_over_z, double* y_over_z,
                             std::uint8_t* valid) const {
  std::fill_n(valid, x_end - x_begin, std::uint8_t{1});
  const int cell_y = y / kSpacing;
  const auto weights = stencil::lagrangeWeights<kNodes>(y % kSpacing);
  const Node* first_node = &node(0, cell_y + kMargin - (kNodes / 2 - 1));
  const std::uint8_t* exact =
      &cell_exact_[static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(cells_x_)];
  // Columns of nodes, interpolated down to this row; a window that slides along the cells.
  std::array<double, kNodes> column_x{};
  std::array<double, kNodes> column_y{};
  const int first_cell = x_begin / kSpacing;
  const int last_cell = (x_end - 1) / kSpacing;
  const int first_column = first_cell + kMargin - (kNodes / 2 - 1);
  const int last_column = last_cell + kMargin + kNodes / 2;
  for (int column = first_column; column <= last_column; ++column) {
    for (std::size_t k = 0; k + 1 < kNodes; ++k) {
      column_x[k] = column_x[k + 1];
      column_y[k] = column_y[k + 1];
    }
    double sum_x = 0.0;
    double sum_y = 0.0;
    for (int j = 0; j < kNodes; ++j) {
      const Node& at = first_node[column + j * nodes_x_];
      sum_x += weights[static_cast<std::size_t>(j)] * at.x;
      sum_y += weights[static_cast<std::size_t>(j)] * at.y;
    }
    column_x[kNodes - 1] = sum_x;
    column_y[kNodes - 1] = sum_y;
    const int cell = column - kMargin - kNodes / 2;
    if (cell < first_cell) continue;

    const int begin = std::max(cell * kSpacing, x_begin);
    const int end = std::min((cell + 1) * kSpacing, x_end);
    if (exact[cell] != 0) {
      unprojectRun(y, begin, end, x_over_z + (begin - x_begin), y_over_z + (begin - x_begin),
                   valid + (begin - x_begin));
      continue;
    }
    const int skip = begin - cell * kSpacing;
    stencil::interpolateCell<kNodes>(column_x, skip, end - begin, x_over_z + (begin - x_begin));
    stencil::interpolateCell<kNodes>(column_y, skip, end - begin, y_over_z + (begin - x_begin));
  }
}

void RayGrid::row(int y, int x_begin, int count, double* x_over_z, double* y_over_z,
                  std::uint8_t* valid) const {
  if (count <= 0) return;
  if (camera_.model == CameraModel::kPinhole) {
    const double inverse_fx = 1.0 / camera_.fx;
    const double y_value = (y - camera_.cy) / camera_.fy;
    for (int i = 0; i < count; ++i) x_over_z[i] = (x_begin + i - camera_.cx) * inverse_fx;
    for (int i = 0; i < count; ++i) y_over_z[i] = y_value;
    for (int i = 0; i < count; ++i) valid[i] = 1;
  } else if (wide_stencil_) {
    interpolateRow<6>(y, x_begin, x_begin + count, x_over_z, y_over_z, valid);
  } else {
    interpolateRow<4>(y, x_begin, x_begin + count, x_over_z, y_over_z, valid);
  }
}

RayGrid::Range RayGrid::rowsWithin(double minimum, double maximum) const {
  if (camera_.model == CameraModel::kPinhole)
    return pinholeRange(minimum, maximum, camera_.fy, camera_.cy, camera_.height);
  Range range;
  for (int cell = 0; cell < cells_y_; ++cell) {
    const Hull& hull = row_hull_[static_cast<std::size_t>(cell)];
    if (hull.maximum < minimum || hull.minimum > maximum) continue;
    if (range.last < 0) range.first = cell * kSpacing;
    range.last = std::min((cell + 1) * kSpacing, camera_.height) - 1;
  }
  return range;
}

RayGrid::Range RayGrid::columnsWithin(double minimum, double maximum) const {
  if (camera_.model == CameraModel::kPinhole)
    return pinholeRange(minimum, maximum, camera_.fx, camera_.cx, camera_.width);
  Range range;
  for (int cell = 0; cell < cells_x_; ++cell) {
    const Hull& hull = column_hull_[static_cast<std::size_t>(cell)];
    if (hull.maximum < minimum || hull.minimum > maximum) continue;
    if (range.last < 0) range.first = cell * kSpacing;
    range.last = std::min((cell + 1) * kSpacing, camera_.width) - 1;
  }
  return range;
}

}  // namespace boresight
