// SPDX-License-Identifier: Apache-2.0
#include "core/search/facing_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kFractionBits = 8;  ///< of the weights of a block's outer pixels
/// Objects smaller than this are magnified, at most by the factor. Edges some pixels around a place
/// are otherwise those of the object itself, and explain its evidence away.
constexpr double kLeastSpan_px = 130.0;
constexpr double kMostMagnification = 2.0;
/// Rays farther off the view's axis than this (87 deg) are outside the view.
constexpr double kLeastZ = 0.05;

/// The tangents (x/z, y/z) of a ray.
Eigen::Vector2d tangentOf(const Eigen::Vector3d& ray) {
  return {ray.x() / ray.z(), ray.y() / ray.z()};
}

/// Bounds of the matched parts in the view.
Eigen::AlignedBox2d boxOfScene(const MeshView& mesh, const PoseMatrix& view_from_station) {
  Eigen::AlignedBox2d box;
  // All vertices below are included: a mesh usually counts them in the order of their first use.
  std::int32_t included_below = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (!mesh.partOf(i).match) continue;
    const Face face = mesh.faces[i];
    for (const std::int32_t vertex : face.vertex) {
      if (vertex < included_below) continue;
      if (vertex == included_below) ++included_below;
      const Eigen::Vector3d point_m = view_from_station * mesh.vertex(vertex);
      if (point_m.z() > 0.0) box.extend(tangentOf(point_m));
    }
  }
  return box;
}

/// Bounding box of the real image in the view, from a grid of its pixels.
Eigen::AlignedBox2d boxOfImage(const SearchProblem& problem, const Pose& view_from_camera) {
  constexpr int kSteps = 8;
  Eigen::AlignedBox2d box;
  const Camera& camera = problem.camera;
  const Eigen::Matrix3d rotation = view_from_camera.matrix();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d pixel(i * (camera.width - 1.0) / kSteps,
                                  j * (camera.height - 1.0) / kSteps);
      Eigen::Vector3d ray;
      if (!unproject(camera, pixel, ray)) continue;
      const Eigen::Vector3d turned = rotation * problem.seenAlong(ray);
      if (turned.z() > kLeastZ) box.extend(tangentOf(turned));
    }
  }
  return box;
}

/// The channels of an image, interleaved.
struct Channels {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride = 0;

  template <int kCount>
  const std::uint8_t* at(int x, int y) const {
    return data + stride * y + std::ptrdiff_t{kCount} * x;
  }
};

template <int kCount>
using Sums = std::array<std::int64_t, static_cast<std::size_t>(kCount)>;

/// A square block of the image from a place on, bilinear: pixels of its first and last rows and
/// columns count by the share that the block covers.
struct Block {
  int x, y;                  ///< its first pixel
  std::int32_t right, down;  ///< weights of the last column and row, in units of 2^-kFractionBits
  int size;                  ///< px; it touches one column and one row more

  Block(double x_px, double y_px, int size_px)
      : x(static_cast<int>(x_px)), y(static_cast<int>(y_px)), size(size_px) {
    right = static_cast<std::int32_t>((x_px - x) * (1 << kFractionBits));
    down = static_cast<std::int32_t>((y_px - y) * (1 << kFractionBits));
  }
  std::int32_t left() const { return (1 << kFractionBits) - right; }
  std::int32_t up() const { return (1 << kFractionBits) - down; }
};

/// Sums over a block, in units of 2^-16.
template <int kCount>
Sums<kCount> blockSums(const Channels& image, const Block& block) {
  Sums<kCount> sums{};
  for (int row = 0; row <= block.size; ++row) {
    const std::uint8_t* pixel = image.at<kCount>(block.x, block.y + row);
    std::array<std::int32_t, static_cast<std::size_t>(kCount)> inner{};
    for (int i = 1; i < block.size; ++i)
      for (int k = 0; k < kCount; ++k) nth(inner, k) += pixel[i * kCount + k];
    const std::int32_t weight = row == 0            ? block.up()
                                : row == block.size ? block.down
                                                    : (1 << kFractionBits);
    for (int k = 0; k < kCount; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::int64_t along = block.left() * pixel[k] +
                                 (std::int64_t{inner[at]} << kFractionBits) +
                                 block.right * pixel[block.size * kCount + k];
      sums[at] += along * weight;
    }
  }
  return sums;
}

/// A value for each of some neighbouring columns: as many as fit two vectors of 16 bytes.
constexpr int kColumns = 16;
using Columns = std::array<std::int16_t, kColumns>;
/// Rows whose sums fit.
constexpr int kMostRows = 128;

