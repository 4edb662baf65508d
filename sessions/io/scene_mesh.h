// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/io/mesh_file.h"

namespace boresight::sessions {

/// One part of a station as files describe it; the mesh is read when the scene is.
struct PartSource {
  std::filesystem::path mesh;
  std::string mesh_unit;  ///< "" where the format carries its unit
  Pose station_from_mesh;
  ScenePart part;
  std::optional<double> albedo;  ///< mean reflectance, 0 .. 1; 1 where not stated

  bool operator==(const PartSource&) const = default;
};

/// Several meshes in one station frame: what stands behind the core's MeshView.
struct SceneMesh {
  std::vector<Eigen::Vector3f> vertices_in_station_m;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<ScenePart> parts;
  std::vector<MeshInfo> infos;         ///< one per part
  std::vector<double> albedo_of_part;  ///< 0 .. 1

  MeshView view() const { return {vertices_in_station_m, faces, part_of_face, parts}; }
};

/// Appends a mesh as a new part. InputError beyond the limits of one mesh in all, or 65535 parts.
void addPart(SceneMesh& scene, const Mesh& mesh, const Pose& station_from_mesh,
             const ScenePart& part, double albedo = 1.0);

/// Throws to refuse a part, of whose files this is the SHA-256.
using PartCheck = std::function<void(std::size_t part, const std::string& sha256)>;

/// Reads all parts; `check`, if any, is called before a part is parsed. InputError, also when no
/// part is to be matched.
SceneMesh readScene(std::span<const PartSource> parts, const PartCheck& check = {});

/// Vertices of the faces of matched parts, each once: what projection errors are averaged over.
std::vector<Eigen::Vector3f> matchedVertices(const MeshView& mesh);

/// Why a station of this size can hardly be what the camera looks at, or "". It is 20 m or more
/// across and 100 times larger than its distance, or under 5 mm and 1/500 of it, as when its unit
/// is wrong. (The distance is the larger one of those to the station's origin and to the box.)
std::string scaleConcern(const BoundingBox& bounds_in_station, const Pose& camera_from_station);

/// InputError naming the first part's file when there is a scaleConcern.
void requirePlausibleScale(const SceneMesh& scene, const Pose& camera_from_station);

}  // namespace boresight::sessions
