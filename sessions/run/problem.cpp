// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/problem.h"

#include <algorithm>

#include "core/base/digest.h"
#include "sessions/io/files/errors.h"
#include "sessions/text/plain_text.h"
#include "sessions/trace/run_text.h"
#include "sessions/trace/scene_render.h"

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
  return formatText(
      " (its centre is at %.3f %.3f %.3f m in the camera frame: x right, y down, z forward)",
      centre_in_camera_m.x(), centre_in_camera_m.y(), centre_in_camera_m.z());
}

[[noreturn]] void refuse(const InputPlaces::Place& place, const std::string& reason) {
  throw InputError(place.file, place.field, reason);
}

RecordInputs::Hash pixelsHash(const ImageView& image, const ColorView& color) {
  DigestWriter writer;
  for (int y = 0; y < image.height; ++y)
    writer.bytes({image.row(y), static_cast<std::size_t>(image.width)});
  for (int y = 0; y < color.height; ++y)
    writer.bytes({color.row(y), static_cast<std::size_t>(color.width) * ColorView::kChannels});
  return writer.digest();
}

RecordInputs::Hash ignoreHash(const BitImage& ignore) {
  DigestWriter writer;
  for (int y = 0; y < ignore.height; ++y)
    for (int word = 0; word < BitImage::wordsPerRow(ignore.width); ++word)
      writer.u64(ignore.row(y)[word]);
  return writer.digest();
}

RecordInputs::Hash sceneHash(const MeshView& mesh) {
  DigestWriter writer;
  writer.u32(static_cast<std::uint32_t>(mesh.parts.size()));
  for (const ScenePart& part : mesh.parts) {
    writer.f64(part.normal_threshold_rad);
    writer.f64(part.depth_threshold_m);
    writer.u8(roleByte(part));
  }
  writer.u32(static_cast<std::uint32_t>(mesh.vertices_in_station_m.size()));
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    for (int i = 0; i < 3; ++i) writer.f32(vertex[i]);
  writer.u32(static_cast<std::uint32_t>(mesh.faces.size()));
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face].vertex) writer.i32(vertex);
    writer.i32(mesh.part_of_face[face]);
  }
  return writer.digest();
}

RecordInputs::Hash cameraHash(const Camera& camera) {
  DigestWriter writer;
  for (const std::int32_t value :
       {static_cast<std::int32_t>(camera.model), camera.width, camera.height})
    writer.i32(value);
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) writer.f64(value);
  for (const double value : camera.distortion) writer.f64(value);
  if (isCahvFamily(camera.model)) {
    const CahvLens& lens = camera.cahv;
    writer.f64(lens.skew_px);
    for (const Eigen::Vector3d& vector : {lens.optical_axis, lens.radial, lens.entrance_m})
      for (int i = 0; i < 3; ++i) writer.f64(vector[i]);
    writer.f64(lens.linearity);
  }
  return writer.digest();
}

}  // namespace

LocalizationProblem problemOf(const GrayImage& image, const BitImage* ignore, const Camera& camera,
                              const MeshView& mesh, const Pose& camera_from_station_seed,
                              const DeclaredUncertainty& uncertainty,
                              const std::optional<Pose>& camera_from_end_effector) {
  LocalizationProblem problem;
  problem.image = image.view();
  problem.color = image.colorView();
  problem.ignore = ignore;
  problem.camera = camera;
  problem.mesh = mesh;
  problem.camera_from_station_seed = camera_from_station_seed;
  problem.uncertainty =
      seedUncertainty(uncertainty, camera_from_station_seed, matchedBounds(mesh).centre());
  if (camera_from_end_effector)
    problem.end_effector_in_camera_m = camera_from_end_effector->translation_m;
  return problem;
}

RecordInputs recordInputs(const LocalizationProblem& problem) {
  RecordInputs record_inputs;
  record_inputs.pixels = pixelsHash(problem.image, problem.color);
  if (problem.ignore != nullptr) record_inputs.ignore = ignoreHash(*problem.ignore);
  record_inputs.scene = sceneHash(problem.mesh);
  record_inputs.camera = cameraHash(problem.camera);
  return record_inputs;
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
  if (trace.status != LocalizationStatus::kFault) return;
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
    case Status::kInvalidOption:
      refuse(places.seed, explanation(trace));
    default:
      break;
  }
}

}  // namespace boresight::sessions
