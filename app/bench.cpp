// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <thread>

#include "app/commands.h"
#include "core/base/sha256.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/dataset_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_writer.h"
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
  sessions::StageSeconds mean_seconds;
  std::uint64_t arena_bytes = 0;
  std::string digest;  ///< of the first run

  double perSecond() const { return mean_seconds.total() > 0.0 ? 1.0 / mean_seconds.total() : 0.0; }
};

constexpr int kHouseholdWidth = 640;
constexpr int kHouseholdHeight = 480;

using Loaded = std::shared_ptr<const sessions::LoadedCase>;

/// The cases of these ids; without ids the first of each station. InputError.
std::vector<Loaded> readCases(const sessions::Dataset& dataset, std::vector<std::string> ids) {
  if (ids.empty()) {
    std::set<std::string> stations;
    for (const sessions::Case& one : dataset.cases)
      if (stations.insert(one.station).second) ids.push_back(one.id);
  }
  const sessions::Session session = sessions::makeSession(dataset, ids);
  std::vector<Loaded> cases;
  for (const std::string& id : ids) cases.push_back(sessions::loadCase(*session.findCase(id)));
  return cases;
}

void noteRun(const sessions::LoadedCase& loaded, LocalizerOptions options,
             const sessions::RunSettings& settings, LocalizationFigure& figure) {
  if (options.templates.feature_size_m == 0.0)
    options.templates.feature_size_m = loaded.source.feature_size_m.value_or(0.0);
  sessions::RunSettings summary = settings;
  summary.level = sessions::RecordLevel::kSummary;
  figure.name = loaded.source.id;
  figure.kernels = settings.kernels;
  figure.threads = settings.threads;
  figure.width = loaded.source.camera.width;
  figure.height = loaded.source.camera.height;
  const sessions::LocalizationTrace trace = sessions::localize(loaded.problem(), options, summary);
  figure.mean_seconds += trace.seconds;
  figure.converged += trace.status == LocalizationStatus::kConverged ? 1 : 0;
  figure.arena_bytes = trace.arena_bytes;
  if (figure.runs == 0) figure.digest = trace.digest;
  ++figure.runs;
}

void takeMean(LocalizationFigure& figure) {
  const double share = 1.0 / std::max(1, figure.runs);
  for (const auto& [name, part] : sessions::kStages) figure.mean_seconds.*part *= share;
}

/// Scales the image to the household camera's width and cuts off above and below what does not fit.
void bringToHouseholdSize(sessions::LoadedCase& loaded) {
  const double scale = static_cast<double>(kHouseholdWidth) / loaded.image.width;
  const int scaled_height = std::max(1, static_cast<int>(loaded.image.height * scale + 0.5));
  const cv::Mat pixels(loaded.image.height, loaded.image.width, CV_8U, loaded.image.pixels.data());
  cv::Mat scaled;
  cv::resize(pixels, scaled, cv::Size(kHouseholdWidth, scaled_height), 0, 0, cv::INTER_AREA);
  const int above = (scaled_height - kHouseholdHeight) / 2;
  cv::Mat fitted(kHouseholdHeight, kHouseholdWidth, CV_8U, cv::Scalar(0));
  const int rows = std::min(scaled_height, kHouseholdHeight);
  const int from = std::max(0, above);
  const int to = std::max(0, -above);
  scaled.rowRange(from, from + rows).copyTo(fitted.rowRange(to, to + rows));
  loaded.image.pixels.assign(fitted.data, fitted.data + fitted.total());
  loaded.image.width = kHouseholdWidth;
  loaded.image.height = kHouseholdHeight;

  Camera& camera = loaded.source.camera;
  camera.width = kHouseholdWidth;
  camera.height = kHouseholdHeight;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5 - above;
  if (prepareCamera(camera) != Status::kOk)
    throw sessions::InputError("bench", "camera", "cannot be brought to 640 x 480");
}

/// The case from its own seed, `repetitions` times.
LocalizationFigure measureCase(const sessions::LoadedCase& loaded, const LocalizerOptions& options,
                               int repetitions, const sessions::RunSettings& settings) {
  LocalizationFigure figure;
  for (int i = 0; i < repetitions; ++i) noteRun(loaded, options, settings, figure);
  takeMean(figure);
  return figure;
}

