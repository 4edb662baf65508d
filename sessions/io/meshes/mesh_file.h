// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/mesh.h"
#include "sessions/io/meshes/mesh_container.h"

namespace boresight::sessions {

inline constexpr std::int64_t kMaxMeshVertices = 3'000'000;  ///< in the file, before welding
inline constexpr std::int64_t kMaxMeshFaces = 1'000'000;     ///< triangles

/// Properties of a mesh apart from its geometry; lengths in metres.
struct MeshInfo {
  std::filesystem::path file;
  std::string format;  ///< "PLY", "OBJ", "STL", "glTF", "GLB"
  std::string unit;    ///< as stated, or "m" for glTF
  double metres_per_unit = 1.0;
  std::string file_sha256;  ///< of the file and, for glTF, of its buffers in their order
  std::vector<std::string> file_notes;  ///< what of the file's scene is not read

  std::int64_t file_vertices = 0;
  std::int64_t file_polygons = 0;
  std::int64_t merged_vertices = 0;     ///< repeated positions that were welded
  std::int64_t unused_vertices = 0;     ///< left out: no face uses them
  std::int64_t collapsed_faces = 0;     ///< left out: two corners are the same point
  std::int64_t lines_and_points = 0;    ///< left out: primitives that are not faces
  std::int64_t irregular_polygons = 0;  ///< cross themselves or have no area: cut as a fan
  std::int64_t sliver_faces = 0;        ///< kept: height below 1e-4 of the longest side

  Eigen::Vector3d minimum_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d maximum_m = Eigen::Vector3d::Zero();

  double diagonal_m() const { return (maximum_m - minimum_m).norm(); }
  /// Lines for the operator: parts left out, an unusual size, coarse rounding.
  std::vector<std::string> notes() const;
};

/// Triangles of one file in its own frame, metres; axes as in the file, welded (mesh_faces.h).
struct Mesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<Face> faces;
  MeshInfo info;
};

/// Metres per unit for "m", "dm", "cm", "mm", "um", "in", "ft", "yd", "km"; empty for other names.
std::optional<double> metresPerUnit(const std::string& unit);

/// Reads PLY, OBJ, STL, glTF or GLB. `unit` ("" = not given) is required for formats that carry
/// none; glTF is in metres unless a unit is stated. Node transforms of glTF are applied. InputError
/// when the file is missing, truncated, not of the format of its extension, has counts that
/// contradict its data, no faces, an index out of range, coordinates that are not finite, beyond
/// 1000 km, or so far from the origin that single precision would deform the mesh, only slivers, a
/// required glTF extension that is not read, or more than the limits above.
Mesh readMesh(const std::filesystem::path& file, const std::string& unit);
/// The same of files that are already read.
Mesh readMesh(const MeshFiles& files, const std::string& unit);

/// InputError when single precision, in which vertices are stored, rounds the coordinates of a mesh
/// within these bounds by more than a thousandth of its size.
void requireNear(const std::filesystem::path& file, const BoundingBox& bounds);

/// "12.3 mm" below a metre, else "4.56 m".
std::string lengthText(double length_m);

}  // namespace boresight::sessions