/// Sums of the columns over rows. This function and the next three stay vector code only when they
/// are not inlined.
[[gnu::noinline]] Columns columnSums(const std::uint8_t* row, std::ptrdiff_t stride, int rows) {
  std::uint16_t sum[kColumns] = {};
  for (int i = 0; i < rows; ++i, row += stride)
    for (int k = 0; k < kColumns; ++k) sum[k] = static_cast<std::uint16_t>(sum[k] + row[k]);
  Columns sums;
  for (int k = 0; k < kColumns; ++k) nth(sums, k) = static_cast<std::int16_t>(sum[k]);
  return sums;
}

/// The weight of whole columns, and none: the weights of n whole columns and none after them begin
/// kColumns - n before the middle.
constexpr std::array<std::int16_t, 2 * kColumns> kWhole = [] {
  std::array<std::int16_t, 2 * kColumns> weights{};
  for (std::size_t k = 0; k < kColumns; ++k) weights[k] = 1 << kFractionBits;
  return weights;
}();

/// Sum of the products of all columns of a row.
[[gnu::noinline]] std::int32_t weighRow(const Columns& weights, const std::uint8_t* row) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < kColumns; ++k) sum += weights[k] * static_cast<std::int16_t>(row[k]);
  return sum;
}

/// Sum of the products of all columns.
[[gnu::noinline]] std::int32_t dotProduct(const Columns& a, const Columns& b) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < kColumns; ++k) sum += a[k] * b[k];
  return sum;
}

/// Weights of a block's columns from `begin` on, of which columns first .. end - 1 count.
[[gnu::noinline]] Columns columnWeights(const Block& block, int begin, int first, int end) {
  static constexpr Columns kPlace = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const auto from = static_cast<std::int16_t>(first - begin);
  const auto to = static_cast<std::int16_t>(end - begin);
  Columns weights;
  if (from == 0) {
    std::copy_n(kWhole.begin() + (kColumns - to), kColumns, weights.begin());
  } else {
    for (std::size_t k = 0; k < kColumns; ++k)
      weights[k] = kPlace[k] >= from && kPlace[k] < to ? 1 << kFractionBits : 0;
  }
  const auto weightOf = [&](int column) -> std::int16_t& { return nth(weights, column - begin); };
  if (first == 0) weightOf(0) = static_cast<std::int16_t>(block.left());
  if (end == block.size + 1) weightOf(block.size) = static_cast<std::int16_t>(block.right);
  return weights;
}

/// blockSums() of a gray image of at least kColumns columns, for blocks of less than kMostRows:
/// whole columns are summed first, many at a time.
std::int64_t blockSumByColumns(const Channels& image, int width, const Block& block) {
  std::int64_t sum = 0;
  for (int first = 0; first <= block.size; first += kColumns) {
    const int end = std::min(first + kColumns, block.size + 1);
    const int begin = std::min(first, width - kColumns - block.x);  // read within the row
    const Columns weights = columnWeights(block, begin, first, end);
    const std::uint8_t* const top = image.at<1>(block.x + begin, block.y);
    const std::uint8_t* const bottom = top + image.stride * block.size;
    const auto alongRow = [&](const std::uint8_t* row) {
      return std::int64_t{weighRow(weights, row)};
    };
    const Columns inner = columnSums(top + image.stride, image.stride, block.size - 1);
    sum += (std::int64_t{dotProduct(weights, inner)} << kFractionBits) +
           block.up() * alongRow(top) + block.down * alongRow(bottom);
  }
  return sum;
}

/// Whether blockSumByColumns() applies to an image.
bool sumsByColumns(const SearchProblem& problem, int block) {
  return problem.image.width >= kColumns && block < kMostRows;
}

/// Places of a row of the view in the real image. The way between them is smooth: between knots
/// that are projected it is linear.
class ProjectedRow {
 public:
  ProjectedRow(const SearchProblem& problem, const FacingView& view, int y)
      : problem_(problem),
        view_(view),
        camera_from_view_(view.view_from_camera.matrix().transpose()),
        y_(y) {
    ahead_.known = project(0, ahead_.pixel);
  }

  /// Of the columns in their order; false outside the real camera's field of view.
  bool next(int x, Eigen::Vector2d& pixel) {
    if (x % kSpacing_px == 0) advance(x);
    if (!between_) return project(x, pixel);
    pixel = behind_.pixel + (x % kSpacing_px) * step_;
    return true;
  }

 private:
  static constexpr int kSpacing_px = 8;
  struct Knot {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    bool known = false;
  };

  void advance(int x) {
    behind_ = ahead_;
    ahead_.known = project(x + kSpacing_px, ahead_.pixel);
    between_ = behind_.known && ahead_.known;
    step_ = (ahead_.pixel - behind_.pixel) * (1.0 / kSpacing_px);
  }

  bool project(int x, Eigen::Vector2d& pixel) const {
    const Camera& camera = view_.camera;
    const Eigen::Vector3d ray =
        camera_from_view_ *
        Eigen::Vector3d((x - camera.cx) / camera.fx, (y_ - camera.cy) / camera.fy, 1.0);
    return projectDirection(problem_.camera, problem_.seenAlong(ray), pixel);
  }

