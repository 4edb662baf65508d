// SPDX-License-Identifier: Apache-2.0
// Writes the localizations that every build of the core must compute with the same bits: usage
// `same_bits_cases FOLDER`, or `same_bits_cases --largest FOLDER` for the one that fills a flight
// computer's memory. Each becomes a folder with what `whs localize` is given (arguments, one
// a line), what it says (digest, exit_code), and what the flight driver is given (problem.bin,
// image.pgm). Images are the examples' seen by other cameras, small enough for an emulator.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "core/base/math.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/files/atomic_file.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;

struct SameBitsCase {
  std::string name;
  std::string station;
  Camera camera;
  Vector6d seed_from_truth = Vector6d::Zero();  ///< (rotation rad, translation m) about the camera
  Arguments extra = {};
  bool ignore = false;
  std::size_t triangles = 0;  ///< number of triangles after splitting; 0: not split
};

Camera cameraOf(CameraModel model, int width, int height, double focal_length_px,
                std::initializer_list<double> distortion = {}) {
  Camera camera;
  camera.model = model;
  camera.width = width;
  camera.height = height;
  camera.fx = focal_length_px;
  camera.fy = 1.01 * focal_length_px;
  camera.cx = 0.5 * width + 3.2;
  camera.cy = 0.5 * height - 2.7;
  std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
  if (prepareCamera(camera) != Status::kOk) throw std::logic_error("no camera");
  return camera;
}

Vector6d offset(double rx_deg, double ry_deg, double rz_deg, double tx_mm, double ty_mm,
                double tz_mm) {
  Vector6d result;
  result << rx_deg * kDegree_rad, ry_deg * kDegree_rad, rz_deg * kDegree_rad, tx_mm * 1e-3,
      ty_mm * 1e-3, tz_mm * 1e-3;
  return result;
}

std::vector<SameBitsCase> allCases() {
  using enum CameraModel;
  const Camera brown = cameraOf(kBrownConrady, 448, 448, 690.0, {-0.12, 0.06, 4e-4, -3e-4, 0.0});
  const Camera rational = cameraOf(kBrownConrady, 416, 400, 620.0,
                                   {0.08, -0.05, -2e-4, 3e-4, 0.01, 0.02, -0.01, 0.004});
  const Camera pinhole = cameraOf(kPinhole, 400, 432, 610.0);
  const Camera fisheye = cameraOf(kKannalaBrandt, 450, 400, 640.0, {0.03, -0.01, 0.004, 0.001});
  return {
      {"bc_brown_conrady", "bc", brown, offset(2.0, -1.5, 1.0, 10.0, -8.0, 6.0)},
      {"bc_pinhole", "bc", pinhole, offset(-1.0, 2.0, -3.0, -12.0, 5.0, -9.0)},
      {"bc_fisheye_paper",
       "bc",
       fisheye,
       offset(0.5, 0.5, -0.5, 4.0, 3.0, 5.0),
       {"--profile", "paper", "--set", "loop.max_iterations=3"}},
      {"os_rational", "os", rational, offset(1.0, 1.2, -0.8, 6.0, -5.0, 4.0)},
      {"os_fisheye",
       "os",
       fisheye,
       offset(-1.5, 0.5, 1.6, -7.0, 6.0, -8.0),
       {"--set", "pnp.seed=77", "--pivot", "station"}},
      {"os_pinhole_ignore", "os", pinhole, offset(0.7, -1.0, 0.9, 5.0, 7.0, -6.0), {}, true},
      {"os_not_converged",
       "os",
       brown,
       offset(1.0, 1.0, 1.0, 5.0, 5.0, 5.0),
       {"--set", "loop.max_iterations=1", "--set", "loop.max_attempts=2"}},
  };
}

/// The largest problem that a flight computer must hold.
SameBitsCase largestCase() {
  SameBitsCase largest;
  largest.name = "largest";
  largest.station = "bc";
  largest.camera =
      cameraOf(CameraModel::kBrownConrady, 2048, 2048, 3150.0, {-0.12, 0.06, 4e-4, -3e-4, 0.0});
  largest.seed_from_truth = offset(2.0, -1.5, 1.0, 10.0, -8.0, 6.0);
  largest.extra = {"--profile", "flight"};
  largest.triangles = 60000;
  return largest;
}

