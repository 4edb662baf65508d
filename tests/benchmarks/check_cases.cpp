// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/check_cases.h"

#include <algorithm>
#include <stdexcept>

#include "sessions/checks/checks.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/io/meshes/scene_mesh.h"

namespace boresight::test {
namespace {

using sessions::LoadedCase;
using sessions::SessionCase;

/// Mirrored through the station's origin, or through the middle of its box.
void mirrorMesh(sessions::SceneMesh& scene, int axis, bool about_origin) {
  const double middle_m = about_origin ? 0.0 : matchedBounds(scene.view()).centre()(axis);
  for (Eigen::Vector3f& vertex : scene.vertices_in_station_m)
    vertex(axis) = static_cast<float>(2.0 * middle_m) - vertex(axis);
  for (Face& face : scene.faces) std::swap(face.vertex[1], face.vertex[2]);
}

void changeCamera(Camera& camera, double focal_factor, double right_px, double down_px) {
  camera.fx *= focal_factor;
  camera.fy *= focal_factor;
  camera.cx += right_px;
  camera.cy += down_px;
  if (prepareCamera(camera) != Status::kOk) throw std::runtime_error("camera");
}

/// A gray patch over a part of the station's box in the image, from its left.
void occlude(LoadedCase& loaded, const Pose& camera_from_station, double share) {
  const BoundingBox box = matchedBounds(loaded.scene.view());
  Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d most = -least;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? box.maximum_m.x() : box.minimum_m.x(),
                                 (i & 2) != 0 ? box.maximum_m.y() : box.minimum_m.y(),
                                 (i & 4) != 0 ? box.maximum_m.z() : box.minimum_m.z());
    Eigen::Vector2d pixel;
    if (!project(loaded.source.camera, camera_from_station * corner, pixel)) continue;
    least = least.cwiseMin(pixel);
    most = most.cwiseMax(pixel);
  }
  const auto clamped = [](double value, int size) {
    return std::clamp(static_cast<int>(value), 0, size);
  };
  const int x_end = clamped(least.x() + share * (most.x() - least.x()), loaded.image.width);
  const int y_end = clamped(most.y(), loaded.image.height);
  for (int y = clamped(least.y(), loaded.image.height); y < y_end; ++y)
    for (int x = clamped(least.x(), loaded.image.width); x < x_end; ++x)
      loaded.image.pixels[static_cast<std::size_t>(y * loaded.image.width + x)] = 90;
}

void reseed(LoadedCase& loaded, const Pose& camera_from_station_true, double scale, int number) {
  SessionCase& session_case = loaded.source;
  session_case.camera_from_station_seed = sessions::seedForOffset(
      camera_from_station_true,
      sessions::drawOffset(session_case.uncertainty, scale, session_case.id, number),
      session_case.uncertainty.pivot, matchedBounds(loaded.scene.view()).centre());
}

void change(LoadedCase& loaded, const SessionCase& other, const Pose& truth,
            const std::string& variant, bool photograph) {
  Camera& camera = loaded.source.camera;
  const double fx = camera.fx;
  if (variant == "reseed 1") reseed(loaded, truth, 1.0, 1);
  if (variant == "reseed 2") reseed(loaded, truth, 1.0, 2);
  if (variant == "seed 2x") reseed(loaded, truth, 2.0, 3);
  if (variant == "seed 3x") reseed(loaded, truth, 3.0, 4);
  if (variant == "seed 4x") reseed(loaded, truth, 4.0, 5);
  if (variant == "focal +1.5 %") changeCamera(camera, 1.015, 0.0, 0.0);
  if (variant == "focal -1.5 %") changeCamera(camera, 0.985, 0.0, 0.0);
  if (variant == "centre +5 px") changeCamera(camera, 1.0, 5.0, 0.0);
  if (variant == "centre -5 px") changeCamera(camera, 1.0, 0.0, -5.0);
  if (variant == "centre +10 px") changeCamera(camera, 1.0, 10.0, 0.0);
  if (variant == "centre -10 px") changeCamera(camera, 1.0, 0.0, -10.0);
  if (variant == "focal +3 %") changeCamera(camera, 1.03, 0.0, 0.0);
  if (variant == "focal -3 %") changeCamera(camera, 0.97, 0.0, 0.0);
  if (variant == "focal +8 %") changeCamera(camera, 1.08, 0.0, 0.0);
  if (variant == "centre +1 %") changeCamera(camera, 1.0, 0.01 * fx, -0.006 * fx);
  if (variant == "centre +4 %") changeCamera(camera, 1.0, 0.04 * fx, -0.024 * fx);
  if (variant == "mirrored in x") mirrorMesh(loaded.scene, 0, !photograph);
  if (variant == "mirrored in y") mirrorMesh(loaded.scene, 1, !photograph);
  if (variant == "hidden 50 %") occlude(loaded, truth, 0.5);
  if (variant == "hidden 75 %") occlude(loaded, truth, 0.75);
  if (variant != "other mesh") return;
  std::vector<sessions::PartSource> parts;
  for (const sessions::MeshInput& part : other.parts) parts.push_back(part.source);
  loaded.scene = sessions::readScene(parts);
}

}  // namespace

bool isPhotograph(const SessionCase& session_case) {
  return std::ranges::count(session_case.tags, "real") > 0;
}

std::shared_ptr<LoadedCase> copyOf(const LoadedCase& loaded) {
  auto result = std::make_shared<LoadedCase>();
  result->source = loaded.source;
  result->image = loaded.image;
  result->scene = loaded.scene;
  result->ignore = loaded.ignore;
  if (result->ignore) result->ignore_bits = result->ignore->view();
  return result;
}

std::vector<std::string> variantNames(bool photographs) {
  std::vector<std::string> names = {"right"};
  if (!photographs)
    names.insert(names.end(), {"reseed 1", "reseed 2", "focal +1.5 %", "focal -1.5 %",
                               "centre +5 px", "centre -5 px", "centre +10 px", "centre -10 px"});
  names.insert(names.end(), {"other mesh", "mirrored in x", "mirrored in y", "focal +3 %",
                             "focal -3 %", "focal +8 %", "centre +1 %", "centre +4 %", "seed 2x",
                             "seed 3x", "seed 4x", "hidden 50 %", "hidden 75 %"});
  return names;
}

CheckedVariant makeVariant(const sessions::Session& session, const SessionCase& session_case,
                           const SessionCase& other, const std::string& variant) {
  auto loaded = copyOf(*sessions::loadCase(session_case));
  CheckedVariant checked_variant;
  checked_variant.camera_from_station_true = session_case.camera_from_station_truth.value();
  checked_variant.true_camera = session_case.camera;
  change(*loaded, other, checked_variant.camera_from_station_true, variant,
         isPhotograph(session_case));
  loaded->source.camera_from_station_truth.reset();
  checked_variant.wrong_mesh = variant == "other mesh";
  checked_variant.options = sessions::caseOptions(session, session_case, "session");
  checked_variant.options.support.gate = variant == "right" || variant.starts_with("reseed");
  checked_variant.loaded = std::move(loaded);
  return checked_variant;
}

}  // namespace boresight::test
