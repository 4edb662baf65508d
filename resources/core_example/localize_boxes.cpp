// SPDX-License-Identifier: Apache-2.0
// Localizes a camera before a station of boxes with Boresight's core: takes a picture from a known
// pose, begins from a seed that is wrong, and says how near to the truth the result is.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "core/localizer/localizer.h"
#include "station.h"

namespace {

using boresight::LocalizationProblem;
using boresight::Localizer;
using boresight::LocalizerOptions;
using boresight::Pose;

boresight::Camera makeCamera() {
  boresight::Camera camera;
  camera.width = camera.height = 384;
  camera.fx = camera.fy = 680.0;
  camera.cx = camera.cy = 191.5;  // the centre of the top-left pixel is (0, 0)
  return camera;
}

/// The station 0.45 m before the camera, its z axis towards it and tilted, so that walls are seen.
Pose truePose() {
  Pose facing;
  facing.rotation = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  Pose tilted;
  tilted.rotation = boresight::rotationExp({0.42, -0.28, 0.15});
  Pose camera_from_station = tilted * facing;
  camera_from_station.translation_m = {0.004, -0.003, 0.45};
  return camera_from_station;
}

/// Some 12 mm and 3 degrees from the truth, believed to be within 20 mm and 4 degrees per axis.
void setSeed(LocalizationProblem& problem, const Pose& camera_from_station) {
  const Eigen::Vector3d centre = boresight::matchedBounds(problem.mesh).centre();
  boresight::Vector6d offset;
  offset << 0.03, -0.025, 0.02, 0.007, -0.006, 0.008;  // rotation (rad), translation (m)
  problem.camera_from_station_seed =
      boresight::displacedAboutPivot(camera_from_station, offset, camera_from_station * centre);
  problem.uncertainty.translation_m.setConstant(0.02);
  problem.uncertainty.rotation_rad.setConstant(0.07);
  problem.uncertainty.pivot_in_camera_m = problem.camera_from_station_seed * centre;
}

/// Of the station's centre, in millimetres.
double errorInMillimetres(const LocalizationProblem& problem, const Pose& camera_from_station,
                          const Pose& truth) {
  const Eigen::Vector3d centre = boresight::matchedBounds(problem.mesh).centre();
  return 1e3 * (camera_from_station * centre - truth * centre).norm();
}

int fail(const char* why) {
  std::fprintf(stderr, "localize_boxes: %s\n", why);
  return 1;
}

int localize(const LocalizationProblem& problem, const Pose& truth) {
  const LocalizerOptions options = boresight::defaultProfile();
  std::size_t bytes = 0;
  const auto asked = requiredBytes(boresight::sizeOf(problem), options, bytes);
  if (asked != boresight::Status::kOk) return fail(boresight::statusText(asked));
  // All that the core works with is this block; it never asks for more.
  std::vector<std::byte> memory(bytes);
  Localizer localizer(problem, options, memory);
  if (localizer.status() != boresight::Status::kOk)
    return fail(boresight::statusText(localizer.status()));
  while (!localizer.step().finished) {
  }
  const boresight::Workspace& result = localizer.workspace();
  if (result.status != boresight::LocalizationStatus::kConverged)
    return fail(boresight::localizationStatusText(result.status));
  const double error_mm = errorInMillimetres(problem, result.camera_from_station, truth);
  std::printf("converged in %d iterations with %zu bytes\nseed off by %.3f mm, result by %.3f mm\n",
              result.iterations, bytes,
              errorInMillimetres(problem, problem.camera_from_station_seed, truth), error_mm);
  return error_mm < 0.5 ? 0 : fail("the result is not the pose that the picture was taken from");
}

}  // namespace

int main() {
  LocalizationProblem problem;
  problem.camera = makeCamera();
  const boresight::Status usable = boresight::prepareCamera(problem.camera);
  if (usable != boresight::Status::kOk) return fail(boresight::statusText(usable));
  const example::Station station = example::makeStation();
  const Pose truth = truePose();
  const std::vector<std::uint8_t> pixels = example::photograph(station, problem.camera, truth);
  problem.image = {pixels.data(), problem.camera.width, problem.camera.height,
                   problem.camera.width};
  problem.mesh = station.view();
  setSeed(problem, truth);
  return localize(problem, truth);
}
