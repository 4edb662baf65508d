// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/edges/directed_edges.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/pnp/correspondence.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Moves a pose so that its render meets the directed edges of a small image: from each rendered
/// edge place along its normal to the nearest edge whose direction differs by at most one step.
/// Robust (Tukey), Gauss-Newton; the seed's uncertainty constrains directions that the edges do not
/// determine. For poses that are several pixels off, where the strongest gradient nearby
/// (EdgeRefinement) is often another edge. The places of one render, projected again at each pose,
/// serve several radii.
class OutlineRefinement {
 public:
  static constexpr int kMaxSamples = 1200;  ///< edge places used, at most

  /// Takes the samples' memory from `arena`.
  Status create(Arena& arena);
  /// Takes the edge places of a render.
  void takePlaces(const MeshView& mesh, const EdgeRender& render);
  /// The rounds of one radius. `view_from_station` is the pose rendered, or a refinement of it; the
  /// prior is in the view's frame. False, with the pose unchanged, when too few edges are found.
  [[nodiscard]] bool refine(const DirectedEdges& edges, const PosePrior& prior, double radius_px,
                            Pose& view_from_station) const;

 private:
  struct Sample {
    Eigen::Vector3d point_in_station_m;
    Eigen::Vector2d normal;
    std::uint8_t direction = 0;
  };

  Camera camera_;  ///< of the render
  std::span<Sample> samples_;
  int count_ = 0;
};

}  // namespace boresight
