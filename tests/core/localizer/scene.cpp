// SPDX-License-Identifier: Apache-2.0
#include "tests/core/localizer/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/kernels.h"
#include "core/base/random.h"

namespace boresight::test {
namespace {

constexpr int kSubpixels = 3;  ///< rays a pixel, per axis
constexpr int kMaxSteps = 2000000;

/// The same camera with pixels of a third the size.
Camera finerCamera(const Camera& camera) {
  Camera finer = camera;
  finer.width *= kSubpixels;
  finer.height *= kSubpixels;
  finer.fx *= kSubpixels;
  finer.fy *= kSubpixels;
  finer.cahv.skew_px *= kSubpixels;
  finer.cx = (camera.cx + 0.5) * kSubpixels - 0.5;
  finer.cy = (camera.cy + 0.5) * kSubpixels - 0.5;
  EXPECT_EQ(prepareCamera(finer), Status::kOk);
  return finer;
}

struct Surfaces {
  explicit Surfaces(std::size_t pixels) : face(pixels, -1), intensity(pixels), normal(pixels) {}
  std::vector<std::int32_t> face;
  std::vector<std::uint8_t> intensity;
  std::vector<Eigen::Vector3f> normal;
};

Rendering render(const Solid& solid, const Camera& camera, const Pose& camera_from_station,
                 Surfaces* surfaces) {
  Rendering out;
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  out.memory.resize((std::size_t{6} << 20) + 2 * pixels);
  Arena arena(out.memory);
  EXPECT_EQ(buildAdjacency(solid.view(), arena, out.adjacency), Status::kOk);
  RayGrid rays;
  EXPECT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
  const RenderOptions options;
  out.edges = createEdgeRender(camera.width, camera.height, options, arena);
  EdgeRenderer renderer;
  EXPECT_EQ(
      renderer.create(solid.view(), out.adjacency, camera.width, camera.height, options, arena),
      Status::kOk);
  SurfaceRender wanted;
  if (surfaces != nullptr) {
    wanted.face = surfaces->face;
    wanted.intensity = surfaces->intensity;
    wanted.normal_in_camera = surfaces->normal;
  }
  EXPECT_EQ(renderer.begin(rays, camera_from_station, out.edges, wanted), Status::kOk);
  bool done = false;
  for (int i = 0; i < kMaxSteps && !done; ++i) EXPECT_EQ(renderer.step(done), Status::kOk);
  return out;
}

double hashed(int x, int y, std::uint32_t salt) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^
                    static_cast<std::uint32_t>(y) * 0x85EBCA77u ^ salt * 0xC2B2AE3Du;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  h ^= h >> 15;
  return h * (1.0 / 4294967296.0);
}

/// Value noise in [0, 1]: random grays on a lattice, bilinear between them.
double blotch(double x, double y, double spacing_px, std::uint32_t salt) {
  const double u = x / spacing_px;
  const double v = y / spacing_px;
  const int ix = static_cast<int>(std::floor(u));
  const int iy = static_cast<int>(std::floor(v));
  const double fx = u - ix;
  const double fy = v - iy;
  const double top = hashed(ix, iy, salt) * (1 - fx) + hashed(ix + 1, iy, salt) * fx;
  const double bottom = hashed(ix, iy + 1, salt) * (1 - fx) + hashed(ix + 1, iy + 1, salt) * fx;
  return top * (1 - fy) + bottom * fy;
}

double grayOf(Background background, double x, double y) {
  if (background == Background::kPlain) return 40.0;
  return 35.0 + 70.0 * blotch(x, y, 37.0, 1) + 45.0 * blotch(x, y, 11.0, 2);
}

/// Mean gray of each pixel over its rays.
std::vector<double> expose(const Solid& solid, const Camera& finer, const Surfaces& surfaces,
                           Background background = Background::kBlotchy) {
  const int width = finer.width / kSubpixels;
  const int height = finer.height / kSubpixels;
  const Eigen::Vector3d lamp = Eigen::Vector3d(-0.45, -0.6, -0.66).normalized();
  std::vector<double> gray(static_cast<std::size_t>(width * height), 0.0);
  for (int y = 0; y < finer.height; ++y) {
    for (int x = 0; x < finer.width; ++x) {
      const auto i = static_cast<std::size_t>(y * finer.width + x);
      double value = 0.0;
      if (surfaces.face[i] < 0) {
        value = grayOf(background, (x + 0.5) / kSubpixels, (y + 0.5) / kSubpixels);
      } else {
        const double cosine = std::max(0.0, surfaces.normal[i].cast<double>().dot(lamp));
        const double lit = 0.35 * surfaces.intensity[i] + 150.0 * cosine;
        value = lit * solid.albedo_of_face[static_cast<std::size_t>(surfaces.face[i])];
      }
      gray[static_cast<std::size_t>((y / kSubpixels) * width + x / kSubpixels)] +=
          value / (kSubpixels * kSubpixels);
    }
  }
  return gray;
}

Picture develop(const std::vector<double>& gray, int width, int height) {
  Picture picture{width, height, std::vector<std::uint8_t>(gray.size())};
  constexpr double kWeights[3] = {0.15, 0.7, 0.15};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) {
          const int px = std::clamp(x + u, 0, width - 1);
          const int py = std::clamp(y + v, 0, height - 1);
          sum +=
              kWeights[u + 1] * kWeights[v + 1] * gray[static_cast<std::size_t>(py * width + px)];
        }
      }
      sum += 4.0 * (hashed(x, y, 3) + hashed(x, y, 4) - 1.0);
      picture.gray[static_cast<std::size_t>(y * width + x)] =
          static_cast<std::uint8_t>(std::clamp(sum + 0.5, 0.0, 255.0));
    }
  }
  return picture;
}

}  // namespace

