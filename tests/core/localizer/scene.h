// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/kernels.h"
#include "core/base/math.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/localizer.h"
#include "core/localizer/problem.h"
#include "core/render/edge_render.h"

namespace boresight::test {

/// A mesh that owns its memory; every face has a gray of its own for the picture.
struct Solid {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<double> albedo_of_face;
  std::vector<ScenePart> parts{ScenePart()};

  MeshView view() const { return {vertices, faces, part_of_face, parts}; }
  /// An upright prism from z = bottom_m to top_m over a convex outline, counter-clockwise from
  /// above.
  void addPrism(const std::vector<Eigen::Vector2d>& outline_m, double bottom_m, double top_m,
                double albedo, int part = 0);
  void addBox(double x_m, double y_m, double half_x_m, double half_y_m, double turn_rad,
              double bottom_m, double top_m, double albedo, int part = 0);
  void addCylinder(double x_m, double y_m, double radius_m, double bottom_m, double top_m,
                   double albedo, int part = 0);
};

/// A plate of 16 x 13 cm with boxes, a triangular and a hexagonal prism and cylinders of different
/// heights; without any symmetry. Its outside is towards +z.
Solid stationMesh();
/// The station with a bar floating above it, part 1, which occludes and is not matched.
Solid occludedStationMesh();
/// Mirrored across the plane of constant x through its middle.
Solid mirroredSolid(Solid solid);

Camera pinholeCamera();       ///< 512 x 512
Camera brownConradyCamera();  ///< 512 x 512
/// The station's z axis towards the camera, then tilted so that walls are seen.
Pose tiltedPose(const Eigen::Vector3d& tilt_rad, const Eigen::Vector3d& translation_m);
Pose truthPose();  ///< the station at 0.45 m, tilted

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> gray;
  ImageView view() const { return {gray.data(), width, height, width}; }
};

enum class Background { kBlotchy, kPlain };

/// The camera's picture: nine rays a pixel, shaded by a lamp at the side, in front of a background,
/// blurred 3 x 3, with a little noise.
Picture takePicture(const Solid& solid, const Camera& camera, const Pose& camera_from_station,
                    Background background = Background::kBlotchy);
/// The same by casting each ray on its own, from its own origin: independent of the renderer.
Picture takePictureByRays(const Solid& solid, const Camera& camera,
                          const Pose& camera_from_station);
Picture noisePicture(int width, int height, std::uint64_t seed);
Picture flatPicture(int width, int height, std::uint8_t gray);
/// The picture with a 64th of its contrast: equalized, it still shows the test edges, but its
/// gradients are too weak for a refinement.
Picture faintened(Picture picture);

/// A render with all its memory.
struct Rendering {
  std::vector<std::byte> memory;
  MeshAdjacency adjacency;
  EdgeRender edges;
};
Rendering renderEdges(const Solid& solid, const Camera& camera, const Pose& camera_from_station);

/// An owned bit image.
struct Mask {
  std::vector<std::byte> memory;
  BitImage bits;
  Mask(int width, int height);
  void fill(int x_begin, int y_begin, int x_end, int y_end);
};

/// +-20 mm and +-4 deg about the station's centre.
SeedUncertainty uncertaintyAbout(const Solid& solid, const Pose& camera_from_station);
/// Uniform inside `share` of the uncertainty box: (rotation rad, translation m).
Vector6d offsetWithin(const SeedUncertainty& uncertainty, double share, std::uint64_t seed);
/// A pose displaced by such an offset.
Pose displacedSeed(const Pose& truth, const SeedUncertainty& uncertainty, double share,
                   std::uint64_t seed);

/// All data of a run that a problem points to. The picture is shared: it takes longest to compute.
struct Case {
  Solid solid;
  Camera camera;
  const Picture* picture = nullptr;
  Pose truth;
  Pose seed;
  SeedUncertainty uncertainty;
  Eigen::Vector3d end_effector_in_camera_m = {0.01, -0.02, 0.3};
  const BitImage* ignore = nullptr;

  LocalizationProblem problem() const;
};
/// The solid in the picture that a camera took from the truth; the seed is displaced from it.
Case caseOf(Solid solid, const Camera& camera, const Picture& picture, const Pose& truth,
            std::uint64_t seed);
/// The station before the pinhole camera (or another one), seeded by `seed`.
Case stationCase(std::uint64_t seed, bool distorted = false);
Case occludedCase(std::uint64_t seed);
/// The seed becomes the truth turned about the camera's axis; any such turn is stated.
void turnAboutTheCamera(Case& scene, double turn_rad);

/// The default profile from the seed alone, without a search before.
LocalizerOptions withoutSearch();

using Digest = std::array<std::uint8_t, 32>;

std::vector<std::byte> blockFor(const LocalizationProblem& problem, const LocalizerOptions& options,
                                int workers = 1);

/// A run in a block of its own, sized by requiredBytes.
struct OwnedRun {
  std::vector<std::byte> memory;
  Localizer localizer;
  const Workspace& workspace = localizer.workspace();

  OwnedRun(const LocalizationProblem& problem, const LocalizerOptions& options, int workers = 1);
  OwnedRun(const OwnedRun&) = delete;
  /// Steps to the end.
  void finish();
  /// The same; `each` gets the report of every step.
  template <class Each>
  void finish(const Each& each) {
    constexpr int kMostSteps = 2000000;
    for (int steps = 0; steps < kMostSteps; ++steps) {
      const StepReport report = localizer.step();
      each(report);
      if (report.finished) return;
    }
    ADD_FAILURE() << "the run does not end";
  }
};
/// A run at its end; one that did not converge must have kept the seed.
struct FinishedRun : OwnedRun {
  explicit FinishedRun(const Case& scene, const LocalizerOptions& options = defaultProfile());
};
/// The status at the end of a run.
LocalizationStatus endOf(const Case& scene, const LocalizerOptions& options);

/// The digest of a run by one worker with the portable kernels.
Digest digestOf(const LocalizationProblem& problem, const LocalizerOptions& options);
/// The digest of a run with these kernels, its tasks shared by `workers` threads.
Digest sharedDigest(const LocalizationProblem& problem, const LocalizerOptions& options,
                    int workers, Kernels kernels = bestKernels());

/// Distance between the station's centre under two poses, and the angle between them.
struct PoseError {
  double centre_m = 0.0;
  double angle_rad = 0.0;
};
PoseError poseError(const Solid& solid, const Pose& truth, const Pose& estimate);
/// Converged and near the truth. Measured at the test station: 0.105 mm, a fifth of a pixel.
void expectTruth(const Case& scene, const Workspace& workspace, double limit_m = 0.00012,
                 double limit_rad = 0.06 * kDegree_rad);
/// Mean distance between the projections of the mesh's vertices.
double meanDisplacement_px(const Solid& solid, const Camera& camera, const Pose& truth,
                           const Pose& estimate);

}  // namespace boresight::test
