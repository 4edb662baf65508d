// SPDX-License-Identifier: Apache-2.0
#include "core/search/view_edges.h"

#include <algorithm>

namespace boresight {
namespace {

constexpr int kSliceRows = 32;
constexpr int kDetectedRows = 128;  ///< of one slice

}  // namespace

std::size_t ViewEdges::create(int longest_px, int channels, Arena& arena) {
  longest_px_ = longest_px;
  const auto pixels = static_cast<std::size_t>(longest_px) * static_cast<std::size_t>(longest_px);
  edges_.direction = arena.allocate<std::uint8_t>(pixels);
  const std::size_t mark = arena.mark();
  image_ = SmallImage::create(pixels, arena, channels);
  detector_.create(longest_px, arena);
  return mark;
}

bool ViewEdges::begin(const SearchProblem& problem, const Pose& camera_from_station,
                      ViewSize size) {
  problem_ = &problem;
  row_ = 0;
  size.most_px = std::min(size.most_px, longest_px_);
  if (!faceScene(problem, camera_from_station, size, view_)) return false;
  Arena none;  // the rays of a pinhole need no memory
  return RayGrid::create(view_.camera, none, rays_) == Status::kOk;
}

bool ViewEdges::step() {
  const int end = std::min(row_ + kSliceRows, view_.camera.height);
  if (row_ < end) {
    fillViewRows(*problem_, view_, row_, end, image_);
    row_ = end;
    if (row_ == view_.camera.height)
      detector_.begin(image_.width, image_.height, channelsOf(*problem_), edges_);
    return false;
  }
  return detector_.step(image_, kDetectedRows, edges_);
}

Status ViewEdges::render(EdgeRenderer& renderer, const Pose& view_from_station, EdgeRender& output,
                         bool& rendering) const {
  bool complete = false;
  const Status status =
      rendering ? renderer.stepWhole(complete)
                : renderer.begin(rays_, view_from_station, output, {}, view_.view_from_camera);
  rendering = status == Status::kOk && !complete;
  return status;
}

Pose ViewEdges::inCamera(const Pose& view_from_station) const {
  Pose camera_from_station = view_.view_from_camera.inverse() * view_from_station;
  camera_from_station.rotation.normalize();
  return camera_from_station;
}

}  // namespace boresight
