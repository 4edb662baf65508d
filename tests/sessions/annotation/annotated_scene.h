// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/annotation/annotations.h"
#include "tests/support/random_pose.h"

/// Annotations of known truth for tests.
namespace boresight::test {

/// A narrow camera, with distortion unless it is a pinhole.
inline Camera annotatedCamera(CameraModel model) {
  Camera camera;
  camera.model = model;
  camera.width = 1024;
  camera.height = 1024;
  camera.fx = 1500.0;
  camera.fy = 1510.0;
  camera.cx = 510.0;
  camera.cy = 515.0;
  if (model == CameraModel::kBrownConrady) camera.distortion = {-0.12, 0.06, 4e-4, -3e-4, 0.0};
  if (model == CameraModel::kKannalaBrandt) {
    camera.fx = camera.fy = 700.0;
    camera.distortion = {0.03, -0.01, 0.004, 0.001};
  }
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

inline Eigen::Vector2d gaussian(Random& random, double sigma_px) {
  const double x = random.normal();
  const double y = random.normal();
  return sigma_px * Eigen::Vector2d(x, y);
}

struct AnnotatedScene {
  sessions::AnnotatedView view;
  Pose camera_from_station;  ///< the truth

  std::vector<sessions::AnnotatedView> views() const { return {view}; }
};

/// Adds a pair at this place of the station, seen with noise. False when the camera does not see
/// it.
inline bool addPoint(sessions::AnnotatedView& view, const Pose& camera_from_station,
                     const Eigen::Vector3d& place_m, double noise_px, double sigma_px,
                     Random& random) {
  Eigen::Vector2d pixel;
  if (!project(view.camera, camera_from_station * place_m, pixel)) return false;
  view.annotations.points.push_back({sessions::unusedId(view.annotations, 'p'), place_m,
                                     pixel + gaussian(random, noise_px), sigma_px, true, false,
                                     ""});
  return true;
}

/// Adds an edge between two places, seen at a fifth and four fifths of its length.
inline bool addLine(sessions::AnnotatedView& view, const Pose& camera_from_station,
                    const Eigen::Vector3d& start_m, const Eigen::Vector3d& end_m, double noise_px,
                    double sigma_px, Random& random) {
  sessions::ImageLine line;
  const Eigen::Vector3d from_m = 0.8 * start_m + 0.2 * end_m;
  const Eigen::Vector3d to_m = 0.2 * start_m + 0.8 * end_m;
  if (!project(view.camera, camera_from_station * from_m, line.start)) return false;
  if (!project(view.camera, camera_from_station * to_m, line.end)) return false;
  line.start += gaussian(random, noise_px);
  line.end += gaussian(random, noise_px);
  view.annotations.lines.push_back({sessions::unusedId(view.annotations, 'l'),
                                    sessions::ModelEdge{start_m, end_m}, line, sigma_px, true,
                                    false, ""});
  return true;
}

/// Points in a box of 20 cm half a metre away (its third side `thickness_m`), and edges of it.
inline AnnotatedScene randomScene(Random& random, CameraModel model, int points, int lines,
                                  double noise_px, double thickness_m = 0.2) {
  AnnotatedScene scene;
  scene.view.name = "camera";
  scene.view.camera = annotatedCamera(model);
  scene.camera_from_station = randomCameraFromStation(random, 0.5);
  const Eigen::Vector3d size_m(0.2, 0.2, thickness_m);
  const auto place = [&] { return randomVector(random, 0.5).cwiseProduct(size_m).eval(); };
  const double sigma_px = noise_px > 0.0 ? noise_px : 1.0;
  while (static_cast<int>(scene.view.annotations.points.size()) < points)
    addPoint(scene.view, scene.camera_from_station, place(), noise_px, sigma_px, random);
  while (static_cast<int>(scene.view.annotations.lines.size()) < lines) {
    const Eigen::Vector3d start_m = place();
    const Eigen::Vector3d end_m = place();
    if ((end_m - start_m).norm() > 0.05)
      addLine(scene.view, scene.camera_from_station, start_m, end_m, noise_px, sigma_px, random);
  }
  return scene;
}

}  // namespace boresight::test
