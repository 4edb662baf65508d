// SPDX-License-Identifier: Apache-2.0
// Datasets outside of the repository: the folder named by BORESIGHT_DATA holds some, each in a
// folder of its own with a dataset.json.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/datasets/dataset_file.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> datasetFiles() {
  std::vector<fs::path> files;
  const char* folder = std::getenv("BORESIGHT_DATA");
  if (folder == nullptr || !fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (fs::is_regular_file(entry.path() / "dataset.json"))
      files.push_back(entry.path() / "dataset.json");
  return files;
}

TEST(SampleData, DatasetsCanBeReadWholeAndTheirTruthsLieWithinTheSeedsUncertainty) {
  const std::vector<fs::path> files = datasetFiles();
  if (files.empty()) GTEST_SKIP() << "BORESIGHT_DATA names no folder with datasets";
  for (const fs::path& file : files) {
    const Dataset dataset = readDataset(file);
    EXPECT_FALSE(dataset.cases.empty()) << file;
    EXPECT_TRUE(dataset.notes.empty()) << dataset.notes.front();
    requireFiles(dataset);
    std::set<fs::path> seen;
    for (const Case& dataset_case : dataset.cases) {
      if (!seen.insert(dataset_case.image).second) continue;
      const GrayImage image = readCaseImage(dataset, dataset_case);
      EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width * image.height));
    }
    for (const auto& [id, station] : dataset.stations) {
      const SceneMesh scene = readScene(station.parts);
      EXPECT_EQ(validateMesh(scene.view()), Status::kOk) << id;
      const Eigen::Vector3d centre_m = matchedBounds(scene.view()).centre();
      for (const Case& dataset_case : dataset.cases) {
        if (dataset_case.station != id || !dataset_case.truth_camera_from_station ||
            !dataset_case.uncertainty)
          continue;
        const Pose& seed = dataset_case.seed_camera_from_station;
        EXPECT_EQ(scaleConcern(matchedBounds(scene.view()), seed), "") << dataset_case.id;
        const SeedUncertainty bounds = seedUncertainty(*dataset_case.uncertainty, seed, centre_m);
        const Vector6d offset = offsetAboutPivot(seed, *dataset_case.truth_camera_from_station,
                                                 bounds.pivot_in_camera_m);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_LE(std::abs(offset[axis]), bounds.rotation_rad[axis]) << dataset_case.id;
          EXPECT_LE(std::abs(offset[3 + axis]), bounds.translation_m[axis]) << dataset_case.id;
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::sessions
