// SPDX-License-Identifier: Apache-2.0
// Whether a refined pose's covariance is what its errors are: runs the cases of a dataset and
// prints mean normalized squared errors per station (1 per axis and 6 together
// when the covariance is right).
//
//   normalized_errors DATASET [TAG | -TAG ...]   only cases with every TAG and without any -TAG
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/run/problem.h"
#include "sessions/run/runner.h"

namespace boresight::test {
namespace {

/// Errors of one station's converged runs, in units of their one sigma.
struct Sums {
  int runs = 0;
  std::vector<double> together;
  Vector6d axes = Vector6d::Zero();

  void add(const Vector6d& error, const Matrix6d& covariance) {
    ++runs;
    together.push_back(error.dot(covariance.ldlt().solve(error)));
    axes += error.cwiseAbs2().cwiseQuotient(covariance.diagonal());
  }
};

bool isAsked(const sessions::Case& dataset_case, const std::vector<std::string>& tags) {
  if (!dataset_case.truth_camera_from_station || !dataset_case.uncertainty) return false;
  return std::all_of(tags.begin(), tags.end(), [&dataset_case](const std::string& tag) {
    return tag[0] == '-' ? !dataset_case.hasTag(tag.substr(1)) : dataset_case.hasTag(tag);
  });
}

sessions::LocalizationTrace run(const sessions::Dataset& dataset,
                                const sessions::Case& dataset_case,
                                const sessions::SceneMesh& scene) {
  const sessions::GrayImage image = sessions::readCaseImage(dataset, dataset_case);
  const LocalizationProblem problem =
      sessions::problemOf(image, nullptr, dataset.cameraOf(dataset_case), scene.view(),
                          dataset_case.seed_camera_from_station, *dataset_case.uncertainty,
                          dataset_case.camera_from_end_effector);
  LocalizerOptions options = defaultProfile();
  const sessions::Station& station = dataset.stations.at(dataset_case.station);
  if (station.feature_size_m) options.templates.feature_size_m = *station.feature_size_m;
  return sessions::localize(problem, sessions::RunPlan(options), sessions::RecordLevel::kSummary);
}

void print(const std::map<std::string, Sums>& all) {
  std::puts(
      "| station | runs | together, mean (6) | median | about x | y | z | along x | y | z |\n"
      "|---|---|---|---|---|---|---|---|---|---|");
  for (const auto& [key, sums] : all) {
    std::vector<double> sorted = sums.together;
    std::sort(sorted.begin(), sorted.end());
    const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / sums.runs;
    std::printf("| %s | %d | %.1f | %.1f |", key.c_str(), sums.runs, mean,
                sorted[sorted.size() / 2]);
    for (const double square : sums.axes) std::printf(" %.2f |", square / sums.runs);
    std::puts("");
  }
}

int measure(const std::string& file, const std::vector<std::string>& tags) {
  const sessions::Dataset dataset = sessions::readDataset(file);
  std::map<std::string, sessions::SceneMesh> scenes;
  std::map<std::string, Sums> all;
  for (const sessions::Case& dataset_case : dataset.cases) {
    if (!isAsked(dataset_case, tags)) continue;
    if (!scenes.contains(dataset_case.station))
      scenes[dataset_case.station] =
          sessions::readScene(dataset.stations.at(dataset_case.station).parts);
    const sessions::LocalizationTrace trace =
        run(dataset, dataset_case, scenes[dataset_case.station]);
    if (trace.status != LocalizationStatus::kConverged) continue;
    all[dataset_case.station].add(
        perturbationBetween(trace.camera_from_station, *dataset_case.truth_camera_from_station),
        trace.covariance);
  }
  print(all);
  return 0;
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "normalized_errors DATASET [TAG | -TAG ...]\n";
    return 2;
  }
  try {
    return boresight::test::measure(argv[1], {argv + 2, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}