  const SearchProblem& problem_;
  const FacingView& view_;
  Eigen::Matrix3d camera_from_view_;
  int y_;
  Knot behind_, ahead_;
  Eigen::Vector2d step_ = Eigen::Vector2d::Zero();
  bool between_ = false;
};

template <int kCount>
void fillRows(const SearchProblem& problem, const Channels& image, const FacingView& view,
              int first, int end, SmallImage& output) {
  const int block = std::max(1, static_cast<int>(1.0 / view.pixels_per_px + 0.5));
  const double half = 0.5 * (block - 1);
  const std::size_t channel = output.seen.size();
  const bool by_columns = sumsByColumns(problem, block);
  for (int y = first; y < end; ++y) {
    ProjectedRow row(problem, view, y);
    for (int x = 0; x < output.width; ++x) {
      const auto at = static_cast<std::size_t>(y * output.width + x);
      for (int k = 0; k < kCount; ++k) output.value[static_cast<std::size_t>(k) * channel + at] = 0;
      output.seen[at] = 0;
      Eigen::Vector2d pixel;
      if (!row.next(x, pixel)) continue;
      const double left = pixel.x() - half;
      const double top = pixel.y() - half;
      if (!(left >= 0.0 && top >= 0.0 && left + block < problem.image.width &&
            top + block < problem.image.height))
        continue;
      const Block covered(left, top, block);
      Sums<kCount> sums;
      if (kCount == 1 && by_columns)
        sums[0] = blockSumByColumns(image, problem.image.width, covered);
      else
        sums = blockSums<kCount>(image, covered);
      for (int k = 0; k < kCount; ++k)
        output.value[static_cast<std::size_t>(k) * channel + at] =
            static_cast<std::uint8_t>((nth(sums, k) >> (2 * kFractionBits)) / (block * block));
      const bool ignored =
          problem.ignore != nullptr &&
          problem.ignore->get(static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
      output.seen[at] = ignored ? 0 : 1;
    }
  }
}

}  // namespace

Pose viewTowards(const Eigen::Vector3d& point_in_camera_m) {
  const Eigen::Vector3d ray = point_in_camera_m / std::sqrt(point_in_camera_m.squaredNorm());
  Pose view_from_camera;
  // Half way between the ray and z.
  view_from_camera.rotation = Eigen::Quaterniond(1.0 + ray.z(), ray.y(), -ray.x(), 0.0);
  view_from_camera.rotation.normalize();
  return view_from_camera;
}

bool faceScene(const SearchProblem& problem, const Pose& camera_from_station, const ViewSize& size,
               FacingView& view) {
  const Eigen::Vector3d middle_m = camera_from_station * problem.scene.centre();
  if (!(middle_m.z() > 0.0)) return false;
  view.view_from_camera = viewTowards(middle_m);
  const Eigen::AlignedBox2d seen =
      boxOfScene(problem.mesh, PoseMatrix(view.view_from_camera * camera_from_station))
          .intersection(boxOfImage(problem, view.view_from_camera));
  if (!(seen.sizes().minCoeff() > 0.0)) return false;
  const double span = std::max(seen.sizes().maxCoeff(), 2.0 * size.least_half);
  const Eigen::Vector2d half = seen.max().cwiseMax(-seen.min()).cwiseMax(size.least_half) +
                               Eigen::Vector2d(size.slide_x, size.slide_y);
  const double real_focal_px = std::abs(problem.camera.fx);
  const double finest_px =
      std::clamp(kLeastSpan_px / span, real_focal_px, kMostMagnification * real_focal_px);
  const double focal_px = std::min({size.span_px / span, finest_px,
                                    (0.5 * size.most_px - size.margin_px - 2.0) / half.maxCoeff()});
  if (!(focal_px > 0.0)) return false;
  view.span_px = focal_px * span;
  view.pixels_per_px = focal_px / real_focal_px;
  Camera& camera = view.camera;
  camera = Camera();
  camera.width =
      std::min(size.most_px, 2 * static_cast<int>(focal_px * half.x() + size.margin_px) + 3);
  camera.height =
      std::min(size.most_px, 2 * static_cast<int>(focal_px * half.y() + size.margin_px) + 3);
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  return prepareCamera(camera) == Status::kOk;
}

void fillViewRows(const SearchProblem& problem, const FacingView& view, int first, int end,
                  SmallImage& output) {
  output.width = view.camera.width;
  output.height = view.camera.height;
  if (problem.color.data != nullptr)
    fillRows<ColorView::kChannels>(problem, {problem.color.data, problem.color.stride}, view, first,
                                   end, output);
  else
    fillRows<1>(problem, {problem.image.data, problem.image.stride}, view, first, end, output);
}

}  // namespace boresight
