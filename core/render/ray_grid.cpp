// SPDX-License-Identifier: Apache-2.0
#include "core/render/ray_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/nth.h"
#include "core/render/camera_scene.h"
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

/// Rays of a pixel and of the eight around it, some pixels away.
struct Patch {
  Eigen::Vector3d ray[9];
  Eigen::Vector3d& at(int dx, int dy) { return ray[3 * dy + dx + 4]; }
  const Eigen::Vector3d& at(int dx, int dy) const { return ray[3 * dy + dx + 4]; }
};

bool unprojectPatch(const Camera& camera, const Eigen::Vector2d& middle, int step_px,
                    Patch& patch) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (!unproject(camera, middle + step_px * Eigen::Vector2d(dx, dy), patch.at(dx, dy)))
        return false;
  return true;
}

/// First and second differences of a patch at its middle, per step.
struct Differences {
  Eigen::Vector3d x, y, xx, xy, yy;
  explicit Differences(const Patch& patch) {
    const Eigen::Vector3d& middle = patch.at(0, 0);
    x = 0.5 * (patch.at(1, 0) - patch.at(-1, 0));
    y = 0.5 * (patch.at(0, 1) - patch.at(0, -1));
    xx = patch.at(-1, 0) - 2.0 * middle + patch.at(1, 0);
    yy = patch.at(0, -1) - 2.0 * middle + patch.at(0, 1);
    xy = 0.25 * (patch.at(1, 1) - patch.at(-1, 1) - patch.at(1, -1) + patch.at(-1, -1));
  }
};

/// Largest second derivative of (x/z, y/z) along an image axis.
double rayBend(const Patch& patch) {
  const Differences by(patch);
  return std::max(by.xx.cwiseAbs().maxCoeff(), by.yy.cwiseAbs().maxCoeff());
}