void Solid::addPrism(const std::vector<Eigen::Vector2d>& outline_m, double bottom_m, double top_m,
                     double albedo, int part) {
  const auto first = static_cast<std::int32_t>(vertices.size());
  const auto count = static_cast<std::int32_t>(outline_m.size());
  for (const Eigen::Vector2d& corner : outline_m) {
    vertices.push_back(Eigen::Vector3d(corner.x(), corner.y(), bottom_m).cast<float>());
    vertices.push_back(Eigen::Vector3d(corner.x(), corner.y(), top_m).cast<float>());
  }
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    faces.push_back(Face{{first + a, first + b, first + c}});
    part_of_face.push_back(static_cast<std::uint16_t>(part));
    albedo_of_face.push_back(albedo);
  };
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t a = 2 * i;
    const std::int32_t b = 2 * ((i + 1) % count);
    add(a, b, b + 1);
    add(a, b + 1, a + 1);
  }
  for (std::int32_t i = 1; i + 1 < count; ++i) {
    add(1, 2 * i + 1, 2 * i + 3);
    add(0, 2 * i + 2, 2 * i);
  }
}

void Solid::addBox(double x_m, double y_m, double half_x_m, double half_y_m, double turn_rad,
                   double bottom_m, double top_m, double albedo, int part) {
  std::vector<Eigen::Vector2d> outline;
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  for (const auto& [u, v] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    outline.emplace_back(x_m + c * u * half_x_m - s * v * half_y_m,
                         y_m + s * u * half_x_m + c * v * half_y_m);
  }
  addPrism(outline, bottom_m, top_m, albedo, part);
}

void Solid::addCylinder(double x_m, double y_m, double radius_m, double bottom_m, double top_m,
                        double albedo, int part) {
  constexpr int kSides = 24;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * M_PI * i / kSides;
    outline.emplace_back(x_m + radius_m * std::cos(angle), y_m + radius_m * std::sin(angle));
  }
  addPrism(outline, bottom_m, top_m, albedo, part);
}

Solid stationMesh() {
  Solid solid;
  solid.addBox(0.0, 0.0, 0.080, 0.065, 0.0, -0.008, 0.0, 0.62);
  solid.addBox(-0.050, -0.035, 0.014, 0.010, 0.3, 0.0, 0.030, 0.95);
  solid.addBox(0.045, -0.030, 0.010, 0.022, -0.2, 0.0, 0.018, 0.85);
  solid.addBox(-0.012, 0.038, 0.024, 0.008, 0.1, 0.0, 0.042, 1.0);
  solid.addBox(0.060, 0.040, 0.009, 0.009, 0.7, 0.0, 0.012, 0.35);
  solid.addPrism({{-0.005, -0.050}, {0.020, -0.045}, {0.002, -0.020}}, 0.0, 0.024, 0.9);
  solid.addPrism({{-0.070, 0.030},
                  {-0.060, 0.022},
                  {-0.048, 0.026},
                  {-0.046, 0.038},
                  {-0.056, 0.048},
                  {-0.068, 0.044}},
                 0.0, 0.015, 0.3);
  solid.addCylinder(0.026, 0.012, 0.012, 0.0, 0.035, 1.0);
  solid.addCylinder(-0.026, -0.002, 0.009, 0.0, 0.020, 0.4);
  solid.addCylinder(0.064, 0.004, 0.006, 0.0, 0.028, 0.9);
  return solid;
}

