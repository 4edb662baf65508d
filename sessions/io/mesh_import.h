// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "sessions/io/mesh_container.h"

namespace boresight::sessions {

/// Triangles of a mesh file as they come, before welding.
struct ImportedMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<Face> faces;
  std::int64_t file_vertices = 0;
  std::int64_t file_polygons = 0;
  std::int64_t lines_and_points = 0;
  std::int64_t irregular_polygons = 0;  ///< could only be cut into a fan
};

/// Reads files of which the first passed checkMeshContainer, places every mesh by the transforms of
/// its nodes, scales to metres, and triangulates. Importer and damaged files: every index and
/// coordinate is checked here. Opens no file. InputError.
ImportedMesh importMesh(const MeshFiles& files, const MeshDeclaration& declared,
                        double metres_per_unit);

/// InputError when a mesh has more of something than can be handled.
void requireAtMost(const std::filesystem::path& file, std::int64_t count, std::int64_t limit,
                   const char* what);

}  // namespace boresight::sessions
