// SPDX-License-Identifier: Apache-2.0
#include "tests/core/localizer/rail_scene.h"

#include <array>
#include <cmath>

#include "core/base/math.h"

namespace boresight::test {
namespace {

constexpr int kSleeves = 6;
constexpr int kEndless = 15;

Pose railPose() { return tiltedPose({0.38, -0.12, 0.2}, {0.002, -0.003, 0.40}); }

/// Boxes in front of both ends that are missing in the mesh.
Solid hiddenRail() {
  Solid solid = railMesh(kSleeves, true);
  for (const double side : {-1.0, 1.0})
    solid.addBox(side * 0.098, 0.0, 0.036, 0.055, 0.0, 0.045, 0.055, 0.5);
  return solid;
}

const Picture& pictureOf(Ends ends) {
  static const std::array<Picture, 3> pictures = {
      takePicture(railMesh(kSleeves, true), pinholeCamera(), railPose()),
      takePicture(hiddenRail(), pinholeCamera(), railPose()),
      takePicture(railMesh(kEndless, false), pinholeCamera(), railPose())};
  return pictures[static_cast<std::size_t>(ends)];
}

}  // namespace

Solid railMesh(int sleeves, bool with_ends) {
  Solid solid;
  const double half_m = 0.5 * sleeves * kPitch_m;
  solid.addBox(0.0, 0.0, half_m + 0.02, 0.018, 0.0, -0.010, 0.0, 0.6);
  for (int i = 0; i < sleeves; ++i) {
    const double x_m = (i - 0.5 * (sleeves - 1)) * kPitch_m;
    solid.addCylinder(x_m, 0.0, 0.008, 0.0, 0.026, 0.95);
  }
  if (with_ends) {
    solid.addBox(-half_m - 0.012, 0.004, 0.005, 0.010, 0.3, 0.0, 0.020, 0.9);
    solid.addPrism({{half_m + 0.004, -0.010}, {half_m + 0.017, -0.006}, {half_m + 0.008, 0.012}},
                   0.0, 0.016, 0.85);
  }
  return solid;
}

Case railCase(Ends ends, double off_pitches, double declared_pitches, std::uint64_t seed) {
  Case scene;
  scene.solid = ends == Ends::kOutside ? railMesh(kEndless, false) : railMesh(kSleeves, true);
  scene.camera = pinholeCamera();
  scene.picture = &pictureOf(ends);
  scene.truth = railPose();
  SeedUncertainty box;
  box.translation_m.setConstant(0.010);
  box.translation_m.x() = declared_pitches * kPitch_m;
  box.rotation_rad.setConstant(0.05);
  box.pivot_in_camera_m = scene.truth * matchedBounds(scene.solid.view()).centre();
  Vector6d offset = offsetWithin(box, 0.6, seed);
  const Eigen::Vector3d along = scene.truth.matrix().col(0) * (off_pitches * kPitch_m);
  offset.tail<3>() = along + 0.3 * Eigen::Vector3d(0.0, offset[4], offset[5]);
  scene.seed = displacedAboutPivot(scene.truth, offset, box.pivot_in_camera_m);
  scene.uncertainty = box;
  scene.uncertainty.pivot_in_camera_m = scene.seed * matchedBounds(scene.solid.view()).centre();
  return scene;
}

PitchError pitchError(const Case& scene, const Pose& estimate) {
  const Eigen::Vector3d centre = matchedBounds(scene.solid.view()).centre();
  const Eigen::Vector3d off_m = scene.truth.inverse() * (estimate * centre) - centre;
  const double pitches = off_m.x() / kPitch_m;
  const Eigen::Vector3d rest_m = off_m - Eigen::Vector3d(std::round(pitches) * kPitch_m, 0.0, 0.0);
  return {pitches, rest_m.norm()};
}

}  // namespace boresight::test
