// SPDX-License-Identifier: Apache-2.0
// Annotations of one image: image positions paired with points or edges of the station. Edits of
// annotations return changed copies.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Largest coordinate that a point of the station may have.
inline constexpr double kMaxCoordinate_m = 1e6;

/// A point of the station and its image position. One side is missing while the pair is incomplete.
struct PointPair {
  std::string id;  ///< unique among the annotations of its image
  std::optional<Eigen::Vector3d> point_in_station_m;
  std::optional<Eigen::Vector2d> pixel;
  double sigma_px = 1.0;  ///< standard deviation per axis
  bool enabled = true;    ///< takes part in solving
  bool locked = false;    ///< protected from being moved
  std::string comment;

  bool complete() const { return point_in_station_m && pixel; }
  bool used() const { return enabled && complete(); }
  bool operator==(const PointPair&) const = default;
};

/// Two ends of a straight edge of the station.
struct ModelEdge {
  Eigen::Vector3d start_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end_in_station_m = Eigen::Vector3d::Zero();

  /// The point at a share of the way from start (0) to end (1).
  Eigen::Vector3d at(double share) const {
    return (1.0 - share) * start_in_station_m + share * end_in_station_m;
  }
  bool operator==(const ModelEdge&) const = default;
};

/// Two image positions on one edge; they need not be its ends.
struct ImageLine {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< px
  Eigen::Vector2d end = Eigen::Vector2d::Zero();    ///< px

  bool operator==(const ImageLine&) const = default;
};

/// A straight edge of the station and the image position of a part of it. Only distances across the
/// edge count. One side may be missing.
struct LinePair {
  std::string id;  ///< unique among the annotations of its image, points included
  std::optional<ModelEdge> edge;
  std::optional<ImageLine> line;
  double sigma_px = 1.0;  ///< standard deviation of either end across the edge
  bool enabled = true;
  bool locked = false;
  std::string comment;

  bool complete() const { return edge && line; }
  bool used() const { return enabled && complete(); }
  bool operator==(const LinePair&) const = default;
};

/// The annotations of one image, including disabled ones.
struct Annotations {
  std::vector<PointPair> points;
  std::vector<LinePair> lines;

  bool empty() const { return points.empty() && lines.empty(); }
  bool operator==(const Annotations&) const = default;
};

/// Whether a point or line has this id.
bool hasAnnotation(const Annotations& annotations, const std::string& id);
/// The first of "p1", "p2", ... (with this letter) that no annotation has as its id.
std::string unusedId(const Annotations& annotations, char letter);

/// nullptr when no annotation has this id.
const PointPair* findPoint(const Annotations& annotations, const std::string& id);
const LinePair* findLine(const Annotations& annotations, const std::string& id);

/// A copy in which this annotation replaces the one with id `replaced`, or is appended.
Annotations withPair(Annotations annotations, const std::string& replaced, const PointPair& point);
Annotations withPair(Annotations annotations, const std::string& replaced, const LinePair& line);
/// A copy without the annotation of this id.
Annotations withoutAnnotation(Annotations annotations, const std::string& id);

/// A copy with a point, or one end (0 or 1) of a line, moved in the image. An annotation without an
/// image position stays unchanged.
Annotations withMoved(Annotations annotations, const std::string& id, int end,
                      const Eigen::Vector2d& to_px);

/// The annotations of one view of a rig. A single camera is a rig with one view. Several images of
/// a rig that did not move are views of it as well.
struct AnnotatedView {
  std::string name;  ///< for display
  Camera camera;     ///< after prepareCamera
  Pose camera_from_rig;
  Annotations annotations;

  bool operator==(const AnnotatedView&) const = default;
};

/// Kind of an annotation.
enum class AnnotationKind { kPoint, kLine };

/// An annotation of one of the views.
struct AnnotationAddress {
  std::size_t view = 0;
  AnnotationKind kind = AnnotationKind::kPoint;
  std::size_t index = 0;  ///< among the view's points or lines

  bool operator==(const AnnotationAddress&) const = default;
};

/// Every annotation that takes part in solving, view by view, points first.
std::vector<AnnotationAddress> usedAnnotations(std::span<const AnnotatedView> views);

const std::string& annotationId(std::span<const AnnotatedView> views, const AnnotationAddress& at);
double annotationSigma_px(std::span<const AnnotatedView> views, const AnnotationAddress& at);

}  // namespace boresight::sessions
