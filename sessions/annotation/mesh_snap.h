// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/annotation/annotations.h"
#include "sessions/trace/surface_point.h"

namespace boresight::sessions {

/// A circle of the mesh: a closed loop of salient edges whose corners lie on a circle.
struct MeshCircle {
  Eigen::Vector3d centre_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_station = Eigen::Vector3d::UnitZ();
  double radius_m = 0.0;
  std::vector<std::int32_t> vertices;
};

enum class MeshSnapKind { kVertex, kEdge, kCircle };

/// A feature of the mesh that an annotation may snap to.
struct MeshSnap {
  MeshSnapKind kind = MeshSnapKind::kVertex;
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< where the pose projects it
  double distance_px = 0.0;                         ///< from the queried position
  std::optional<ModelEdge> edge;                    ///< the edge, of a kEdge
  double radius_m = 0.0;                            ///< of a kCircle
};

/// Features of a mesh that an annotator may pick: corners where salient edges meet, salient edges
/// (borders, and folds beyond the part's normal threshold), and the centres of circles. Works on
/// the geometry alone: no window, no pixels, exact at any magnification.
class MeshSnapper {
 public:
  /// `mesh` must outlive it. InputError for a mesh that the core rejects.
  explicit MeshSnapper(const MeshView& mesh);

  const MeshView& mesh() const { return mesh_; }
  const std::vector<ModelEdge>& edges() const { return edges_; }
  const std::vector<MeshCircle>& circles() const { return circles_; }

  /// The nearest visible feature of each kind within the radius of a pixel: vertex, edge, circle.
  std::vector<MeshSnap> near(const Camera& camera, const Pose& camera_from_station,
                             const Eigen::Vector2d& pixel, double radius_px) const;

  /// Kind of feature at a point of the station, within 10 micrometres: a corner of salient edges, a
  /// circle's centre, or on an edge; empty on a plain surface.
  std::optional<MeshSnapKind> kindAt(const Eigen::Vector3d& point_in_station_m) const;

  /// The surface point seen at a pixel; empty outside the station.
  std::optional<Eigen::Vector3d> surfaceAt(const Camera& camera, const Pose& camera_from_station,
                                           const Eigen::Vector2d& pixel) const;

  /// Whether no face hides a point from an eye, both in the station frame. A point up to 1e-4 of
  /// the mesh's diagonal below a face is not hidden: parts are not modelled to touch exactly.
  bool seenFrom(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& place_m) const;

 private:
  using Ends = std::array<std::int32_t, 2>;

  Eigen::Vector3d vertex(std::int32_t index) const;
  void collectEdges();
  void collectCircles();
  void addLoop(const std::vector<std::int32_t>& loop);

  MeshView mesh_;
  std::optional<FaceTree> faces_;
  std::vector<Ends> ends_;  ///< of `edges_`
  std::vector<ModelEdge> edges_;
  std::vector<std::int32_t> corners_;  ///< vertices of salient edges
  std::vector<MeshCircle> circles_;
};

}  // namespace boresight::sessions
