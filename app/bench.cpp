// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "app/bench_matching.h"
#include "app/commands.h"
#include "core/base/sha256.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/dataset_file.h"
#include "sessions/io/errors.h"
#include "sessions/run/problem.h"
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

/// What a case's problem points into.
struct Loaded {
  sessions::GrayImage image;
  sessions::SceneMesh scene;
  Camera camera;
  Pose camera_from_station_seed;
  sessions::DeclaredUncertainty uncertainty;
  LocalizerOptions options;

  LocalizationProblem problem() const {
    return sessions::problemOf(image, nullptr, camera, scene.view(), camera_from_station_seed,
                               uncertainty);
  }
};

Loaded load(const sessions::Dataset& dataset, const sessions::Case& one,
            const LocalizerOptions& options) {
  Loaded loaded;
  const sessions::Station& station = dataset.stations.at(one.station);
  loaded.image = sessions::readCaseImage(dataset, one);
  loaded.scene = sessions::readStationScene(station);
  loaded.camera = dataset.cameras.at(one.camera);
  loaded.camera_from_station_seed = one.seed_camera_from_station;
  loaded.uncertainty = one.uncertainty.value_or(sessions::DeclaredUncertainty());
  loaded.options = options;
  if (options.templates.feature_size_m == 0.0 && station.feature_size_m)
    loaded.options.templates.feature_size_m = *station.feature_size_m;
  return loaded;
}

void noteRun(const Loaded& loaded, const sessions::RunSettings& settings,
             LocalizationFigure& figure) {
  sessions::RunSettings summary = settings;
  summary.level = sessions::RecordLevel::kSummary;
  figure.kernels = settings.kernels;
  figure.threads = settings.threads;
  const sessions::LocalizationTrace trace =
      sessions::localize(loaded.problem(), loaded.options, summary);
  figure.mean_seconds += trace.seconds;
  figure.converged += trace.status == LocalizationStatus::kConverged ? 1 : 0;
  figure.arena_bytes = trace.arena_bytes;
  if (figure.runs == 0) figure.digest = trace.digest;
  ++figure.runs;
}

void takeMean(LocalizationFigure& figure) {
  const double share = 1.0 / std::max(1, figure.runs);
  sessions::StageSeconds& seconds = figure.mean_seconds;
  for (double* each : {&seconds.initialization, &seconds.rendering, &seconds.matching,
                       &seconds.pose, &seconds.refinement}) {
    *each *= share;
  }
}

/// Scales to the household camera's size and cuts off above and below what does not fit.
void bringToHouseholdSize(Loaded& loaded) {
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

  Camera& camera = loaded.camera;
  camera.width = kHouseholdWidth;
  camera.height = kHouseholdHeight;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5 - above;
  if (prepareCamera(camera) != Status::kOk)
    throw sessions::InputError("bench", "camera", "cannot be brought to 640 x 480");
}

/// One case from its own seed, `repetitions` times, with the settings' kernels and threads.
/// InputError.
LocalizationFigure measureCase(const sessions::Dataset& dataset, const sessions::Case& one,
                               const LocalizerOptions& options, int repetitions,
                               const sessions::RunSettings& settings) {
  const Loaded loaded = load(dataset, one, options);
  LocalizationFigure figure;
  figure.name = one.id;
  figure.width = loaded.camera.width;
  figure.height = loaded.camera.height;
  for (int i = 0; i < repetitions; ++i) noteRun(loaded, settings, figure);
  takeMean(figure);
  return figure;
}

/// The same scene as a household camera sees it: the image brought to 640 x 480, from `seeds` seeds
/// up to 3 cm and 10 deg off. Needs the case's truth. InputError.
LocalizationFigure measureHouseholdScale(const sessions::Dataset& dataset,
                                         const sessions::Case& one, const LocalizerOptions& options,
                                         int seeds, const sessions::RunSettings& settings) {
  if (!one.truth_camera_from_station)
    throw sessions::InputError(dataset.file, "cases." + one.id + ".truth",
                               "seeds are drawn around the truth, and there is none");
  Loaded loaded = load(dataset, one, options);
  bringToHouseholdSize(loaded);
  loaded.uncertainty.translation_m = Eigen::Vector3d::Constant(0.03);
  loaded.uncertainty.rotation_deg = Eigen::Vector3d::Constant(10.0);
  loaded.uncertainty.pivot = sessions::UncertaintyPivot::kStation;
  LocalizationFigure figure;
  figure.name = one.id + " at household scale";
  figure.width = kHouseholdWidth;
  figure.height = kHouseholdHeight;
  const Eigen::Vector3d centre_in_station_m = matchedBounds(loaded.scene.view()).centre();
  for (int seed = 1; seed <= seeds; ++seed) {
    loaded.camera_from_station_seed = sessions::seedForOffset(
        *one.truth_camera_from_station, sessions::drawOffset(loaded.uncertainty, 1.0, one.id, seed),
        loaded.uncertainty.pivot, centre_in_station_m);
    noteRun(loaded, settings, figure);
  }
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
  command.add_flag("--quick", quick, "Fewer repetitions and the smallest windows only");
  addFile(command, "--json", json, "Writes the figures as JSON");
}

struct Figures {
  bool sha_instructions = sha256Instructions() != nullptr;
  std::vector<MatchingFigure> matching;
  std::vector<LocalizationFigure> localizations;
};

