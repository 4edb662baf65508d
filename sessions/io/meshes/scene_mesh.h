// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/io/meshes/part_source.h"

namespace boresight::sessions {

/// The parts that are used, as the core's MeshView needs them: those fixed to the camera last.
struct SceneMesh {
  /// Of parts fixed to the camera: in the camera frame.
  std::vector<Eigen::Vector3f> vertices_in_station_m;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<ScenePart> parts;
  std::vector<MeshInfo> infos;         ///< one per part
  std::vector<double> albedo_of_part;  ///< 0 .. 1

  MeshView view() const { return {vertices_in_station_m, faces, part_of_face, parts}; }
};

/// The scene without the parts that are fixed to the camera, all in the station frame. Points into
/// `scene`.
MeshView stationView(const SceneMesh& scene);
/// The parts fixed to the camera alone, with vertices in the camera frame.
MeshView heldView(const SceneMesh& scene);

/// Appends a mesh as a new part; `frame_from_mesh` maps to the station frame or, for a part fixed
/// to the camera, to the camera frame; after such a part no other may follow. InputError when the
/// whole scene exceeds the limits of one mesh, or 65535 parts.
void addPart(SceneMesh& scene, const Mesh& mesh, const Pose& frame_from_mesh, const ScenePart& part,
             double albedo = 1.0);

/// Throws to reject a part, given its index in the list and the SHA-256 of its files.
using PartCheck = std::function<void(std::size_t part, const std::string& sha256)>;

/// Reads the parts that are used; `check`, if any, is called before a part is parsed. InputError,
/// also when no part is matched, or a frame is not joined.
SceneMesh readScene(std::span<const PartSource> parts, const FrameTree& frames = {},
                    const PartCheck& check = {});

/// Vertices of the faces of matched parts, each once: the points over which projection errors are
/// averaged.
std::vector<Eigen::Vector3f> matchedVertices(const MeshView& mesh);

/// Why a station of this size is implausible at this pose, or "": it is 20 m or more across and 100
/// times larger than its distance, or under 5 mm and 1/500 of it, as with a wrong unit. (The
/// distance is the larger one of those to the station's origin and to the box.)
std::string scaleConcern(const BoundingBox& bounds_in_station, const Pose& camera_from_station);

/// InputError naming the first part's file when there is a scaleConcern.
void requirePlausibleScale(const SceneMesh& scene, const Pose& camera_from_station);

}  // namespace boresight::sessions