Solid occludedStationMesh() {
  Solid solid = stationMesh();
  solid.parts.push_back(ScenePart());
  solid.parts[1].match = false;
  solid.addBox(-0.030, 0.005, 0.090, 0.009, 0.55, 0.090, 0.100, 0.8, 1);
  return solid;
}

Solid mirroredSolid(Solid solid) {
  const auto twice_middle_m = static_cast<float>(2.0 * matchedBounds(solid.view()).centre().x());
  for (Eigen::Vector3f& vertex : solid.vertices) vertex.x() = twice_middle_m - vertex.x();
  for (Face& face : solid.faces) std::swap(face.vertex[1], face.vertex[2]);
  return solid;
}

Camera pinholeCamera() {
  Camera camera;
  camera.width = camera.height = 512;
  camera.fx = 900.0;
  camera.fy = 905.0;
  camera.cx = 252.3;
  camera.cy = 258.1;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Camera brownConradyCamera() {
  Camera camera = pinholeCamera();
  camera.model = CameraModel::kBrownConrady;
  camera.distortion = {-0.25, 0.08, 0.0006, -0.0004, 0.01, 0.0, 0.0, 0.0};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

Pose tiltedPose(const Eigen::Vector3d& tilt_rad, const Eigen::Vector3d& translation_m) {
  const Pose facing{Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), Eigen::Vector3d::Zero()};
  const Pose tilt{rotationExp(tilt_rad), Eigen::Vector3d::Zero()};
  return {(tilt * facing).rotation, translation_m};
}

Pose truthPose() { return tiltedPose({0.42, -0.28, 0.15}, {0.004, -0.003, 0.45}); }

Picture takePicture(const Solid& solid, const Camera& camera, const Pose& camera_from_station,
                    Background background) {
  const Camera finer = finerCamera(camera);
  Surfaces surfaces(static_cast<std::size_t>(finer.width * finer.height));
  render(solid, finer, camera_from_station, &surfaces);
  return develop(expose(solid, finer, surfaces, background), camera.width, camera.height);
}

namespace {

/// Everything about the nearest of the faces that a ray has met.
struct Hit {
  double depth_m = 1e300;
  std::int32_t face = -1;
};

using Corners = std::array<Eigen::Vector3d, 3>;

Corners cornersInCamera(const Solid& solid, std::size_t face, const Pose& camera_from_station) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = static_cast<std::size_t>(solid.faces[face].vertex[i]);
    corners[i] = camera_from_station * solid.vertices[vertex].cast<double>();
  }
  return corners;
}

/// Depth at which a ray meets a triangle; negative where it does not (Moeller and Trumbore).
double meet(const Ray& ray, const Corners& corner) {
  const Eigen::Vector3d ab = corner[1] - corner[0];
  const Eigen::Vector3d ac = corner[2] - corner[0];
  const Eigen::Vector3d p = ray.direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0.0) return -1.0;
  const Eigen::Vector3d from = ray.origin_m - corner[0];
  const double u = from.dot(p) / determinant;
  const Eigen::Vector3d q = from.cross(ab);
  const double v = ray.direction.dot(q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 ? ac.dot(q) / determinant : -1.0;
}

}  // namespace

