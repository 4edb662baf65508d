// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"

namespace boresight::sessions {

/// A point of the station and where somebody saw it in the image.
struct PointPair {
  std::string id;  ///< unique in its file
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;  ///< standard deviation per axis
  bool enabled = true;    ///< takes part in solving
  std::string comment;

  bool operator==(const PointPair&) const = default;
};

/// A pair inside another file.
PointPair readPoint(const JsonReader& json);
nlohmann::ordered_json toJson(const PointPair& point);

/// Reads points.json (`boresight-points`, version 1). InputError.
std::vector<PointPair> readPoints(const std::filesystem::path& file);

/// Writes points.json; reading it back gives the same values. OutputError.
void writePoints(const std::filesystem::path& file, const std::vector<PointPair>& points);

}  // namespace boresight::sessions
