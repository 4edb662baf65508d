// SPDX-License-Identifier: Apache-2.0
// Runs of the default profile on upright objects before a level camera: bars, boxes, angle rails,
// tubes and connectors, whose edges are parallel and fall on columns of pixels. Prints a line a run
// and the number of correct and wrong poses.
//
// usage: upright_scenes [SCENES] [hypotheses]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/localizer/pose_change.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

constexpr int kSize_px = 1024;
constexpr double kFocal_px = 1550.0;
/// A pose is correct when the object moves by less in the mean, or, where the edges do not
/// determine it, when its visible edges move by less and the covariance says so.
constexpr double kCorrect_px = 1.5;
constexpr double kCorrectEdges_px = 0.5;
constexpr double kLargestSquare = 40.0;

Camera levelCamera() {
  Camera camera;
  camera.width = camera.height = kSize_px;
  camera.fx = camera.fy = kFocal_px;
  camera.cx = 515.3;
  camera.cy = 508.6;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

constexpr std::array kKinds = {"bar", "box", "angle rail", "tube", "connector"};

struct Upright {
  Solid solid;
  bool round = false;  ///< a turn about its axis changes nothing
};

Upright uprightOf(std::size_t kind, Random& random) {
  Upright upright;
  const auto half = [&](double least_mm, double most_mm) {
    return 0.0005 * random.uniform(least_mm, most_mm);
  };
  const double albedo = random.uniform(0.6, 1.0);
  const double x_m = half(10, 40);
  const double y_m = half(10, 60);
  const double z_m = half(120, 260);
  switch (kind) {
    case 0:
      upright.solid.addBox(0, 0, x_m, y_m, 0, -z_m, z_m, albedo);
      break;
    case 1: {
      const double side_m = half(50, 120);
      upright.solid.addBox(0, 0, side_m, half(50, 120), 0, -half(50, 120), half(50, 120), albedo);
      break;
    }
    case 2: {
      const double wall_m = half(5, 10);
      const double a = 2 * x_m + 2 * wall_m;
      const double b = 2 * y_m + 2 * wall_m;
      // The caps are fans about the inner corner.
      upright.solid.addPrism({{wall_m, wall_m},
                              {wall_m, b - wall_m},
                              {-wall_m, b - wall_m},
                              {-wall_m, -wall_m},
                              {a - wall_m, -wall_m},
                              {a - wall_m, wall_m}},
                             -z_m, z_m, albedo);
      break;
    }
    case 3:
      upright.solid.addCylinder(0, 0, half(20, 60), -z_m, z_m, albedo);
      upright.round = true;
      break;
    default:
      upright.solid.addBox(0, 0, 2 * x_m, 2 * x_m, 0, -0.5 * z_m, 0, albedo);
      upright.solid.addBox(0, 0, 1.4 * x_m, 1.5 * x_m, 0, 0, 0.25 * z_m, 0.8 * albedo);
      upright.solid.addBox(0.3 * x_m, 0, x_m, 0.8 * x_m, 0, 0.25 * z_m, 0.5 * z_m, albedo);
      break;
  }
  return upright;
}

/// Mean motion of the object in the image; of a round one, the least over turns about its axis.
double errorOf_px(const Upright& upright, const Camera& camera, const Pose& truth,
                  const Pose& estimate) {
  if (!upright.round) return meanDisplacement_px(upright.solid, camera, truth, estimate);
  double least_px = std::numeric_limits<double>::infinity();
  for (int degree = 0; degree < 3600; ++degree) {
    Pose turned = estimate;
    turned.rotation =
        estimate.rotation *
        Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * degree * kDegree_rad, Eigen::Vector3d::UnitZ()));
    least_px = std::min(least_px, meanDisplacement_px(upright.solid, camera, truth, turned));
  }
  return least_px;
}

/// Motion of the visible edges along their normals from the truth to a pose, px, root mean square:
/// a direction that the edges do not determine does not count.
double edgeMotion_px(const EdgeRender& render, const Pose& estimate) {
  double squares_px2 = 0.0;
  for (const EdgePixel& pixel : render.eachPixel()) {
    Eigen::Vector3d ray;
    Eigen::Vector2d at_px;
    if (!unproject(render.camera, pixel.onLine_px(), ray)) continue;
    const Eigen::Vector3d point_m =
        render.camera_from_station.inverse() * Eigen::Vector3d(ray * (pixel.depth_m / ray.z()));
    if (!project(render.camera, estimate * point_m, at_px)) continue;
    const double motion_px = (at_px - pixel.onLine_px()).dot(pixel.normal());
    squares_px2 += motion_px * motion_px;
  }
  return std::sqrt(squares_px2 / std::max(1, render.pixel_count));
}

/// Squared error in units of the stated covariance; 6 expected.
double normalizedSquare(const Workspace& end, const Pose& truth) {
  const Vector6d error = perturbationBetween(end.camera_from_station, truth);
  return error.dot(end.covariance.ldlt().solve(error));
}

struct Count {
  int correct = 0;
  int refused = 0;
  int wrong = 0;
};

