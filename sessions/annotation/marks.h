// SPDX-License-Identifier: Apache-2.0
// What a person marked in one image: places in the image paired with places of the station.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace boresight::sessions {

/// A point of the station and where it was seen. One side may be missing: a pair half made.
struct PointPair {
  std::string id;  ///< unique among the marks of its image
  std::optional<Eigen::Vector3d> point_in_station_m;
  std::optional<Eigen::Vector2d> pixel;
  double sigma_px = 1.0;  ///< standard deviation per axis
  bool enabled = true;    ///< takes part in solving
  bool locked = false;    ///< may not be moved by accident
  std::string comment;

  bool complete() const { return point_in_station_m && pixel; }
  bool used() const { return enabled && complete(); }
  bool operator==(const PointPair&) const = default;
};

/// Two ends of a straight edge of the station.
struct ModelEdge {
  Eigen::Vector3d start_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end_in_station_m = Eigen::Vector3d::Zero();

  bool operator==(const ModelEdge&) const = default;
};

/// Two places in the image on one edge; they need not be its ends.
struct ImageLine {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< px
  Eigen::Vector2d end = Eigen::Vector2d::Zero();    ///< px

  bool operator==(const ImageLine&) const = default;
};

/// A straight edge of the station and where a piece of it was seen. Only distances across the edge
/// count. One side may be missing.
struct LinePair {
  std::string id;  ///< unique among the marks of its image, points included
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

/// The marks of one image, those that are off included.
struct Marks {
  std::vector<PointPair> points;
  std::vector<LinePair> lines;

  bool empty() const { return points.empty() && lines.empty(); }
  bool operator==(const Marks&) const = default;
};

/// "p1", "p2", ... (or with another letter): the first that no mark has.
std::string unusedId(const Marks& marks, char letter);

}  // namespace boresight::sessions
