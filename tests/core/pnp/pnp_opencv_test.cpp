// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/pnp/epnp.h"
#include "tests/core/geometry/example_cameras.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight::test {
namespace {

cv::Mat cameraMatrix(const Camera& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0,
          1.0);
}

cv::Mat distortionOf(const Camera& camera) {
  return cv::Mat(1, 8, CV_64F, const_cast<double*>(camera.distortion.data())).clone();
}

struct Matched {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
};

/// Those of a scene; with `inlier`, only what is marked there.
Matched matchedOf(const PnpScene& scene, std::span<const std::uint8_t> inlier = {}) {
  Matched matched;
  for (std::size_t i = 0; i < scene.correspondences.size(); ++i) {
    if (!inlier.empty() && inlier[i] == 0) continue;
    const Correspondence& item = scene.correspondences[i];
    matched.points.emplace_back(item.point_in_station_m.x(), item.point_in_station_m.y(),
                                item.point_in_station_m.z());
    matched.pixels.emplace_back(item.pixel.x(), item.pixel.y());
  }
  return matched;
}

Eigen::Vector3d vectorOf(const cv::Mat& vector) {
  return {vector.at<double>(0), vector.at<double>(1), vector.at<double>(2)};
}

/// By one of OpenCV's solvers; `refined`: then by its Levenberg-Marquardt until convergence.
Pose solveByOpenCv(const Matched& matched, const Camera& camera, cv::SolvePnPMethod method,
                   bool refined = false) {
  cv::Mat rotation_vector, translation;
  EXPECT_TRUE(cv::solvePnP(matched.points, matched.pixels, cameraMatrix(camera),
                           distortionOf(camera), rotation_vector, translation, false, method));
  const cv::TermCriteria still(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-15);
  if (refined)
    cv::solvePnPRefineLM(matched.points, matched.pixels, cameraMatrix(camera), distortionOf(camera),
                         rotation_vector, translation, still);
  return {rotationExp(vectorOf(rotation_vector)), vectorOf(translation)};
}

void expectPosesOfOpenCv(const std::string& name, const Camera& camera,
                         const PnpSceneOptions& scene_options, double threshold_px,
                         cv::SolvePnPMethod method, bool refined = false) {
  Random random = randomFor("PnpAgainstOpenCv." + name);
  for (int trial = 0; trial < 20; ++trial) {
    const PnpScene scene = makeScene(random, scene_options, camera);
    const Solved solver(scene, threshold_px);
    const Matched matched = matchedOf(scene, solver.inlier);
    EXPECT_THAT(solver.solution.camera_from_station,
                poseNear(solveByOpenCv(matched, scene.camera, method, refined), 1e-6, 1e-6));
  }
}

TEST(PnpAgainstOpenCv, GivesThePosesOfItsSolvers) {
  for (const auto& [name, camera] : exampleCameras()) {
    if (camera.model == CameraModel::kKannalaBrandt) continue;
    SCOPED_TRACE(name);
    expectPosesOfOpenCv("Same." + name, camera,
                        {.points = 80, .outlier_share = 0.4, .noise_px = 0.5}, 3.0,
                        cv::SOLVEPNP_SQPNP, true);
    expectPosesOfOpenCv("Iterative." + name, camera, {.points = 40, .noise_px = 0.3}, 5.0,
                        cv::SOLVEPNP_ITERATIVE);
    expectPosesOfOpenCv("Sqpnp." + name, camera, {.points = 40}, 1.0, cv::SOLVEPNP_SQPNP);
  }
}

/// Errors of EPnP and of OpenCV's on the same noisy points, summed.
TEST(SolveEpnpAgainstOpenCv, NoisyPoints_GiveNoLargerErrors) {
  Random random = randomFor("SolveEpnpAgainstOpenCv.NoisyPoints");
  const Camera camera = makePinhole(1000, 1000, 1000.0);
  double ours_rad = 0.0;
  double theirs_rad = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 6 + trial % 40, .noise_px = 0.3}, camera);
    std::vector<Eigen::Vector3d> bearing, point;
    for (const Correspondence& item : scene.correspondences) {
      point.push_back(item.point_in_station_m);
      ASSERT_TRUE(unproject(camera, item.pixel, bearing.emplace_back()));
    }
    Pose ours;
    ASSERT_TRUE(solveEpnp(bearing, point, ours));
    const Pose theirs = solveByOpenCv(matchedOf(scene), camera, cv::SOLVEPNP_EPNP);
    const auto error_rad = [&](const Pose& pose) {
      return std::min(
          0.2, rotationLog(pose.rotation * scene.camera_from_station.rotation.conjugate()).norm());
    };
    ours_rad += error_rad(ours);
    theirs_rad += error_rad(theirs);
  }
  EXPECT_LT(ours_rad, 1.1 * theirs_rad);
}

}  // namespace
}  // namespace boresight::test
