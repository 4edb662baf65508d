// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/arena.h"
#include "core/edges/directed_edges.h"
#include "core/render/edge_render.h"
#include "core/render/ray_grid.h"
#include "core/search/facing_view.h"

namespace boresight {

/// The directed edges of the image of a view, computed in bounded slices.
class ViewEdges {
 public:
  /// Takes memory from `arena` for images of up to `longest_px` along each side, and of up to
  /// `channels` channels. Returns the arena mark of the part that is used only until the edges are
  /// complete.
  [[nodiscard]] std::size_t create(int longest_px, int channels, Arena& arena);
  /// Turns the view to the scene at a pose; `problem` must outlive the steps. False: see faceScene.
  [[nodiscard]] bool begin(const SearchProblem& problem, const Pose& camera_from_station,
                           ViewSize size);
  /// One slice; true when the edges are complete.
  [[nodiscard]] bool step();

  /// The view.
  const FacingView& view() const { return view_; }
  /// The view's rays, for renders.
  const RayGrid& rays() const { return rays_; }
  /// The edges of its image.
  const DirectedEdges& edges() const { return edges_; }
  /// One slice of a render in the view. `rendering` is false before the first slice, and after the
  /// render is complete or has failed.
  Status render(EdgeRenderer& renderer, const Pose& view_from_station, EdgeRender& output,
                bool& rendering) const;
  /// Converts a station pose from the real camera to the view.
  Pose inView(const Pose& camera_from_station) const {
    return view_.view_from_camera * camera_from_station;
  }
  /// Converts a station pose from the view to the real camera.
  Pose inCamera(const Pose& view_from_station) const;

 private:
  const SearchProblem* problem_ = nullptr;
  FacingView view_;
  RayGrid rays_;
  SmallImage image_;
  DirectedEdgeDetector detector_;
  DirectedEdges edges_;
  int longest_px_ = 0;
  int row_ = 0;
};

}  // namespace boresight
