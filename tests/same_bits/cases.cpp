// SPDX-License-Identifier: Apache-2.0
// Writes the localizations that every build of the core must compute with the same bits: usage
// `same_bits_cases FOLDER`, or `same_bits_cases --largest FOLDER` for the one that fills a flight
// computer's memory. Each becomes a folder with what `whs localize` is given (arguments, one
// a line), what it says (digest, exit_code), and what the flight driver is given (problem.bin,
// image.pgm). Images are the examples' seen by other cameras, small enough for an emulator.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "core/base/math.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/files/atomic_file.h"
#include "tests/app/run_whs.h"
#include "tests/support/approach_files.h"
#include "tests/support/downlink_image.h"

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
  result << kDegree_rad * Eigen::Vector3d(rx_deg, ry_deg, rz_deg),
      1e-3 * Eigen::Vector3d(tx_mm, ty_mm, tz_mm);
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
  return {.name = "largest",
          .station = "bc",
          .camera = cameraOf(CameraModel::kBrownConrady, 2048, 2048, 3150.0,
                             {-0.12, 0.06, 4e-4, -3e-4, 0.0}),
          .seed_from_truth = offset(2.0, -1.5, 1.0, 10.0, -8.0, 6.0),
          .extra = {"--profile", "flight"},
          .triangles = 60000};
}

/// Puts a vertex into the middle of one triangle after the other: the same surface of at most
/// `triangles` triangles.
Solid splitTriangles(const sessions::SceneMesh& scene, std::size_t triangles) {
  Solid split;
  split.vertices = scene.vertices_in_station_m;
  split.faces = scene.faces;
  for (std::size_t i = 0; split.faces.size() + 2 <= triangles; ++i) {
    const auto [a, b, c] = split.faces[i].vertex;
    const auto middle = static_cast<std::int32_t>(split.vertices.size());
    const auto at = [&](std::int32_t vertex) {
      return split.vertices[static_cast<std::size_t>(vertex)];
    };
    split.vertices.emplace_back((at(a) + at(b) + at(c)) / 3.0f);
    split.faces[i] = {{a, b, middle}};
    split.faces.push_back({{b, c, middle}});
    split.faces.push_back({{c, a, middle}});
  }
  return split;
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
  ProgramRun run = runWhs(with({command}, arguments));
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
  mustRun("problem",
          with(arguments, {"--out", folder / "problem.bin", "--image-out", folder / "image.pgm"}));
  std::string lines;
  for (const std::string& argument : arguments) lines += (lines.empty() ? "" : "\n") + argument;
  writeText(folder / "arguments", lines);
  writeText(folder / "exit_code", std::to_string(run.exit_code));
  writeText(folder / "digest", run.out.substr(at + 7, 64));  // last: the folder is whole
  return run.exit_code == 0;
}

bool writeCase(const SameBitsCase& same_bits_case, const fs::path& folder) {
  fs::create_directories(folder);
  const ExampleCase example(same_bits_case.station);
  fs::path mesh = exampleFolder() / same_bits_case.station / "model.ply";
  if (same_bits_case.triangles > 0) {
    mesh = folder / "model.ply";
    sessions::writeFileAtomically(mesh,
                                  plyOf(splitTriangles(example.scene, same_bits_case.triangles)));
  }
  sessions::writeCamera(folder / "camera.json", {same_bits_case.camera});
  std::vector<std::uint8_t> pixels;
  for (const std::uint16_t sample : seenBy(same_bits_case.camera, example))
    pixels.push_back(static_cast<std::uint8_t>(std::lround(sample * 255.0 / 4095.0)));
  sessions::writePng(folder / "image.png", pixels, same_bits_case.camera.width,
                     same_bits_case.camera.height, 1);
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
  sessions::writeCamera(folder / "camera.json", {dataset.cameraOf(*dataset_case)});
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
