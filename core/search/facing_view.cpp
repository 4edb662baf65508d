// SPDX-License-Identifier: Apache-2.0
#include "core/search/facing_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace boresight {
namespace {

constexpr int kWeightBits = 8;
/// Objects smaller than this are magnified, at most by the factor. Edges some pixels around a place
/// are otherwise those of the object itself, and explain its evidence away.
constexpr double kLeastSpan_px = 130.0;
constexpr double kMostMagnification = 2.0;
/// Rays farther off the view's axis than this (87 deg) are outside the view.
constexpr double kLeastZ = 0.05;

/// A box of tangents (x/z, y/z).
struct TangentBox {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d most = Eigen::Vector2d::Constant(-1e9);

  void extend(const Eigen::Vector3d& ray) {
    const Eigen::Vector2d tangent(ray.x() / ray.z(), ray.y() / ray.z());
    least = least.cwiseMin(tangent);
    most = most.cwiseMax(tangent);
  }
};

/// Bounds of the matched parts in the view.
TangentBox boxOfScene(const MeshView& mesh, const Pose& view_from_station) {
  TangentBox box;
  const Eigen::Matrix3d rotation = view_from_station.matrix();
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (!mesh.parts[mesh.part_of_face[i]].match) continue;
    for (const std::int32_t vertex : mesh.faces[i].vertex) {
      const Eigen::Vector3d point_m =
          rotation * mesh.vertices_in_station_m[static_cast<std::size_t>(vertex)].cast<double>() +
          view_from_station.translation_m;
      if (point_m.z() > 0.0) box.extend(point_m);
    }
  }
  return box;
}

/// Bounding box of the real image in the view, from a grid of its pixels.
TangentBox boxOfImage(const Camera& camera, const Pose& view_from_camera) {
  constexpr int kSteps = 8;
  TangentBox box;
  const Eigen::Matrix3d rotation = view_from_camera.matrix();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d pixel(i * (camera.width - 1.0) / kSteps,
                                  j * (camera.height - 1.0) / kSteps);
      Eigen::Vector3d ray;
      if (!unproject(camera, pixel, ray)) continue;
      const Eigen::Vector3d turned = rotation * ray;
      if (turned.z() > kLeastZ) box.extend(turned);
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

/// Sum of bytes, eight at a time.
std::int32_t sumOf(const std::uint8_t* bytes, int count) {
  constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffU;
  constexpr int kWord = sizeof(std::uint64_t);
  constexpr int kMostBytes = 128 * kWord;  // that four lanes of 16 bits hold
  std::int32_t sum = 0;
  while (count >= kWord) {
    const int words = std::min(count, kMostBytes) / kWord;
    count -= words * kWord;
    std::uint64_t lanes = 0;
    for (int i = 0; i < words; ++i, bytes += kWord) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, kWord);
      lanes += (word & kEven) + ((word >> 8) & kEven);
    }
    for (; lanes != 0; lanes >>= 16) sum += static_cast<std::int32_t>(lanes & 0xffff);
  }
  for (int i = 0; i < count; ++i) sum += bytes[i];
  return sum;
}

template <int kCount>
using Sums = std::array<std::int64_t, static_cast<std::size_t>(kCount)>;

/// Sums over block x block pixels from a place on, bilinear, in units of 2^-16.
template <int kCount>
Sums<kCount> blockSums(const Channels& image, double x_px, double y_px, int block) {
  const int x = static_cast<int>(x_px);
  const int y = static_cast<int>(y_px);
  const auto right = static_cast<std::int32_t>((x_px - x) * (1 << kWeightBits));
  const auto down = static_cast<std::int32_t>((y_px - y) * (1 << kWeightBits));
  const std::int32_t left = (1 << kWeightBits) - right;
  const std::int32_t up = (1 << kWeightBits) - down;
  Sums<kCount> sums{};
  for (int row = 0; row <= block; ++row) {
    const std::uint8_t* pixel = image.at<kCount>(x, y + row);
    std::array<std::int32_t, static_cast<std::size_t>(kCount)> inner{};
    if constexpr (kCount == 1) {
      inner[0] = sumOf(pixel + 1, block - 1);
    } else {
      for (int i = 1; i < block; ++i)
        for (int k = 0; k < kCount; ++k)
          inner[static_cast<std::size_t>(k)] += pixel[i * kCount + k];
    }
    const std::int32_t weight = row == 0 ? up : row == block ? down : (1 << kWeightBits);
    for (int k = 0; k < kCount; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::int64_t along = left * pixel[k] + (std::int64_t{inner[at]} << kWeightBits) +
                                 right * pixel[block * kCount + k];
      sums[at] += along * weight;
    }
  }
  return sums;
}

template <int kCount>
void fillRows(const SearchProblem& problem, const Channels& image, const FacingView& view,
              int first, int end, SmallImage& output) {
  const Eigen::Matrix3d camera_from_view = view.view_from_camera.matrix().transpose();
  const int block = std::max(1, static_cast<int>(1.0 / view.pixels_per_px + 0.5));
  const double half = 0.5 * (block - 1);
  const std::size_t channel = output.seen.size();
  for (int y = first; y < end; ++y) {
    for (int x = 0; x < output.width; ++x) {
      const auto at = static_cast<std::size_t>(y * output.width + x);
      for (int k = 0; k < kCount; ++k) output.value[static_cast<std::size_t>(k) * channel + at] = 0;
      output.seen[at] = 0;
      const Eigen::Vector3d ray =
          camera_from_view * Eigen::Vector3d((x - view.camera.cx) / view.camera.fx,
                                             (y - view.camera.cy) / view.camera.fy, 1.0);
      Eigen::Vector2d pixel;
      if (!projectDirection(problem.camera, ray, pixel)) continue;
      const double left = pixel.x() - half;
      const double top = pixel.y() - half;
      if (!(left >= 0.0 && top >= 0.0 && left + block < problem.image.width &&
            top + block < problem.image.height))
        continue;
      const Sums<kCount> sums = blockSums<kCount>(image, left, top, block);
      for (int k = 0; k < kCount; ++k)
        output.value[static_cast<std::size_t>(k) * channel + at] = static_cast<std::uint8_t>(
            (sums[static_cast<std::size_t>(k)] >> (2 * kWeightBits)) / (block * block));
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
  TangentBox seen = boxOfScene(problem.mesh, view.view_from_camera * camera_from_station);
  const TangentBox image = boxOfImage(problem.camera, view.view_from_camera);
  seen.least = seen.least.cwiseMax(image.least);
  seen.most = seen.most.cwiseMin(image.most);
  if (!((seen.most - seen.least).minCoeff() > 0.0)) return false;
  const double span = std::max((seen.most - seen.least).maxCoeff(), 2.0 * size.least_half);
  const Eigen::Vector2d half = seen.most.cwiseMax(-seen.least).cwiseMax(size.least_half) +
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