void run(int scenes, bool lists) {
  const Camera camera = levelCamera();
  std::array<Count, kKinds.size()> counts;
  for (int scene = 0; scene < scenes; ++scene) {
    const auto kind = static_cast<std::size_t>(scene) % kKinds.size();
    Random random(static_cast<std::uint64_t>(scene) + 1);
    const Upright upright = uprightOf(kind, random);
    // The station's z axis upwards in the image.
    Eigen::Matrix3d upwards;
    upwards << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    constexpr std::array kMostYaw_deg = {0.0, 3.0, 45.0};
    const double yaw_deg = kMostYaw_deg[random.below(3)] * random.uniform(-1.0, 1.0);
    const double pitch_deg = random.below(2) == 0 ? 0.0 : random.uniform(-6.0, 6.0);
    Pose truth;
    truth.rotation = Eigen::Quaterniond(
        Eigen::AngleAxisd(pitch_deg * kDegree_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
        upwards *
        Eigen::AngleAxisd(yaw_deg * kDegree_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    truth.translation_m = {random.uniform(-0.03, 0.03), random.uniform(-0.02, 0.02),
                           random.uniform(0.45, 0.7)};
    const bool plain = random.below(2) == 0;
    const Picture picture = takePicture(upright.solid, camera, truth,
                                        plain ? Background::kPlain : Background::kBlotchy);
    const Rendering visible = renderEdges(upright.solid, camera, truth);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      Case attempt = caseOf(upright.solid, camera, picture, truth, 100 * seed + 7);
      const FinishedRun finished(attempt);
      const Workspace& end = finished.workspace;
      const bool accepted = end.status == LocalizationStatus::kConverged;
      const double error_px = errorOf_px(upright, camera, truth, end.camera_from_station);
      Count& count = counts[kind];
      const double edges_px = edgeMotion_px(visible.edges, end.camera_from_station);
      const double square = accepted ? normalizedSquare(end, truth) : 0.0;
      const bool correct =
          error_px < kCorrect_px || (edges_px < kCorrectEdges_px && square < kLargestSquare);
      ++(!accepted ? count.refused : correct ? count.correct : count.wrong);
      std::printf(
          "%3d %-10s %-7s yaw %6.1f pitch %5.1f seed %d: %s, %.2f px, edges %.2f px, square %.1f, "
          "p %.3f%s\n",
          scene, kKinds[kind], plain ? "plain" : "blotchy", yaw_deg, pitch_deg,
          static_cast<int>(seed), localizationStatusText(end.status), error_px, edges_px, square,
          end.probability, accepted && !correct ? " WRONG" : "");
      if (!lists || (accepted && correct)) continue;
      for (const PoseHypothesis& hypothesis : end.hypotheses) {
        const PoseEvidence& evidence = hypothesis.evidence;
        std::printf(
            "      origin %d %8.2f px edges %5.2f px turn %.2f deg score %.3f p %.3f total %.1f "
            "support %.3f share %.2f region "
            "%.2f\n",
            static_cast<int>(hypothesis.origin),
            errorOf_px(upright, camera, truth, hypothesis.camera_from_station),
            edgeMotion_px(visible.edges, hypothesis.camera_from_station),
            poseError(upright.solid, truth, hypothesis.camera_from_station).angle_rad / kDegree_rad,
            hypothesis.score, hypothesis.probability, evidence.total_nats(), evidence.edge_support,
            evidence.finest().shareOfExpected(), evidence.region.nats);
      }
      Case from_truth = attempt;
      from_truth.seed = truth;
      from_truth.uncertainty.translation_m.setConstant(0.0005);
      from_truth.uncertainty.rotation_rad.setConstant(0.002);
      const FinishedRun near(from_truth);
      const PoseEvidence& at = near.workspace.evidence;
      std::printf(
          "      at truth: %s %.2f px score %.3f p %.3f total %.1f support %.3f share %.2f region "
          "%.2f\n",
          localizationStatusText(near.workspace.status),
          errorOf_px(upright, camera, truth, near.workspace.camera_from_station), at.score(),
          at.probability(), at.total_nats(), at.edge_support, at.finest().shareOfExpected(),
          at.region.nats);
      std::printf("      gap %.3f best %d competitor %d\n", end.gap, end.best_hypothesis,
                  end.competitor);
      for (const CompetingPose& pose : end.competing_poses)
        std::printf("      competing %.2f px margin %.1f%s\n",
                    errorOf_px(upright, camera, truth, pose.camera_from_station), pose.margin_nats,
                    pose.mirrored ? " mirrored" : "");
      std::fflush(stdout);
    }
  }
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
    std::printf("%-10s correct %3d refused %3d wrong %3d\n", kKinds[kind], counts[kind].correct,
                counts[kind].refused, counts[kind].wrong);
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  boresight::test::run(argc > 1 ? std::atoi(argv[1]) : 50,
                       argc > 2 && std::strcmp(argv[2], "hypotheses") == 0);
  return 0;
}