/// Puts a vertex into the middle of one triangle after the other: the same surface of at most
/// `triangles` triangles.
void splitTriangles(sessions::SceneMesh& scene, std::size_t triangles) {
  for (std::size_t i = 0; scene.faces.size() + 2 <= triangles; ++i) {
    const auto [a, b, c] = scene.faces[i].vertex;
    const auto middle = static_cast<std::int32_t>(scene.vertices_in_station_m.size());
    const auto at = [&](std::int32_t vertex) {
      return scene.vertices_in_station_m[static_cast<std::size_t>(vertex)];
    };
    scene.vertices_in_station_m.emplace_back((at(a) + at(b) + at(c)) / 3.0f);
    scene.faces[i] = {{a, b, middle}};
    scene.faces.push_back({{b, c, middle}});
    scene.faces.push_back({{c, a, middle}});
  }
}

void writePly(const fs::path& file, const sessions::SceneMesh& scene) {
  std::ostringstream text;
  text.precision(9);
  text << "ply\nformat ascii 1.0\nelement vertex " << scene.vertices_in_station_m.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << scene.faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3f& point : scene.vertices_in_station_m)
    text << point.x() << ' ' << point.y() << ' ' << point.z() << '\n';
  for (const Face& face : scene.faces)
    text << "3 " << face.vertex[0] << ' ' << face.vertex[1] << ' ' << face.vertex[2] << '\n';
  sessions::writeFileAtomically(file, text.str());
}

/// What `seen` would have looked like to `camera`: bilinear, 0 beyond its border.
std::vector<std::uint8_t> resample(const sessions::GrayImage& seen, const Camera& seen_by,
                                   const Camera& camera) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      Eigen::Vector2d at;
      double value = 0.0;
      if (unproject(camera, {x, y}, ray) && project(seen_by, ray, at) && at.minCoeff() >= 0.0 &&
          at.x() < seen.width - 1 && at.y() < seen.height - 1) {
        const int left = static_cast<int>(at.x());
        const int top = static_cast<int>(at.y());
        const double u = at.x() - left;
        const double v = at.y() - top;
        const auto pixel = [&](int dx, int dy) {
          return seen.view().at(left + dx, top + dy) * 1.0;
        };
        value = (1.0 - v) * ((1.0 - u) * pixel(0, 0) + u * pixel(1, 0)) +
                v * ((1.0 - u) * pixel(0, 1) + u * pixel(1, 1));
      }
      pixels.push_back(static_cast<std::uint8_t>(value + 0.5));
    }
  }
  return pixels;
}

/// A stripe across the image that is not trusted.
void writeMask(const fs::path& file, const Camera& camera) {
  std::vector<std::uint8_t> mask;
  for (int y = 0; y < camera.height; ++y)
    mask.insert(mask.end(), static_cast<std::size_t>(camera.width),
                y > camera.height / 3 && y < camera.height / 2 ? 255 : 0);
  sessions::writePng(file, mask, camera.width, camera.height, 1);
}

/// Throws unless whs ran to its end: converged, or not.
ProgramRun mustRun(const std::string& command, const Arguments& arguments) {
  Arguments all = {command};
  all.insert(all.end(), arguments.begin(), arguments.end());
  ProgramRun run = runWhs(all);
  if (run.exit_code != 0 && run.exit_code != 4)
    throw std::runtime_error("whs " + command + " ended with " + std::to_string(run.exit_code) +
                             ": " + run.err);
  return run;
}

void writeText(const fs::path& file, const std::string& text) {
  sessions::writeFileAtomically(file, text + "\n");
}

/// Runs whs both ways and keeps what the comparison needs. Whether the run converged.
bool writeExpectation(const fs::path& folder, const Arguments& arguments) {
  const ProgramRun run = mustRun("localize", arguments);
  const std::size_t at = run.out.rfind("digest ");
  if (at == std::string::npos) throw std::runtime_error("whs localize printed no digest");
  Arguments problem = arguments;
  for (const auto& [option, file] :
       {std::pair{"--out", "problem.bin"}, {"--image-out", "image.pgm"}}) {
    problem.emplace_back(option);
    problem.emplace_back(folder / file);
  }
  mustRun("problem", problem);
  std::string lines;
  for (const std::string& argument : arguments) lines += (lines.empty() ? "" : "\n") + argument;
  writeText(folder / "arguments", lines);
  writeText(folder / "exit_code", std::to_string(run.exit_code));
  writeText(folder / "digest", run.out.substr(at + 7, 64));  // last: the folder is whole
  return run.exit_code == 0;
}