/// The same scene as a household camera sees it: the image brought to 640 x 480, from `seeds` seeds
/// up to 3 cm and 10 deg from the truth, which the case must have. InputError.
LocalizationFigure measureHouseholdScale(const sessions::LoadedCase& given,
                                         const LocalizerOptions& options, int seeds) {
  sessions::LoadedCase loaded;
  loaded.source = given.source;
  loaded.image = given.image;
  loaded.scene = given.scene;
  sessions::SessionCase& one = loaded.source;
  bringToHouseholdSize(loaded);
  one.uncertainty = {Eigen::Vector3d::Constant(0.03), Eigen::Vector3d::Constant(10.0),
                     sessions::UncertaintyPivot::kStation};
  const Eigen::Vector3d centre_in_station_m = matchedBounds(loaded.scene.view()).centre();
  LocalizationFigure figure;
  for (int seed = 1; seed <= seeds; ++seed) {
    one.camera_from_station_seed = sessions::seedForOffset(
        *one.camera_from_station_truth, sessions::drawOffset(one.uncertainty, 1.0, one.id, seed),
        one.uncertainty.pivot, centre_in_station_m);
    noteRun(loaded, options, {}, figure);
  }
  figure.name += " at household scale";
  takeMean(figure);
  return figure;
}

struct BenchArguments {
  std::string dataset;
  std::vector<std::string> cases;
  OptionArguments options;
  bool quick = false;
  std::string json;

  void addTo(CLI::App& command);
  /// Portable kernels, the best ones, and these on more threads.
  std::vector<sessions::RunSettings> settings() const;
};

std::vector<sessions::RunSettings> BenchArguments::settings() const {
  std::vector<sessions::RunSettings> made(2, {.threads = 1});
  made[0].kernels = Kernels::kPortable;
  for (const int threads : {2, 4, 8}) {
    if (quick || threads > static_cast<int>(std::thread::hardware_concurrency())) break;
    made.emplace_back().threads = threads;
  }
  return made;
}

void BenchArguments::addTo(CLI::App& command) {
  addFile(command, "--dataset", dataset, "dataset.json (without it the shipped examples)");
  command.add_option("--case", cases, "Cases to time (without it the first of each station)")
      ->type_name("ID");
  options.addTo(command);
  command.add_flag("--quick", quick, "Fewer repetitions");
  addFile(command, "--json", json, "Writes the figures as JSON");
}

std::vector<LocalizationFigure> measure(const BenchArguments& arguments) {
  const sessions::Dataset dataset = sessions::readDataset(
      arguments.dataset.empty() ? sessions::examplesFolder() / "stations" / "dataset.json"
                                : std::filesystem::path(arguments.dataset));
  const LocalizerOptions options = arguments.options.read();
  const std::vector<Loaded> cases = readCases(dataset, arguments.cases);
  std::vector<LocalizationFigure> figures;
  for (const sessions::RunSettings& settings : arguments.settings())
    for (const Loaded& one : cases)
      figures.push_back(measureCase(*one, options, arguments.quick ? 1 : 5, settings));
  for (const Loaded& one : cases)
    if (one->source.camera_from_station_truth)
      figures.push_back(measureHouseholdScale(*one, options, arguments.quick ? 2 : 20));
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
  for (const LocalizationFigure& one : figures) {
    const sessions::StageSeconds& s = one.mean_seconds;
    runs.add({one.name, kernelsName(one.kernels), std::to_string(one.threads),
              std::to_string(one.width) + "x" + std::to_string(one.height),
              std::to_string(one.runs), std::to_string(one.converged),
              milliseconds(s.initialization), milliseconds(s.rendering), milliseconds(s.matching),
              milliseconds(s.pose), milliseconds(s.refinement), milliseconds(s.total()),
              sessions::fixedText(one.perSecond(), 1), std::to_string(one.arena_bytes / 1000),
              one.digest.substr(0, 16)});
  }
  std::cout << runs.text() << std::flush;
}

nlohmann::ordered_json toJson(const std::vector<LocalizationFigure>& figures) {
  nlohmann::ordered_json json = {{"format", "boresight-bench"},
                                 {"version", 1},
                                 {"whs", sessions::kVersion},
                                 {"sha_instructions", sha256Instructions() != nullptr}};
  json["localizations"] = nlohmann::ordered_json::array();
  for (const LocalizationFigure& one : figures) {
    json["localizations"].push_back({{"name", one.name},
                                     {"kernels", kernelsName(one.kernels)},
                                     {"threads", one.threads},
                                     {"width", one.width},
                                     {"height", one.height},
                                     {"runs", one.runs},
                                     {"converged", one.converged},
                                     {"mean_seconds", sessions::toJson(one.mean_seconds)},
                                     {"per_second", one.perSecond()},
                                     {"arena_bytes", one.arena_bytes},
                                     {"digest", one.digest}});
  }
  return json;
}

int bench(const BenchArguments& arguments) {
  if (!arguments.json.empty()) sessions::requireWritable(arguments.json);
  const std::vector<LocalizationFigure> figures = measure(arguments);
  printFigures(figures);
  if (!arguments.json.empty()) sessions::writeJsonFile(arguments.json, toJson(figures));
  return kDone;
}

}  // namespace

void addBench(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "bench", "Times localizations on this machine, stage by stage", bench);
  arguments->addTo(*command);
}

}  // namespace boresight::app
