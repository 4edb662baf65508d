// SPDX-License-Identifier: Apache-2.0
// Whole runs with the cameras of planetary images, on pictures made by casting rays.
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/localizer.h"
#include "core/record/problem_bytes.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

struct Setting {
  std::string name;
  Camera camera;
  double turn_rad = 0.0;    ///< of the camera about y: the station is seen that far off its axis
  double most_off_m = 0.0;  ///< of the camera
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

Camera lens(CameraModel model, double focal_px) {
  Camera camera;
  camera.model = model;
  camera.width = camera.height = 512;
  camera.fx = focal_px;
  camera.fy = 1.003 * focal_px;
  camera.cx = 259.0;
  camera.cy = 250.0;
  return camera;
}

Camera prepared(Camera camera) {
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// Image axes 3 deg from square, y up the image.
Camera skewMirrored() {
  Camera camera = lens(CameraModel::kCahv, 900.0);
  camera.cahv.skew_px = 47.0;
  camera.fy = -880.0;
  return prepared(camera);
}

Camera cahvor() {
  Camera camera = lens(CameraModel::kCahvor, 900.0);
  camera.cahv.optical_axis = Eigen::Vector3d(0.012, -0.007, 1.0).normalized();
  camera.cahv.radial = {-0.001, -0.21, 0.05};
  return prepared(camera);
}

/// Looks 35 deg past its axis, where the pupil lies 1.7 mm before the centre.
Camera cahvore() {
  Camera camera = lens(CameraModel::kCahvore, 820.0);
  camera.cahv.optical_axis = Eigen::Vector3d(-0.004, 0.003, 1.0).normalized();
  camera.cahv.radial = {0.000002, 0.0075, -0.0056};
  camera.cahv.entrance_m = {0.026, 0.0004, -0.0045};
  camera.cahv.linearity = 0.37;
  camera.cx = 256.0 - 820.0 * 0.63;
  return prepared(camera);
}

std::vector<Setting> settings() {
  // A quarter of the requirement, as with other cameras. Seen from aside, more of the station's
  // edges rise on one side than on the other: what one sample per pixel widens is not balanced.
  return {{"SkewMirroredCahv", skewMirrored(), 0.0, 1e-4},
          {"Cahvor", cahvor(), 0.0, 1e-4},
          {"CahvoreWithADeepPupil", cahvore(), 35.0 * kDegree_rad, 2.5e-4}};
}

class LocalizerOnPlanetaryCameras : public ::testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(Cahv, LocalizerOnPlanetaryCameras, ::testing::ValuesIn(settings()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(LocalizerOnPlanetaryCameras, ConvergesToTheTruth) {
  const Setting& setting = GetParam();
  const Pose turned{rotationExp({0.0, setting.turn_rad, 0.0}), Eigen::Vector3d::Zero()};
  const Pose truth = turned * truthPose();
  const Picture picture = takePictureByRays(stationMesh(), setting.camera, truth);
  for (const PnpSampler sampler : {PnpSampler::kGuided, PnpSampler::kEpnp}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(seed);
      const Case scene = caseOf(stationMesh(), setting.camera, picture, truth, seed);
      LocalizerOptions options = defaultProfile();
      options.pnp.sampler = sampler;
      const FinishedRun run(scene, options);
      expectTruth(scene, run.workspace, setting.most_off_m);
      EXPECT_GT(run.workspace.support.share(), 0.7);
    }
  }
}

TEST_P(LocalizerOnPlanetaryCameras, DecodedProblem_HasTheSameCamera) {
  const Picture picture = noisePicture(512, 512, 3);
  const Case scene = caseOf(stationMesh(), GetParam().camera, picture, truthPose(), 1);
  std::vector<std::uint8_t> bytes(encodeProblem(scene.problem(), defaultProfile(), {}));
  ASSERT_EQ(encodeProblem(scene.problem(), defaultProfile(), bytes), bytes.size());
  std::vector<std::byte> memory(1 << 20);
  Arena arena(memory);
  LocalizationProblem read;
  LocalizerOptions options;
  ASSERT_EQ(decodeProblem(bytes, arena, read, options).fault, ProblemFault::kNone);
  EXPECT_EQ(read.camera, scene.camera);
}

}  // namespace
}  // namespace boresight::test
