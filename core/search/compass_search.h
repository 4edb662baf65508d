// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/base/fixed_list.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/render/edge_render.h"
#include "core/search/slide_sums.h"

namespace boresight {

/// Moves a pose of a coarse grid to where its outline lies nearest to the image's edges: compass
/// search (Kolda, Lewis and Torczon 2003) over turns about the object's middle, slides and depth,
/// with steps that are halved. The places of the outline come from one render; they are 3D points
/// whose edge directions turn with the pose.
class CompassSearch {
 public:
  /// Takes evenly spaced places of a render's outline; of all edges where the outline is too short.
  /// False when there are none.
  [[nodiscard]] bool takePlaces(const MeshView& mesh, const EdgeRender& render);
  /// Descends from the pose that was rendered. `middle_in_station_m` is the object's. Returns the
  /// mean distance of the places, px.
  double descend(const SlideSums& maps, const Eigen::Vector3d& middle_in_station_m,
                 Pose& view_from_station) const;

 private:
  struct Place {
    Eigen::Vector3d point_in_station_m;
    Eigen::Vector2d normal;
  };
  /// A pose, and the turn about the view's axis since the render.
  struct State {
    Pose view_from_station;
    double roll_rad = 0.0;
  };
  int sumAt(const SlideSums& maps, const State& state) const;

  Camera camera_;
  FixedList<Place, SlideSums::kMaxPlaces> places_;
};

/// Whether the pixel belongs to an outline.
inline bool isOutline(const EdgePixel& pixel) {
  return (pixel.kind & (kEdgeBorder | kEdgeOccluding)) != 0;
}

/// Calls take(pixel) for at most SlideSums::kMaxPlaces evenly spaced pixels of a render's outline;
/// of all edges where the outline is too short.
template <class Take>
void takeEvenly(const EdgeRender& render, Take&& take) {
  std::int64_t available = 0;
  for (const EdgePixel& pixel : render.eachPixel()) available += isOutline(pixel) ? 1 : 0;
  const bool all = available < SlideSums::kMaxPlaces / 2;
  if (all) available = render.pixel_count;
  const std::int64_t wanted = available < SlideSums::kMaxPlaces ? available : SlideSums::kMaxPlaces;
  std::int64_t place = 0;
  for (const EdgePixel& pixel : render.eachPixel()) {
    if (!all && !isOutline(pixel)) continue;
    const bool taken = place * wanted / available != (place + 1) * wanted / available;
    ++place;
    if (taken) take(pixel);
  }
}

}  // namespace boresight
