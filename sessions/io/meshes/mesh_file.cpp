// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "sessions/io/files/errors.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/io/meshes/mesh_faces.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr double kSliverRatio = 1e-4;

/// Metres per `info.unit`. InputError when the unit is empty or unknown.
double unitScale(const MeshInfo& info) {
  if (info.unit.empty())
    throw InputError(info.file, "mesh_unit",
                     "missing: " + info.format + " carries no unit (m, cm, mm, um, in, ...)");
  const std::optional<double> scale = metresPerUnit(info.unit);
  if (!scale)
    throw InputError(info.file, "mesh_unit",
                     "unknown unit '" + info.unit + "' (m, dm, cm, mm, um, in, ft, yd, km)");
  return *scale;
}

constexpr double kNotedStep = 1e-4;  ///< of the mesh's diagonal
constexpr double kFineStep_m = 1e-6;
constexpr double kMostStep = 1e-3;

/// Distance of neighbouring numbers of single precision at the largest coordinate: its rounding.
double stepOf(const BoundingBox& bounds) {
  const auto largest = static_cast<float>(
      std::max(bounds.minimum_m.cwiseAbs().maxCoeff(), bounds.maximum_m.cwiseAbs().maxCoeff()));
  return static_cast<double>(std::nextafter(largest, std::numeric_limits<float>::infinity())) -
         static_cast<double>(largest);
}

std::string farText(const BoundingBox& bounds) {
  return "the mesh is " + lengthText(0.5 * (bounds.minimum_m + bounds.maximum_m).norm()) +
         " from the origin, where coordinates are rounded to " + lengthText(stepOf(bounds)) +
         ": move the origin to the mesh";
}

/// Bounds of the faces. InputError when single precision deforms the mesh.
void bound(Mesh& mesh) {
  MeshInfo& info = mesh.info;
  info.minimum_m.setConstant(std::numeric_limits<double>::infinity());
  info.maximum_m = -info.minimum_m;
  for (const Face& face : mesh.faces)
    for (const std::int32_t index : face.vertex) {
      const Eigen::Vector3d vertex_m =
          mesh.vertices_m[static_cast<std::size_t>(index)].cast<double>();
      info.minimum_m = info.minimum_m.cwiseMin(vertex_m);
      info.maximum_m = info.maximum_m.cwiseMax(vertex_m);
    }
  requireNear(info.file, {info.minimum_m, info.maximum_m});
}

void measure(Mesh& mesh) {
  bound(mesh);
  MeshInfo& info = mesh.info;
  for (const Face& face : mesh.faces) {
    const auto corner = [&mesh, &face](std::size_t i) -> Eigen::Vector3d {
      return mesh.vertices_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
    };
    double longest_m = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      longest_m = std::max(longest_m, (corner((i + 1) % 3) - corner(i)).norm());
    const double doubled_area_m2 = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    if (doubled_area_m2 <= kSliverRatio * longest_m * longest_m) ++info.sliver_faces;
  }
  if (info.sliver_faces == static_cast<std::int64_t>(mesh.faces.size()))
    throw InputError(info.file, "faces",
                     "all " + std::to_string(info.sliver_faces) + " are slivers without area");
}

}  // namespace

std::string lengthText(double length_m) {
  return length_m < 1.0 ? formatText("%.4g mm", 1000.0 * length_m) : formatText("%.4g m", length_m);
}

std::optional<double> metresPerUnit(const std::string& unit) {
  constexpr std::pair<const char*, double> kUnits[] = {
      {"m", 1.0},     {"dm", 0.1},    {"cm", 0.01},   {"mm", 0.001},  {"um", 1e-6},
      {"in", 0.0254}, {"ft", 0.3048}, {"yd", 0.9144}, {"km", 1000.0},
  };
  for (const auto& [name, scale] : kUnits)
    if (unit == name) return scale;
  return std::nullopt;
}

Mesh readMesh(const std::filesystem::path& file, const std::string& unit) {
  return readMesh(readMeshFiles(file), unit);
}

Mesh readMesh(const MeshFiles& files, const std::string& unit) {
  const std::filesystem::path& file = files.file;
  Mesh mesh;
  MeshInfo& info = mesh.info;
  info.file = file;
  info.format = meshFormatName(files.format);
  info.unit = unit.empty() && carriesUnit(files.format) ? "m" : unit;
  info.metres_per_unit = unitScale(info);
  info.file_sha256 = files.sha256;
  const MeshDeclaration declared = checkMeshContainer(files);
  requireAtMost(file, declared.vertex_count.value_or(0), kMaxMeshVertices, "vertices");
  requireAtMost(file, declared.polygon_count.value_or(0), kMaxMeshFaces, "faces");
  if (declared.polygon_count != 0) importMesh(files, declared, mesh);
  if (mesh.faces.empty())
    throw InputError(file, "the mesh has no faces (a point cloud cannot be rendered)");
  info.file_notes = declared.notes;
  bound(mesh);  // welding would merge what was rounded
  weldMesh(mesh);
  if (mesh.faces.empty())
    throw InputError(file, "faces", "each has two coinciding corners and no area");
  measure(mesh);
  return mesh;
}

void requireNear(const std::filesystem::path& file, const BoundingBox& bounds) {
  if (stepOf(bounds) > std::max(kMostStep * bounds.diagonal(), kFineStep_m))
    throw InputError(file, "vertices", farText(bounds));
}

std::vector<std::string> MeshInfo::notes() const {
  std::vector<std::string> all = file_notes;
  const auto count = [&all](std::int64_t number, const char* what) {
    if (number > 0) all.push_back(std::to_string(number) + " " + what);
  };
  count(unused_vertices, "vertices belong to no face and were left out");
  count(collapsed_faces, "faces have two coinciding corners and were left out");
  count(lines_and_points, "lines and points were left out");
  count(irregular_polygons, "polygons intersect themselves or have no area");
  count(sliver_faces, "faces are slivers");
  constexpr double kUnusuallyLarge_m = 20.0;
  constexpr double kUnusuallySmall_m = 0.002;
  if (diagonal_m() > kUnusuallyLarge_m || diagonal_m() < kUnusuallySmall_m)
    all.push_back("the mesh measures " + lengthText(diagonal_m()) + " across: check its unit '" +
                  unit + "'");
  const BoundingBox bounds{minimum_m, maximum_m};
  if (stepOf(bounds) > kNotedStep * diagonal_m()) all.push_back(farText(bounds));
  return all;
}

}  // namespace boresight::sessions
