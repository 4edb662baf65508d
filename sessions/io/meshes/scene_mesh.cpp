// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/scene_mesh.h"

#include <algorithm>
#include <limits>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

/// Those of the station come first.
std::size_t stationFaceCount(const MeshView& view) {
  const auto moves = [&view](std::uint16_t part) { return view.parts[part].fixed_to_camera; };
  const auto end = std::find_if(view.part_of_face.begin(), view.part_of_face.end(), moves);
  return static_cast<std::size_t>(end - view.part_of_face.begin());
}

BoundingBox placedBounds(const Mesh& mesh, const Pose& frame_from_mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BoundingBox bounds{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  for (const Eigen::Vector3f& vertex : mesh.vertices_m) {
    const Eigen::Vector3d placed_m = frame_from_mesh * vertex.cast<double>().eval();
    bounds.minimum_m = bounds.minimum_m.cwiseMin(placed_m);
    bounds.maximum_m = bounds.maximum_m.cwiseMax(placed_m);
  }
  return bounds;
}

}  // namespace

void addPart(SceneMesh& scene, const Mesh& mesh, const Pose& frame_from_mesh, const ScenePart& part,
             double albedo) {
  const std::filesystem::path& file = mesh.info.file;
  const std::size_t first = scene.vertices_in_station_m.size();
  const auto require = [&file](std::size_t count, std::int64_t limit, const char* what) {
    requireAtMost(file, static_cast<std::int64_t>(count), limit, what);
  };
  require(first + mesh.vertices_m.size(), kMaxMeshVertices, "vertices of the station");
  require(scene.faces.size() + mesh.faces.size(), kMaxMeshFaces, "faces of the station");
  require(scene.parts.size() + 1, std::numeric_limits<std::uint16_t>::max(), "parts");
  // Without a transform the coordinates keep their bits.
  const bool in_place = frame_from_mesh == Pose();
  if (!in_place) requireNear(file, placedBounds(mesh, frame_from_mesh));
  for (const Eigen::Vector3f& vertex : mesh.vertices_m)
    scene.vertices_in_station_m.push_back(
        in_place ? vertex
                 : Eigen::Vector3f((frame_from_mesh * vertex.cast<double>().eval()).cast<float>()));
  for (const Face& face : mesh.faces) {
    Face moved = face;
    for (std::int32_t& index : moved.vertex) index += static_cast<std::int32_t>(first);
    scene.faces.push_back(moved);
  }
  scene.part_of_face.resize(scene.faces.size(), static_cast<std::uint16_t>(scene.parts.size()));
  scene.parts.push_back(part);
  scene.infos.push_back(mesh.info);
  scene.albedo_of_part.push_back(albedo);
}

MeshView heldView(const SceneMesh& scene) {
  MeshView view = scene.view();
  const std::size_t faces = stationFaceCount(view);
  view.faces = std::span<const Face>(scene.faces).subspan(faces);
  view.part_of_face = view.part_of_face.subspan(faces);
  return view;
}

MeshView stationView(const SceneMesh& scene) {
  MeshView view = scene.view();
  const std::size_t faces = stationFaceCount(view);
  view.vertices_in_station_m = view.vertices_in_station_m.first(firstVertexInCamera(view));
  view.faces = view.faces.first(faces);
  view.part_of_face = view.part_of_face.first(faces);
  return view;
}

SceneMesh readScene(std::span<const PartSource> parts, const FrameTree& frames,
                    const PartCheck& check) {
  SceneMesh scene;
  std::vector<PartSource> placed(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].state.used()) placed[i] = placedPart(parts[i], frames);
  for (const FrameName& frame : {kStationFrame, kCameraFrame}) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const PartSource& part = placed[i];
      if (!parts[i].state.used() || part.frame != frame) continue;
      const MeshFiles files = readMeshFiles(part.mesh);
      if (check) check(i, files.sha256);
      const ScenePart scene_part{.normal_threshold_rad = part.normal_threshold_rad,
                                 .depth_threshold_m = part.depth_threshold_m,
                                 .match = part.state.matched(),
                                 .fixed_to_camera = frame == kCameraFrame};
      addPart(scene, readMesh(files, part.mesh_unit), part.frame_from_mesh, scene_part,
              part.albedo.value_or(1.0));
    }
  }
  if (!anyMatched(parts))
    throw InputError(parts.empty() ? "(station)" : parts.front().mesh, "role",
                     "no part of the station is matched");
  return scene;
}

std::vector<Eigen::Vector3f> matchedVertices(const MeshView& mesh) {
  std::vector<bool> matched(mesh.vertices_in_station_m.size(), false);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.parts[mesh.part_of_face[f]].match) continue;
    for (const std::int32_t index : mesh.faces[f].vertex)
      matched[static_cast<std::size_t>(index)] = true;
  }
  std::vector<Eigen::Vector3f> vertices;
  for (std::size_t i = 0; i < matched.size(); ++i)
    if (matched[i]) vertices.push_back(mesh.vertices_in_station_m[i]);
  return vertices;
}

std::string scaleConcern(const BoundingBox& bounds_in_station, const Pose& camera_from_station) {
  constexpr double kLarge_m = 20.0;
  constexpr double kLargeRatio = 100.0;
  constexpr double kSmall_m = 0.005;
  constexpr double kSmallRatio = 1.0 / 500.0;
  const Eigen::Vector3d camera_in_station_m = camera_from_station.inverse().translation_m;
  const Eigen::Vector3d nearest_m = camera_in_station_m.cwiseMax(bounds_in_station.minimum_m)
                                        .cwiseMin(bounds_in_station.maximum_m);
  const double distance_m =
      std::max(camera_in_station_m.norm(), (camera_in_station_m - nearest_m).norm());
  const double diagonal_m = bounds_in_station.diagonal();
  const bool too_large = diagonal_m >= kLarge_m && diagonal_m > kLargeRatio * distance_m;
  const bool too_small = diagonal_m <= kSmall_m && diagonal_m < kSmallRatio * distance_m;
  if (!too_large && !too_small) return "";
  return "the mesh measures " + lengthText(diagonal_m) + " across, but the seed's camera is " +
         lengthText(distance_m) + " away";
}

void requirePlausibleScale(const SceneMesh& scene, const Pose& camera_from_station) {
  const std::string concern = scaleConcern(matchedBounds(scene.view()), camera_from_station);
  if (concern.empty() || scene.infos.empty()) return;
  throw InputError(scene.infos.front().file, "mesh_unit",
                   concern + " (unit '" + scene.infos.front().unit + "'): check the unit");
}

}  // namespace boresight::sessions