/// Bound on the curvature of the images of straight lines. With d(p) the unit ray of pixel p, a
/// line with the image p(s) lies in a plane of normal n through the pupil: n . d(p(s)) = 0. Twice
/// differentiated, the curvature in the direction t is -det(d, D t, H[t, t]) / det(d, Dx, Dy), D
/// and H being the derivatives of d: a cubic form in t. Unit rays stay smooth up to 90 deg off the
/// axis and beyond, where (x/z, y/z) has a pole.
double lineBend(Patch patch) {
  for (Eigen::Vector3d& ray : patch.ray) ray /= std::sqrt(dotProduct(ray, ray));
  const Differences by(patch);
  const Eigen::Vector3d a = crossProduct(patch.at(0, 0), by.x);
  const Eigen::Vector3d b = crossProduct(patch.at(0, 0), by.y);
  const double along_x = std::max(std::abs(dotProduct(a, by.xx)),
                                  std::abs(dotProduct(a, by.yy) + 2.0 * dotProduct(b, by.xy)));
  const double along_y = std::max(std::abs(dotProduct(b, by.yy)),
                                  std::abs(dotProduct(b, by.xx) + 2.0 * dotProduct(a, by.xy)));
  const double largest = std::sqrt(along_x * along_x + along_y * along_y);
  return largest / std::max(std::abs(dotProduct(a, by.y)), 1e-300);
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
  grid.row_hull_ = arena.allocate<Hull>(grid.cells_y_);
  grid.column_hull_ = arena.allocate<Hull>(grid.cells_x_);
  if (arena.countsOnly()) return Status::kOk;
  if (arena.exhausted()) return Status::kArenaTooSmall;

  grid.fillNodes();
  grid.measureBends();
  grid.fillHulls();
  // Four nodes are enough for a camera with little distortion, and cheaper at every pixel.
  if (!grid.chooseStencils()) {
    grid.wide_stencil_ = true;
    (void)grid.chooseStencils();  // cells that are still too coarse are unprojected pixel by pixel
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

/// Whether all nodes of a square have a ray.
bool RayGrid::nodesValid(int first_column, int first_row, int count) const {
  for (int row = first_row; row < first_row + count; ++row)
    for (int column = first_column; column < first_column + count; ++column)
      if (!nodeValid(column, row)) return false;
  return true;
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

/// Second differences over the image and one node beyond; a factor of two covers the variation
/// between nodes. At the border of the valid field smaller steps come nearer to it.
void RayGrid::measureBends() {
  double ray_bend = 0.0;
  double line_bend = 0.0;
  for (int row = kMargin - 1; row <= cells_y_ + kMargin; ++row) {
    for (int column = kMargin - 1; column <= cells_x_ + kMargin; ++column) {
      const bool valid = nodesValid(column - 1, row - 1, 3);
      smooth_ = smooth_ && valid;
      Patch patch;
      if (valid) {
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const Node& at = node(column + dx, row + dy);
            patch.at(dx, dy) = {at.x, at.y, 1.0};
          }
        ray_bend = std::max(ray_bend, rayBend(patch));
        line_bend = std::max(line_bend, lineBend(patch) / kSpacing);
      } else if (nodeValid(column, row)) {
        const Eigen::Vector2d pixel((column - kMargin) * kSpacing, (row - kMargin) * kSpacing);
        int step_px = kSpacing / 2;
        while (step_px > 0 && !unprojectPatch(camera_, pixel, step_px, patch)) step_px /= 2;
        if (step_px > 0) line_bend = std::max(line_bend, lineBend(patch) / step_px);
      }
    }
  }
  ray_bend_per_px2_ = 2.0 * ray_bend / (kSpacing * kSpacing);
  line_bend_per_px_ = std::min(2.0 * line_bend, 1e6);
}

/// A row (column) of cells lies within the hull of the nodes on its two sides and the next ones.
/// Cells at which one of those has no ray are unprojected pixel by pixel when they are drawn, and
/// here: rays at the border of the valid field may be arbitrarily far from the next node's.
void RayGrid::fillHulls() {
  const auto clear = [](Hull& hull) { hull = {kEverything, -kEverything}; };
  std::for_each(row_hull_.begin(), row_hull_.end(), clear);
  std::for_each(column_hull_.begin(), column_hull_.end(), clear);
  const auto include = [](Hull& hull, double value) {
    hull.minimum = std::min(hull.minimum, value);
    hull.maximum = std::max(hull.maximum, value);
  };
  for (int cell_y = 0; cell_y < cells_y_; ++cell_y) {
    for (int cell_x = 0; cell_x < cells_x_; ++cell_x) {
      Hull& of_row = nth(row_hull_, cell_y);
      Hull& of_column = nth(column_hull_, cell_x);
      const int first_column = cell_x + kMargin - 1;
      const int first_row = cell_y + kMargin - 1;
      const bool valid = nodesValid(first_column, first_row, 4);
      for (int i = 0; valid && i < 16; ++i) {
        const Node& at = node(first_column + i % 4, first_row + i / 4);
        include(of_row, at.y);
        include(of_column, at.x);
      }
      for (int i = 0; !valid && i < kSpacing * kSpacing; ++i) {
        const int x = cell_x * kSpacing + i % kSpacing;
        const int y = cell_y * kSpacing + i / kSpacing;
        Eigen::Vector3d ray;
        if (x >= camera_.width || y >= camera_.height) continue;
        if (!unproject(camera_, Eigen::Vector2d(x, y), ray)) continue;
        include(of_row, ray.y());
        include(of_column, ray.x());
      }
    }
  }
}

/// Marks the cells that the present stencil cannot interpolate; true when there are none but those
/// without rays at their nodes.
bool RayGrid::chooseStencils() {
  bool enough = true;
  const int before = wide_stencil_ ? 2 : 1;
  for (int cell_y = 0; cell_y < cells_y_; ++cell_y) {
    for (int cell_x = 0; cell_x < cells_x_; ++cell_x) {
      bool exact =
          !nodesValid(cell_x + kMargin - before, cell_y + kMargin - before, 2 * before + 2);
      if (!exact) {
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
      const double weight = nth(weights, i) * nth(weights, j);
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
      sum_x += nth(weights, j) * at.x;
      sum_y += nth(weights, j) * at.y;
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

/// Pixels of the cells, along an axis of `size` pixels, whose hulls meet [minimum, maximum].
RayGrid::Range RayGrid::rangeWithin(std::span<const Hull> hulls, int size, double minimum,
                                    double maximum) {
  Range range;
  for (int cell = 0; cell < static_cast<int>(hulls.size()); ++cell) {
    const Hull& hull = nth(hulls, cell);
    if (hull.maximum < minimum || hull.minimum > maximum) continue;
    if (range.last < 0) range.first = cell * kSpacing;
    range.last = std::min((cell + 1) * kSpacing, size) - 1;
  }
  return range;
}

RayGrid::Range RayGrid::rowsWithin(double minimum, double maximum) const {
  if (camera_.model == CameraModel::kPinhole)
    return pinholeRange(minimum, maximum, camera_.fy, camera_.cy, camera_.height);
  return rangeWithin(row_hull_, camera_.height, minimum, maximum);
}

RayGrid::Range RayGrid::columnsWithin(double minimum, double maximum) const {
  if (camera_.model == CameraModel::kPinhole)
    return pinholeRange(minimum, maximum, camera_.fx, camera_.cx, camera_.width);
  return rangeWithin(column_hull_, camera_.width, minimum, maximum);
}

}  // namespace boresight
