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
constexpr double kMostSquare = 40.0;

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
  Solid solid{};
  Solid pictured{};    ///< the same, or the round object that the solid approximates
  bool round = false;  ///< a turn about its axis changes nothing
};

/// A mesh of 24 sides of a tube, whose corners lie on it.
void addTube(Upright& upright, double radius_m, double half_m, double albedo) {
  upright.solid.addCylinder(0, 0, radius_m, -half_m, half_m, albedo);
  constexpr int kSides = 240;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kSides; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kSides;
    outline.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad));
  }
  upright.pictured.addPrism(outline, -half_m, half_m, albedo);
  upright.round = true;
}

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
      const double depth_m = half(50, 120);
      const double height_m = half(50, 120);
      upright.solid.addBox(0, 0, side_m, depth_m, 0, -height_m, height_m, albedo);
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
      addTube(upright, half(20, 60), z_m, albedo);
      return upright;
    default:
      upright.solid.addBox(0, 0, 2 * x_m, 2 * x_m, 0, -0.5 * z_m, 0, albedo);
      upright.solid.addBox(0, 0, 1.4 * x_m, 1.5 * x_m, 0, 0, 0.25 * z_m, 0.8 * albedo);
      upright.solid.addBox(0.3 * x_m, 0, x_m, 0.8 * x_m, 0, 0.25 * z_m, 0.5 * z_m, albedo);
      break;
  }
  upright.pictured = upright.solid;
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

struct Scene {
  Upright upright;
  Camera camera = levelCamera();
  Pose truth;
  Picture picture;
  Rendering visible;  ///< the mesh's edges at the truth
};

/// The station's z axis upwards in the image; turned about it, and in every second scene tilted.
Pose uprightPose(Random& random) {
  Eigen::Matrix3d upwards;
  upwards << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  constexpr std::array kMostTurn_deg = {0.0, 3.0, 45.0};
  const double turn_deg = kMostTurn_deg[random.below(3)] * random.uniform(-1.0, 1.0);
  const double tilt_deg = random.below(2) == 0 ? 0.0 : random.uniform(-6.0, 6.0);
  Pose pose;
  pose.rotation = rotationExp(Eigen::Vector3d::UnitX() * (tilt_deg * kDegree_rad)) *
                  Eigen::Quaterniond(upwards) *
                  rotationExp(Eigen::Vector3d::UnitZ() * (turn_deg * kDegree_rad));
  pose.rotation.normalize();
  pose.translation_m.x() = random.uniform(-0.03, 0.03);
  pose.translation_m.y() = random.uniform(-0.02, 0.02);
  pose.translation_m.z() = random.uniform(0.45, 0.7);
  return pose;
}

Scene sceneOf(int number) {
  Random random(static_cast<std::uint64_t>(number) + 1);
  Scene scene;
  scene.upright = uprightOf(static_cast<std::size_t>(number) % kKinds.size(), random);
  scene.truth = uprightPose(random);
  const Background background = random.below(2) == 0 ? Background::kPlain : Background::kBlotchy;
  scene.picture = takePicture(scene.upright.pictured, scene.camera, scene.truth, background);
  scene.visible = renderEdges(scene.upright.solid, scene.camera, scene.truth);
  return scene;
}

void print(const char* what, const Pose& pose, const PoseEvidence& evidence, const Scene& scene) {
  std::printf("    %-10s %7.2f px, edges %6.2f px: score %.3f, p %.3f, total %.1f, support %.3f\n",
              what, errorOf_px(scene.upright, scene.camera, scene.truth, pose),
              edgeMotion_px(scene.visible.edges, pose), evidence.score(), evidence.probability(),
              evidence.total_nats(), evidence.edge_support);
}

/// The poses compared by a run, and what is measured where a run from the truth itself ends.
void printHypotheses(const Workspace& end, const Case& from_seed, const Scene& scene) {
  constexpr const char* kOrigins[] = {"candidate", "templates", "seed", "restart"};
  for (const PoseHypothesis& hypothesis : end.hypotheses)
    print(kOrigins[static_cast<std::size_t>(hypothesis.origin)], hypothesis.camera_from_station,
          hypothesis.evidence, scene);
  Case from_truth = from_seed;
  from_truth.seed = scene.truth;
  const FinishedRun run(from_truth);
  print("from truth", run.workspace.camera_from_station, run.workspace.evidence, scene);
}

void runFrom(const Case& from_seed, const Scene& scene, bool lists, Count& count) {
  const FinishedRun run(from_seed);
  const Workspace& end = run.workspace;
  const bool accepted = end.status == LocalizationStatus::kConverged;
  const double error_px =
      errorOf_px(scene.upright, scene.camera, scene.truth, end.camera_from_station);
  const double edges_px = edgeMotion_px(scene.visible.edges, end.camera_from_station);
  const bool correct = error_px < kCorrect_px || (edges_px < kCorrectEdges_px && accepted &&
                                                  normalizedSquare(end, scene.truth) < kMostSquare);
  ++(!accepted ? count.refused : correct ? count.correct : count.wrong);
  std::printf("%s, %.2f px, edges %.2f px, p %.3f%s\n", localizationStatusText(end.status),
              error_px, edges_px, end.probability, accepted && !correct ? ", wrong" : "");
  if (lists && !(accepted && correct)) printHypotheses(end, from_seed, scene);
}

void run(int scenes, bool lists) {
  std::array<Count, kKinds.size()> counts;
  for (int number = 0; number < scenes; ++number) {
    const Scene scene = sceneOf(number);
    const auto kind = static_cast<std::size_t>(number) % kKinds.size();
    for (const std::uint64_t seed : {107U, 207U}) {
      std::printf("%3d %-10s ", number, kKinds[kind]);
      runFrom(caseOf(scene.upright.solid, scene.camera, scene.picture, scene.truth, seed), scene,
              lists, counts[kind]);
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