std::vector<const sessions::Case*> chosenCases(const sessions::Dataset& dataset,
                                               const std::vector<std::string>& ids) {
  std::vector<const sessions::Case*> chosen;
  for (const std::string& id : ids) {
    chosen.push_back(dataset.findCase(id));
    if (chosen.back() == nullptr)
      throw sessions::InputError(dataset.file, "cases", "there is no case \"" + id + "\"");
  }
  if (!ids.empty()) return chosen;
  for (const sessions::Case& one : dataset.cases) {
    const auto same_station = [&one](const sessions::Case* other) {
      return other->station == one.station;
    };
    if (std::none_of(chosen.begin(), chosen.end(), same_station)) chosen.push_back(&one);
  }
  return chosen;
}

Figures measure(const BenchArguments& arguments) {
  const sessions::Dataset dataset = sessions::readDataset(
      arguments.dataset.empty() ? sessions::examplesFolder() / "stations" / "dataset.json"
                                : std::filesystem::path(arguments.dataset));
  const LocalizerOptions options = arguments.options.read();
  const auto cases = chosenCases(dataset, arguments.cases);
  Figures figures;
  for (const sessions::RunSettings& settings : arguments.settings()) {
    for (const sessions::Case* one : cases)
      figures.localizations.push_back(
          measureCase(dataset, *one, options, arguments.quick ? 1 : 5, settings));
  }
  for (const sessions::Case* one : cases) {
    if (one->truth_camera_from_station)
      figures.localizations.push_back(
          measureHouseholdScale(dataset, *one, options, arguments.quick ? 2 : 20, {}));
  }
  figures.matching = measureMatching(arguments.quick ? 1 : 5, arguments.quick);
  return figures;
}

std::string kernelNames() {
  std::string names;
  for (const Kernels kernels : availableKernels()) names += std::string(" ") + kernelsName(kernels);
  return names;
}

std::string milliseconds(double seconds) { return sessions::fixedText(1e3 * seconds, 1); }

void printFigures(const Figures& figures) {
  std::cout << "digest with SHA instructions: " << (figures.sha_instructions ? "yes" : "no")
            << "\nkernels:" << kernelNames() << "\n\nlocalization, ms\n";
  sessions::TextTable runs({"case", "kernels", "threads", "size", "runs", "converged", "init",
                            "render", "match", "pose", "refine", "total", "per s", "arena kB",
                            "digest"});
  for (const LocalizationFigure& one : figures.localizations) {
    const sessions::StageSeconds& s = one.mean_seconds;
    runs.add({one.name, kernelsName(one.kernels), std::to_string(one.threads),
              std::to_string(one.width) + "x" + std::to_string(one.height),
              std::to_string(one.runs), std::to_string(one.converged),
              milliseconds(s.initialization), milliseconds(s.rendering), milliseconds(s.matching),
              milliseconds(s.pose), milliseconds(s.refinement), milliseconds(s.total()),
              sessions::fixedText(one.perSecond(), 1), std::to_string(one.arena_bytes / 1000),
              one.digest.substr(0, 16)});
  }
  std::cout << runs.text() << "\nmatching, one core, ms (NCC: OpenCV's matchTemplate)\n";
  std::vector<std::string> header = {"template", "window", "NCC"};
  for (const Kernels kernels : availableKernels()) {
    header.push_back(std::string("WHS ") + kernelsName(kernels));
    header.push_back("ratio");
  }
  sessions::TextTable matching(header);
  for (const MatchingFigure& one : figures.matching) {
    std::vector<std::string> row = {std::to_string(one.side_px), std::to_string(one.window_px),
                                    sessions::fixedText(one.ncc_ms, 3)};
    for (const Kernels kernels : availableKernels()) {
      const double whs_ms = one.whs_ms[static_cast<std::size_t>(kernels)];
      row.push_back(sessions::fixedText(whs_ms, 3));
      row.push_back(sessions::fixedText(one.ncc_ms / whs_ms, 1));
    }
    matching.add(row);
  }
  std::cout << matching.text() << "geometric mean of NCC's time over WHS's:";
  for (const Kernels kernels : availableKernels())
    std::cout << " " << kernelsName(kernels) << " "
              << sessions::fixedText(meanRatio(figures.matching, kernels), 1);
  std::cout << std::endl;
}

nlohmann::ordered_json toJson(const Figures& figures) {
  nlohmann::ordered_json json = {{"format", "boresight-bench"},
                                 {"version", 1},
                                 {"whs", sessions::kVersion},
                                 {"sha_instructions", figures.sha_instructions}};
  json["localizations"] = nlohmann::ordered_json::array();
  for (const LocalizationFigure& one : figures.localizations) {
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
  json["matching"] = nlohmann::ordered_json::array();
  for (const MatchingFigure& one : figures.matching) {
    nlohmann::ordered_json figure = {
        {"template_px", one.side_px}, {"window_px", one.window_px}, {"ncc_ms", one.ncc_ms}};
    for (const Kernels kernels : availableKernels())
      figure["whs_ms"][kernelsName(kernels)] = one.whs_ms[static_cast<std::size_t>(kernels)];
    json["matching"].push_back(figure);
  }
  for (const Kernels kernels : availableKernels())
    json["matching_mean_ratio"][kernelsName(kernels)] = meanRatio(figures.matching, kernels);
  return json;
}

int bench(const BenchArguments& arguments) {
  if (!arguments.json.empty()) sessions::requireWritable(arguments.json);
  const Figures figures = measure(arguments);
  printFigures(figures);
  if (!arguments.json.empty())
    sessions::writeFileAtomically(arguments.json, toJson(figures).dump(2) + "\n");
  return kDone;
}

}  // namespace

void addBench(CLI::App& app, int& exit_code) {
  const auto [command, arguments] =
      addCommand(app, exit_code, "bench",
                 "Times localizations and matching on this machine, stage by stage", bench);
  arguments->addTo(*command);
}

}  // namespace boresight::app
