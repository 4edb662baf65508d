// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/bench_localization.h"
#include "app/bench_matching.h"
#include "app/commands.h"
#include "core/base/sha256.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/session/session_maker.h"
#include "sessions/text/text_table.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

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
  command.add_option("--dataset", dataset, "dataset.json (without it the shipped examples)")
      ->type_name("FILE");
  command.add_option("--case", cases, "Cases to time (without it the first of each station)")
      ->type_name("ID");
  options.addTo(command);
  command.add_flag("--quick", quick, "Fewer repetitions and the smallest windows only");
  command.add_option("--json", json, "Writes the figures as JSON")->type_name("FILE");
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

std::vector<Kernels> availableKernels() {
  std::vector<Kernels> available;
  for (int set = 0; set < kKernelSets; ++set) {
    if (kernelsAvailable(static_cast<Kernels>(set))) available.push_back(static_cast<Kernels>(set));
  }
  return available;
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
  CLI::App* command = app.add_subcommand(
      "bench", "Times localizations and matching on this machine, stage by stage");
  auto arguments = std::make_shared<BenchArguments>();
  arguments->addTo(*command);
  command->callback([arguments, &exit_code] { exit_code = bench(*arguments); });
}

}  // namespace boresight::app
