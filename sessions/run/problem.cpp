// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/problem.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "sessions/io/errors.h"
#include "sessions/run/run_text.h"
#include "sessions/run/scene_render.h"

namespace boresight::sessions {
namespace {

bool insideImage(const Camera& camera, const Eigen::Vector3d& point_in_camera_m) {
  Eigen::Vector2d pixel;
  return project(camera, point_in_camera_m, pixel) && pixel.x() >= -0.5 && pixel.y() >= -0.5 &&
         pixel.x() <= camera.width - 0.5 && pixel.y() <= camera.height - 0.5;
}

/// True when a small render shows anything: faces may cover the image though no vertex is in it.
bool anythingRendered(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station) {
  const Camera small = cameraAtLevel(camera, kPyramidLevels - 1);
  RenderTrace render;
  if (renderScene(small, mesh, camera_from_station, render) != Status::kOk) return true;
  return std::any_of(render.mask.words.begin(), render.mask.words.end(),
                     [](std::uint64_t word) { return word != 0; });
}

std::string centreText(const Eigen::Vector3d& centre_in_camera_m) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                " (its centre is at %.3f %.3f %.3f m in the camera frame: x right, y down, z "
                "forward)",
                centre_in_camera_m.x(), centre_in_camera_m.y(), centre_in_camera_m.z());
  return text.data();
}

[[noreturn]] void refuse(const InputPlaces::Place& place, const std::string& reason) {
  if (place.field.empty()) throw InputError(place.file, reason);
  throw InputError(place.file, place.field, reason);
}

}  // namespace

LocalizationProblem problemOf(const GrayImage& image, const BitImage* ignore, const Camera& camera,
                              const MeshView& mesh, const Pose& camera_from_station_seed,
                              const DeclaredUncertainty& uncertainty) {
  LocalizationProblem problem;
  problem.image = image.view();
  problem.color = image.colorView();
  problem.ignore = ignore;
  problem.camera = camera;
  problem.mesh = mesh;
  problem.camera_from_station_seed = camera_from_station_seed;
  problem.uncertainty =
      seedUncertainty(uncertainty, camera_from_station_seed, matchedBounds(mesh).centre());
  return problem;
}

std::string seedConcern(const Camera& camera, const MeshView& mesh,
                        const Pose& camera_from_station_seed) {
  bool in_front = false;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.parts[mesh.part_of_face[f]].match) continue;
    for (const std::int32_t index : mesh.faces[f].vertex) {
      const Eigen::Vector3d point_in_camera_m =
          camera_from_station_seed *
          mesh.vertices_in_station_m[static_cast<std::size_t>(index)].cast<double>();
      if (insideImage(camera, point_in_camera_m)) return "";
      in_front = in_front || point_in_camera_m.z() > 0.0;
    }
  }
  const Eigen::Vector3d centre_in_camera_m =
      camera_from_station_seed * matchedBounds(mesh).centre();
  if (!in_front)
    return "the station lies behind the camera at the seed" + centreText(centre_in_camera_m);
  if (anythingRendered(camera, mesh, camera_from_station_seed)) return "";
  return "the station is entirely out of view at the seed" + centreText(centre_in_camera_m);
}

void requireSensibleSeed(const Camera& camera, const SceneMesh& scene,
                         const Pose& camera_from_station_seed, const std::filesystem::path& file,
                         const std::string& place) {
  requirePlausibleScale(scene, camera_from_station_seed);
  const std::string concern = seedConcern(camera, scene.view(), camera_from_station_seed);
  if (!concern.empty()) throw InputError(file, place, concern);
}

void requireAccepted(const LocalizationTrace& trace, const InputPlaces& places) {
  const std::string reason = statusText(trace.fault);
  switch (trace.fault) {
    case Status::kInvalidMesh:
      refuse(places.mesh, reason);
    case Status::kTooManyLayers:
      refuse(places.mesh, explanation(trace));
    case Status::kInvalidCamera:
      refuse(places.camera, reason);
    case Status::kInvalidImage:
      refuse(places.image, reason);
    case Status::kInvalidPose:
      refuse(places.seed, reason);
    default:
      break;
  }
}

}  // namespace boresight::sessions
