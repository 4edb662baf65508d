// SPDX-License-Identifier: Apache-2.0
// How much a picture can suffer: runs cases of datasets on pictures made worse in stated ways
// (degrade.h) and prints what became of them per kind and strength.
//
//   degraded [--set NAME=VALUE ...] [--kind NAME ...] [--half 0|1] [--each N] [--wrong x|y|z|OTHER]
//            [--runs FILE] DATASET ...
//
// --half takes every other case, --each every N-th of these. --wrong mirrors the mesh, or takes
// another station's: then nothing should be completed. --runs appends a line per run.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/model_error.h"
#include "sessions/io/json/option_value.h"
#include "sessions/run/runner.h"
#include "tests/benchmarks/degraded/degrade.h"

namespace boresight::test {
namespace {

struct Arguments {
  LocalizerOptions options = defaultProfile();
  std::vector<std::string> kinds;
  std::vector<std::string> datasets;
  int half = -1;
  int each = 1;
  std::string wrong;
  std::string runs;
};

/// A kind of degradation and its strength.
using Degradation = std::pair<std::string, double>;

/// What became of the runs of one kind and strength.
struct Row {
  int runs = 0;
  int successes = 0;
  int wrong = 0;
  int gross = 0;
  std::map<std::string, int> refused;
  std::vector<double> errors_px;  ///< of the successful
};

using Scenes = std::map<std::string, sessions::SceneMesh>;

const sessions::SceneMesh& sceneOf(const sessions::Dataset& dataset, const std::string& station,
                                   Scenes& scenes) {
  if (!scenes.contains(station))
    scenes[station] = sessions::readScene(dataset.stations.at(station).parts);
  return scenes[station];
}

/// The mesh to look for: the case's own, mirrored, or another station's.
sessions::SceneMesh soughtScene(const sessions::Dataset& dataset,
                                const sessions::Case& dataset_case, const std::string& wrong,
                                Scenes& scenes) {
  if (wrong.size() == 1)
    return sessions::mirrored(sceneOf(dataset, dataset_case.station, scenes),
                              static_cast<sessions::MirrorAxis>(wrong[0] - 'x'));
  return sceneOf(dataset, wrong.empty() ? dataset_case.station : wrong, scenes);
}

sessions::RunResult judged(const sessions::Case& dataset_case, const Camera& camera, bool wrong,
                           const sessions::SceneMesh& scene, const sessions::Symmetries& symmetries,
                           const sessions::LocalizationTrace& trace) {
  sessions::RunResult result;
  result.case_id = dataset_case.id;
  result.station = dataset_case.station;
  result.requirement = dataset_case.requirement;
  sessions::noteTrace(trace, result);
  const std::vector<Eigen::Vector3f> vertices = sessions::matchedVertices(scene.view());
  result.error = sessions::wholeError(
      camera, *dataset_case.truth_camera_from_station, result.camera_from_station,
      dataset_case.camera_from_end_effector, {vertices, &symmetries});
  sessions::judge(wrong, result);
  return result;
}

std::uint64_t seedOf(const std::string& text) {
  std::uint64_t seed = 14695981039346656037ULL;  // FNV-1a
  for (const char letter : text)
    seed = (seed ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  return seed;
}

class Measurement {
 public:
  explicit Measurement(const Arguments& arguments) : arguments_(arguments) {
    if (!arguments.runs.empty()) runs_.open(arguments.runs, std::ios::app);
  }

  void measure(const std::string& file) {
    const sessions::Dataset dataset = sessions::readDataset(file);
    Scenes scenes;
    int place = 0;
    for (const sessions::Case& dataset_case : dataset.cases) {
      if (!dataset_case.truth_camera_from_station || !dataset_case.uncertainty ||
          dataset_case.station == arguments_.wrong)
        continue;
      const int number = place++;
      if (arguments_.half >= 0 && number % 2 != arguments_.half) continue;
      if ((arguments_.half >= 0 ? number / 2 : number) % arguments_.each != 0) continue;
      measure(dataset, dataset_case, scenes);
    }
  }

  void print() const {
    std::puts("| kind | strength | runs | success | false | of these gross | refused | error px |");
    std::puts("|---|---|---|---|---|---|---|---|");
    for (const DegradationKind& kind : degradationKinds()) {
      for (const double strength : kind.tried) {
        const auto found = rows_.find({kind.name, strength});
        if (found == rows_.end()) continue;
        const Row& row = found->second;
        std::string refused;
        for (const auto& [status, count] : row.refused)
          refused += (refused.empty() ? "" : ", ") + std::to_string(count) + " " + status;
        std::vector<double> errors = row.errors_px;
        std::sort(errors.begin(), errors.end());
        std::printf("| %s | %g %s | %d | %d | %d | %d | %s | %.2f |\n", kind.name.c_str(), strength,
                    kind.strength.c_str(), row.runs, row.successes, row.wrong, row.gross,
                    refused.c_str(), errors.empty() ? 0.0 : errors[errors.size() / 2]);
      }
    }
  }

 private:
  void measure(const sessions::Dataset& dataset, const sessions::Case& dataset_case,
               Scenes& scenes) {
    const sessions::GrayImage image = sessions::readCaseImage(dataset, dataset_case);
    const cv::Mat picture(image.height, image.width, CV_8U,
                          const_cast<std::uint8_t*>(image.pixels.data()));
    const cv::Mat object = silhouette(dataset.cameraOf(dataset_case),
                                      sceneOf(dataset, dataset_case.station, scenes).view(),
                                      *dataset_case.truth_camera_from_station);
    const sessions::SceneMesh sought = soughtScene(dataset, dataset_case, arguments_.wrong, scenes);
    for (const DegradationKind& kind : degradationKinds()) {
      if (!arguments_.kinds.empty() && std::find(arguments_.kinds.begin(), arguments_.kinds.end(),
                                                 kind.name) == arguments_.kinds.end())
        continue;
      for (const double strength : kind.tried) {
        cv::Mat worse = picture.clone();
        Random random(seedOf(dataset_case.id + kind.name));
        kind.apply(strength, object, random, worse);
        run(dataset, dataset_case, sought, {kind.name, strength}, worse);
      }
    }
  }

  void run(const sessions::Dataset& dataset, const sessions::Case& dataset_case,
           const sessions::SceneMesh& scene, const Degradation& what, const cv::Mat& picture) {
    const std::string& mesh_of =
        arguments_.wrong.size() > 1 ? arguments_.wrong : dataset_case.station;
    const sessions::Station& station = dataset.stations.at(mesh_of);
    LocalizationProblem problem;
    problem.image = {picture.data, picture.cols, picture.rows,
                     static_cast<std::ptrdiff_t>(picture.step)};
    problem.camera = dataset.cameraOf(dataset_case);
    problem.mesh = scene.view();
    problem.camera_from_station_seed = dataset_case.seed_camera_from_station;
    problem.uncertainty =
        sessions::seedUncertainty(*dataset_case.uncertainty, dataset_case.seed_camera_from_station,
                                  matchedBounds(scene.view()).centre());
    LocalizerOptions options = arguments_.options;
    if (station.feature_size_m) options.templates.feature_size_m = *station.feature_size_m;
    const sessions::LocalizationTrace trace =
        sessions::localize(problem, sessions::RunPlan(options), sessions::RecordLevel::kSummary);
    const sessions::RunResult result = judged(
        dataset_case, problem.camera, !arguments_.wrong.empty(), scene, station.symmetries, trace);
    note(result, what, trace, sessions::imageQualityOf(problem).value_or(sessions::ImageQuality{}));
  }

  void note(const sessions::RunResult& result, const Degradation& what,
            const sessions::LocalizationTrace& trace, const sessions::ImageQuality& quality) {
    Row& row = rows_[what];
    ++row.runs;
    const bool success = result.success.value_or(false);
    if (success) row.errors_px.push_back(result.error->projection_px.value_or(0.0));
    row.successes += success ? 1 : 0;
    row.wrong += result.false_positive ? 1 : 0;
    row.gross += result.gross_false_positive ? 1 : 0;
    if (!result.completed) ++row.refused[result.status];
    if (!runs_.is_open()) return;
    const EdgeSupport& support = trace.support;
    const auto& [kind, strength] = what;
    runs_ << result.case_id << '\t' << kind << '\t' << strength << '\t' << arguments_.wrong << '\t'
          << result.status << '\t' << success << '\t' << result.false_positive << '\t'
          << result.gross_false_positive << '\t' << result.error->projection_px.value_or(-1.0)
          << '\t' << result.error->normal_mm << '\t' << result.error->lateral_mm << '\t'
          << result.error->rotation_mrad << '\t' << result.edge_support << '\t'
          << support.coverage() << '\t' << support.chanceCoverage() << '\t' << support.explanation()
          << '\t' << support.chanceExplanation() << '\t' << trace.attempts << '\t' << result.digest
          << '\t' << trace.probability;
    for (const auto& [name, part] : sessions::kImageQualityParts) runs_ << '\t' << quality.*part;
    runs_ << std::endl;
  }

  const Arguments& arguments_;
  std::ofstream runs_;
  std::map<Degradation, Row> rows_;
};

void setOption(const std::string& assignment, LocalizerOptions& options) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) throw std::invalid_argument("--set needs NAME=VALUE");
  sessions::applyOptionText(options, assignment.substr(0, equals),
                            std::string_view(assignment).substr(equals + 1));
}

Arguments read(const std::vector<std::string>& words) {
  Arguments read;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& name = words[i];
    if (!name.starts_with("--")) {
      read.datasets.push_back(name);
      continue;
    }
    if (name == "--help")
      throw std::invalid_argument(
          "usage: degraded DATASET ... [--kind KIND] [--half 0|1] [--each N] [--wrong WHICH] "
          "[--runs FILE] [--set NAME=VALUE]");
    if (i + 1 == words.size()) throw std::invalid_argument(name + " needs a value");
    const std::string& value = words[++i];
    if (name == "--set")
      setOption(value, read.options);
    else if (name == "--kind")
      read.kinds.push_back(value);
    else if (name == "--half")
      read.half = std::stoi(value);
    else if (name == "--each")
      read.each = std::max(1, std::stoi(value));
    else if (name == "--wrong")
      read.wrong = value;
    else if (name == "--runs")
      read.runs = value;
    else
      throw std::invalid_argument("unknown argument " + name);
  }
  if (read.datasets.empty()) throw std::invalid_argument("which dataset?");
  return read;
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  try {
    const boresight::test::Arguments arguments = boresight::test::read({argv + 1, argv + argc});
    boresight::test::Measurement measurement(arguments);
    for (const std::string& file : arguments.datasets) measurement.measure(file);
    measurement.print();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