Picture takePictureByRays(const Solid& solid, const Camera& camera,
                          const Pose& camera_from_station) {
  const Camera finer = finerCamera(camera);
  const auto count = static_cast<std::size_t>(finer.width * finer.height);
  std::vector<Ray> rays(count);
  for (int y = 0; y < finer.height; ++y)
    for (int x = 0; x < finer.width; ++x)
      EXPECT_TRUE(unprojectRay(finer, {x, y}, rays[static_cast<std::size_t>(y * finer.width + x)]));
  std::vector<Hit> hits(count);
  for (std::size_t face = 0; face < solid.faces.size(); ++face) {
    const Corners corners = cornersInCamera(solid, face, camera_from_station);
    Eigen::Vector2d low(1e9, 1e9);
    Eigen::Vector2d high(-1e9, -1e9);
    for (const Eigen::Vector3d& corner : corners) {
      Eigen::Vector2d pixel;
      EXPECT_TRUE(project(finer, corner, pixel));
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
    const double bend_px = 6.0 + 0.12 * (high - low).norm();  // lines are curves in the image
    const auto limited = [](double value, int most) {
      return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
    };
    for (int y = limited(low.y() - bend_px, finer.height);
         y < limited(high.y() + bend_px, finer.height); ++y) {
      for (int x = limited(low.x() - bend_px, finer.width);
           x < limited(high.x() + bend_px, finer.width); ++x) {
        const auto i = static_cast<std::size_t>(y * finer.width + x);
        const double depth_m = meet(rays[i], corners);
        if (depth_m > 0.0 && depth_m < hits[i].depth_m)
          hits[i] = {depth_m, static_cast<std::int32_t>(face)};
      }
    }
  }
  Surfaces surfaces(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (hits[i].face < 0) continue;
    const auto face = static_cast<std::size_t>(hits[i].face);
    const Corners corner = cornersInCamera(solid, face, camera_from_station);
    Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const double cosine = -normal.dot(rays[i].direction.normalized());
    if (cosine < 0.0) normal = -normal;
    surfaces.face[i] = hits[i].face;
    surfaces.intensity[i] = static_cast<std::uint8_t>(30.5 + 224.0 * std::abs(cosine));
    surfaces.normal[i] = normal.cast<float>();
  }
  return develop(expose(solid, finer, surfaces), camera.width, camera.height);
}

Picture noisePicture(int width, int height, std::uint64_t seed) {
  Picture picture{width, height, {}};
  Random random(seed);
  for (int i = 0; i < width * height; ++i)
    picture.gray.push_back(static_cast<std::uint8_t>(random.below(256)));
  return picture;
}

Picture flatPicture(int width, int height, std::uint8_t gray) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), gray)};
}

Picture faintened(Picture picture) {
  for (std::uint8_t& gray : picture.gray) gray = static_cast<std::uint8_t>(100 + gray / 64);
  return picture;
}

Rendering renderEdges(const Solid& solid, const Camera& camera, const Pose& camera_from_station) {
  return render(solid, camera, camera_from_station, nullptr);
}

Mask::Mask(int width, int height)
    : memory(static_cast<std::size_t>(BitImage::wordsPerRow(width) * height) * 8 + 64) {
  Arena arena(memory);
  bits = BitImage::create(arena, width, height);
}

void Mask::fill(int x_begin, int y_begin, int x_end, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) bits.set(x, y);
  }
}

SeedUncertainty uncertaintyAbout(const Solid& solid, const Pose& camera_from_station) {
  SeedUncertainty uncertainty;
  uncertainty.translation_m.setConstant(0.02);
  uncertainty.rotation_rad.setConstant(0.07);
  uncertainty.pivot_in_camera_m = camera_from_station * matchedBounds(solid.view()).centre();
  return uncertainty;
}

Vector6d offsetWithin(const SeedUncertainty& uncertainty, double share, std::uint64_t seed) {
  Random random(seed);
  Vector6d offset;
  for (int i = 0; i < 6; ++i) {
    const double limit = i < 3 ? uncertainty.rotation_rad[i] : uncertainty.translation_m[i - 3];
    offset[i] = random.uniform(-share, share) * limit;
  }
  return offset;
}

Pose displacedSeed(const Pose& truth, const SeedUncertainty& uncertainty, double share,
                   std::uint64_t seed) {
  return displacedAboutPivot(truth, offsetWithin(uncertainty, share, seed),
                             uncertainty.pivot_in_camera_m);
}

LocalizationProblem Case::problem() const {
  LocalizationProblem problem;
  problem.image = picture->view();
  problem.ignore = ignore;
  problem.camera = camera;
  problem.mesh = solid.view();
  problem.camera_from_station_seed = seed;
  problem.uncertainty = uncertainty;
  problem.end_effector_in_camera_m = end_effector_in_camera_m;
  return problem;
}

Case caseOf(Solid solid, const Camera& camera, const Picture& picture, const Pose& truth,
            std::uint64_t seed) {
  Case scene;
  scene.solid = std::move(solid);
  scene.camera = camera;
  scene.picture = &picture;
  scene.truth = truth;
  scene.seed = displacedSeed(truth, uncertaintyAbout(scene.solid, truth), 0.8, seed);
  scene.uncertainty = uncertaintyAbout(scene.solid, scene.seed);
  return scene;
}

Case stationCase(std::uint64_t seed, bool distorted) {
  const auto shown = [seed](const Camera& camera, const Picture& picture) {
    return caseOf(stationMesh(), camera, picture, truthPose(), seed);
  };
  if (distorted) {
    static const Picture picture = takePicture(stationMesh(), brownConradyCamera(), truthPose());
    return shown(brownConradyCamera(), picture);
  }
  static const Picture picture = takePicture(stationMesh(), pinholeCamera(), truthPose());
  return shown(pinholeCamera(), picture);
}

