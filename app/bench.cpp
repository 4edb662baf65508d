// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "app/commands.h"
#include "core/base/sha256.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/run/runner.h"
#include "sessions/session/session_maker.h"
#include "sessions/text/text_table.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

/// Localizations of one kind of problem, one after the other.
struct LocalizationFigure {
  std::string name;
  Kernels kernels = Kernels::kPortable;
  int threads = 1;
  int width = 0, height = 0;
  int runs = 0;
  int converged = 0;
  sessions::StageSeconds mean_seconds = {};
  std::uint64_t arena_bytes = 0;
  std::string digest = {};  ///< of the first run

  double perSecond() const { return mean_seconds.total() > 0.0 ? 1.0 / mean_seconds.total() : 0.0; }
};

using Loaded = std::shared_ptr<const sessions::LoadedCase>;

/// The cases of these ids; without ids the first of each station. InputError.
std::vector<Loaded> readCases(const sessions::Dataset& dataset, std::vector<std::string> ids) {
  if (ids.empty()) {
    std::set<std::string> stations;
    for (const sessions::Case& dataset_case : dataset.cases)
      if (stations.insert(dataset_case.station).second) ids.push_back(dataset_case.id);
  }
  const sessions::Session session = sessions::makeSession(dataset, ids);
  std::vector<Loaded> cases;
  for (const std::string& id : ids) cases.push_back(sessions::loadCase(*session.findCase(id)));
  return cases;
}

/// The case from its own seed, `repetitions` times.
LocalizationFigure measureCase(const sessions::LoadedCase& loaded,
                               const LocalizerOptions& stated_options, int repetitions,
                               sessions::RunSettings settings) {
  const LocalizerOptions options =
      sessions::withFeatureSize(stated_options, loaded.source.feature_size_m);
  settings.level = sessions::RecordLevel::kSummary;
  const Camera& camera = loaded.source.camera;
  LocalizationFigure figure{loaded.source.id, settings.kernels, settings.threads,
                            camera.width,     camera.height,    repetitions};
  for (int i = 0; i < repetitions; ++i) {
    const auto trace = sessions::localize(loaded.problem(), options, settings);
    figure.mean_seconds += trace.seconds;
    figure.converged += trace.status == LocalizationStatus::kConverged ? 1 : 0;
    figure.arena_bytes = trace.arena_bytes;
    if (i == 0) figure.digest = trace.digest;
  }
  for (const auto& [name, part] : sessions::kStages) figure.mean_seconds.*part /= repetitions;
  return figure;
}

struct BenchArguments {
  std::string dataset;
  std::vector<std::string> cases;
  OptionArguments options;
  bool quick = false;
  std::string json;

  void addTo(CLI::App& command) {
    addFile(command, "--dataset", dataset, "dataset.json (without it the shipped examples)");
    addOption(command, "--case", "ID", cases,
              "Cases to time (without it the first of each station)");
    options.addTo(command);
    command.add_flag("--quick", quick, "Fewer repetitions");
    addFile(command, "--json", json, "Writes the figures as JSON");
  }
  /// Portable kernels, the best ones, and these on more threads.
  std::vector<sessions::RunSettings> settings() const {
    std::vector<sessions::RunSettings> run_settings(2, {.threads = 1});
    run_settings[0].kernels = Kernels::kPortable;
    for (const int threads : {2, 4, 8}) {
      if (quick || threads > static_cast<int>(std::thread::hardware_concurrency())) break;
      run_settings.emplace_back().threads = threads;
    }
    return run_settings;
  }
};

std::vector<LocalizationFigure> measure(const BenchArguments& arguments) {
  const sessions::Dataset dataset = sessions::readDataset(
      arguments.dataset.empty() ? sessions::examplesFolder() / "stations" / "dataset.json"
                                : std::filesystem::path(arguments.dataset));
  const LocalizerOptions options = arguments.options.read();
  const std::vector<Loaded> cases = readCases(dataset, arguments.cases);
  std::vector<LocalizationFigure> figures;
  for (const sessions::RunSettings& settings : arguments.settings())
    for (const Loaded& loaded : cases)
      figures.push_back(measureCase(*loaded, options, arguments.quick ? 1 : 5, settings));
  return figures;
}

std::string kernelNames() {
  std::string names;
  for (const Kernels kernels : availableKernels()) names += std::string(" ") + kernelsName(kernels);
  return names;
}

std::string milliseconds(double seconds) { return sessions::fixedText(1e3 * seconds, 1); }

void printFigures(const std::vector<LocalizationFigure>& figures) {
  std::cout << "digest with SHA instructions: " << (sha256Instructions() != nullptr ? "yes" : "no")
            << "\nkernels:" << kernelNames() << "\n\nlocalization, ms\n";
  sessions::TextTable runs({"case", "kernels", "threads", "size", "runs", "converged", "init",
                            "render", "match", "pose", "refine", "total", "per s", "arena kB",
                            "digest"});
  for (const LocalizationFigure& figure : figures) {
    const sessions::StageSeconds& s = figure.mean_seconds;
    runs.add({figure.name, kernelsName(figure.kernels), std::to_string(figure.threads),
              std::to_string(figure.width) + "x" + std::to_string(figure.height),
              std::to_string(figure.runs), std::to_string(figure.converged),
              milliseconds(s.initialization), milliseconds(s.rendering), milliseconds(s.matching),
              milliseconds(s.pose), milliseconds(s.refinement), milliseconds(s.total()),
              sessions::fixedText(figure.perSecond(), 1), std::to_string(figure.arena_bytes / 1000),
              figure.digest.substr(0, 16)});
  }
  std::cout << runs.text() << std::flush;
}

nlohmann::ordered_json toJson(const std::vector<LocalizationFigure>& figures) {
  nlohmann::ordered_json json = {{"format", "boresight-bench"},
                                 {"version", 1},
                                 {"whs", sessions::kVersion},
                                 {"sha_instructions", sha256Instructions() != nullptr}};
  json["localizations"] = nlohmann::ordered_json::array();
  for (const LocalizationFigure& figure : figures) {
    json["localizations"].push_back({{"name", figure.name},
                                     {"kernels", kernelsName(figure.kernels)},
                                     {"threads", figure.threads},
                                     {"width", figure.width},
                                     {"height", figure.height},
                                     {"runs", figure.runs},
                                     {"converged", figure.converged},
                                     {"mean_seconds", sessions::toJson(figure.mean_seconds)},
                                     {"per_second", figure.perSecond()},
                                     {"arena_bytes", figure.arena_bytes},
                                     {"digest", figure.digest}});
  }
  return json;
}

int bench(const BenchArguments& arguments) {
  requireWritable({arguments.json});
  arguments.options.noteUnlimited();
  const std::vector<LocalizationFigure> figures = measure(arguments);
  printFigures(figures);
  if (!arguments.json.empty()) sessions::writeJsonFile(arguments.json, toJson(figures));
  return kDone;
}

}  // namespace

void addBench(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "bench", "Times localizations on this machine, stage by stage", bench);
}

}  // namespace boresight::app