bool writeCase(const SameBitsCase& same_bits_case, const fs::path& folder) {
  fs::create_directories(folder);
  ExampleCase example(same_bits_case.station);
  fs::path mesh = exampleFolder() / same_bits_case.station / "model.ply";
  if (same_bits_case.triangles > 0) {
    splitTriangles(example.scene, same_bits_case.triangles);
    mesh = folder / "model.ply";
    writePly(mesh, example.scene);
  }
  sessions::writeCamera(folder / "camera.json", same_bits_case.camera);
  sessions::writePng(folder / "image.png",
                     resample(example.image, example.camera, same_bits_case.camera),
                     same_bits_case.camera.width, same_bits_case.camera.height, 1);
  const Pose seed = displacedAboutPivot(example.truth.camera_from_station,
                                        same_bits_case.seed_from_truth, Eigen::Vector3d::Zero());
  sessions::writePose(folder / "seed.json", seed, example.seed.uncertainty);
  Arguments arguments = {"--image",        folder / "image.png",
                         "--camera",       folder / "camera.json",
                         "--mesh",         mesh,
                         "--mesh-unit",    "m",
                         "--seed",         folder / "seed.json",
                         "--feature-size", same_bits_case.station == "bc" ? "0.015" : "0.018"};
  if (same_bits_case.ignore) {
    writeMask(folder / "ignore.png", same_bits_case.camera);
    arguments.insert(arguments.end(), {"--ignore", folder / "ignore.png"});
  }
  arguments.insert(arguments.end(), same_bits_case.extra.begin(), same_bits_case.extra.end());
  return writeExpectation(folder, arguments);
}

/// A case of full size from the data that tests may be given.
bool writeDataCase(const std::string& id, const fs::path& data, const fs::path& folder) {
  fs::create_directories(folder);
  const sessions::Dataset dataset = sessions::readDataset(data / "synthetic" / "dataset.json");
  const sessions::Case* dataset_case = dataset.findCase(id);
  if (dataset_case == nullptr) throw std::runtime_error("the data has no case " + id);
  const sessions::Station& station = dataset.stations.at(dataset_case->station);
  const sessions::PartSource& part = station.parts.at(0);
  sessions::writeCamera(folder / "camera.json", dataset.cameras.at(dataset_case->camera));
  sessions::writePose(folder / "seed.json", dataset_case->seed_camera_from_station,
                      dataset_case->uncertainty);
  return writeExpectation(
      folder, {"--image", dataset_case->image, "--camera", folder / "camera.json", "--mesh",
               part.mesh, "--mesh-unit", part.mesh_unit, "--seed", folder / "seed.json",
               "--feature-size", std::to_string(station.feature_size_m.value_or(0.0))});
}

/// Cases are worth comparing when most of them go through every stage.
void writeAll(const fs::path& folder) {
  fs::remove_all(folder);
  int converged = 0;
  for (const SameBitsCase& same_bits_case : allCases()) {
    const bool done = writeCase(same_bits_case, folder / same_bits_case.name);
    converged += done ? 1 : 0;
    std::printf("%s: %s\n", same_bits_case.name.c_str(), done ? "converged" : "not converged");
  }
  if (converged < 5) throw std::runtime_error("fewer than five cases converge");
  const char* data = std::getenv("BORESIGHT_DATA");
  if (data == nullptr || std::getenv("BORESIGHT_ALL") == nullptr) {
    std::printf("no cases of full size: BORESIGHT_DATA and BORESIGHT_ALL are not both set\n");
    return;
  }
  for (const char* id : {"bc-000000", "os-000000"}) {
    const bool done = writeDataCase(id, data, folder / id);
    std::printf("%s: %s\n", id, done ? "converged" : "not converged");
  }
}

void writeLargest(const fs::path& folder) {
  const SameBitsCase same_bits_case = largestCase();
  fs::remove_all(folder);
  if (!writeCase(same_bits_case, folder / same_bits_case.name))
    throw std::runtime_error("the largest case does not converge");
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  const bool largest = argc == 3 && std::strcmp(argv[1], "--largest") == 0;
  if (argc != 2 && !largest) {
    std::fprintf(stderr, "usage: same_bits_cases [--largest] FOLDER\n");
    return 2;
  }
  try {
    if (largest) {
      boresight::test::writeLargest(argv[2]);
    } else {
      boresight::test::writeAll(argv[1]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "same_bits_cases: %s\n", error.what());
    return 1;
  }
  return 0;
}