Case occludedCase(std::uint64_t seed) {
  static const Picture picture = takePicture(occludedStationMesh(), pinholeCamera(), truthPose());
  return caseOf(occludedStationMesh(), pinholeCamera(), picture, truthPose(), seed);
}

void turnAboutTheCamera(Case& scene, double turn_rad) {
  const Eigen::Quaterniond turn = rotationExp({0.0, 0.0, turn_rad});
  scene.seed.rotation = (turn * scene.truth.rotation).normalized();
  scene.seed.translation_m = turn * scene.truth.translation_m;
  scene.uncertainty.pivot_in_camera_m.setZero();
  scene.uncertainty.rotation_rad.z() = kPi;
}

LocalizerOptions withoutSearch() {
  LocalizerOptions options = defaultProfile();
  options.search.enabled = false;
  return options;
}

std::vector<std::byte> blockFor(const LocalizationProblem& problem, const LocalizerOptions& options,
                                int workers) {
  std::size_t bytes = 0;
  EXPECT_EQ(requiredBytes(sizeOf(problem), options, workers, bytes), Status::kOk);
  return std::vector<std::byte>(bytes);
}

OwnedRun::OwnedRun(const LocalizationProblem& problem, const LocalizerOptions& options, int workers)
    : memory(blockFor(problem, options, workers)), localizer(problem, options, memory, workers) {}

void OwnedRun::finish() {
  finish([](const StepReport&) {});
}

FinishedRun::FinishedRun(const Case& scene, const LocalizerOptions& options)
    : OwnedRun(scene.problem(), options) {
  EXPECT_EQ(localizer.status(), Status::kOk);
  finish();
  if (workspace.status == LocalizationStatus::kConverged) return;
  EXPECT_EQ(workspace.camera_from_station, scene.seed);
  EXPECT_EQ(workspace.covariance, Matrix6d::Zero().eval());
}

LocalizationStatus endOf(const Case& scene, const LocalizerOptions& options) {
  return FinishedRun(scene, options).workspace.status;
}

Digest digestOf(const LocalizationProblem& problem, const LocalizerOptions& options) {
  OwnedRun run(problem, options);
  EXPECT_EQ(run.localizer.status(), Status::kOk);
  run.finish();
  return run.localizer.digest();
}

Digest sharedDigest(const LocalizationProblem& problem, const LocalizerOptions& options,
                    int workers, Kernels kernels) {
  std::size_t bytes = 0;
  EXPECT_EQ(requiredBytes(sizeOf(problem), options, workers, bytes, kernels), Status::kOk);
  std::vector<std::byte> memory(bytes);
  Localizer shared(problem, options, memory, workers, kernels);
  do {
    const int tasks = shared.tasks();
    std::vector<std::jthread> threads;
    for (int worker = 0; worker < workers && tasks > 0; ++worker) {
      threads.emplace_back([&shared, tasks, worker, workers] {
        for (int task = worker; task < tasks; task += workers) shared.runTask(task, worker);
      });
    }
  } while (!shared.step().finished);
  return shared.digest();
}

PoseError poseError(const Solid& solid, const Pose& truth, const Pose& estimate) {
  const Eigen::Vector3d centre = matchedBounds(solid.view()).centre();
  const Eigen::Quaterniond turn = (truth.rotation.conjugate() * estimate.rotation).normalized();
  return {(truth * centre - estimate * centre).norm(), rotationLog(turn).norm()};
}

void expectTruth(const Case& scene, const Workspace& workspace, double limit_m, double limit_rad) {
  EXPECT_STREQ(localizationStatusText(workspace.status), "converged");
  const PoseError error = poseError(scene.solid, scene.truth, workspace.camera_from_station);
  EXPECT_LT(error.centre_m, limit_m);
  EXPECT_LT(error.angle_rad, limit_rad);
}

double meanDisplacement_px(const Solid& solid, const Camera& camera, const Pose& truth,
                           const Pose& estimate) {
  double sum_px = 0.0;
  for (const Eigen::Vector3f& vertex : solid.vertices) {
    const Eigen::Vector3d point = vertex.cast<double>();
    Eigen::Vector2d from_px;
    Eigen::Vector2d to_px;
    const bool projects =
        project(camera, truth * point, from_px) && project(camera, estimate * point, to_px);
    EXPECT_TRUE(projects);
    if (projects) sum_px += (to_px - from_px).norm();
  }
  return sum_px / static_cast<double>(solid.vertices.size());
}

}  // namespace boresight::test
