// SPDX-License-Identifier: Apache-2.0
// whs beside other programs, from the same seeds on the same images; peers.md says what came of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/config_file.h"
#include "sessions/io/errors.h"
#include "sessions/tables/results_set.h"
#include "tests/benchmarks/peers/peer_runs.h"

namespace boresight::peers {
namespace {

using sessions::PoseError;
using sessions::RunResult;

std::string groupOf(const RunResult& run, bool each_station) {
  if (run.hasTag("real") && !each_station) return "photographs";
  return run.station + (run.hasTag(sessions::kFarTag) ? ", far" : "") +
         (run.hasTag("hard") ? ", hard" : "");
}

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Large errors need no decimals.
std::string numberText(double value) {
  const double size = std::abs(value);
  return text(size >= 100.0  ? "%.0f"
              : size >= 10.0 ? "%.1f"
              : size >= 1.0  ? "%.2f"
                             : "%.3f",
              value);
}

std::string errorsText(const std::vector<const RunResult*>& runs,
                       std::optional<double> (*of)(const PoseError&)) {
  std::vector<double> values;
  for (const RunResult* run : runs)
    if (run->error)
      if (const auto value = of(*run->error)) values.push_back(*value);
  if (values.empty()) return "-";
  double mean = 0.0;
  double largest = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double square = 0.0;
  for (const double value : values) {
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
    largest = std::max(largest, std::abs(value));
  }
  return numberText(mean) + " / " + numberText(std::sqrt(square)) + " / " + numberText(largest);
}

std::optional<double> normal(const PoseError& error) { return error.normal_mm; }
std::optional<double> lateral(const PoseError& error) { return error.lateral_mm; }
std::optional<double> rotation(const PoseError& error) { return error.rotation_mrad; }
std::optional<double> projection(const PoseError& error) { return error.projection_px; }

std::string secondsText(const std::vector<const RunResult*>& runs) {
  std::vector<double> seconds;
  for (const RunResult* run : runs)
    if (run->status != "killed") seconds.push_back(run->seconds.total());
  if (seconds.empty()) return "-";
  std::sort(seconds.begin(), seconds.end());
  return text("%.2f", seconds[seconds.size() / 2]) + " / " + text("%.2f", seconds.back());
}

std::string row(const std::string& group, const std::string& method,
                const std::vector<const RunResult*>& runs) {
  std::vector<const RunResult*> completed;
  std::vector<const RunResult*> successful;
  int false_positives = 0;
  for (const RunResult* run : runs) {
    if (run->completed) completed.push_back(run);
    if (run->success.value_or(false)) successful.push_back(run);
    false_positives += run->false_positive ? 1 : 0;
  }
  std::string line = "| " + group + " | " + method + " | " + std::to_string(runs.size()) + " | " +
                     std::to_string(completed.size()) + " | " + std::to_string(successful.size()) +
                     " | " + std::to_string(false_positives) + " | ";
  for (const auto of : {normal, lateral, rotation, projection})
    line += errorsText(successful, of) + " | ";
  return line + errorsText(completed, projection) + " | " + secondsText(runs) + " |\n";
}

/// Markdown: what each method reached of each group of cases, whs last: completed, within the
/// requirement, false positives, errors (mean / standard deviation / max) of successful and of all
/// completed runs, and seconds. Photographs (tag "real") are one group unless `each_station`.
std::string peerTable(std::span<const RunResult> runs, bool each_station) {
  const auto before = [](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    return sessions::methodBefore(a.second, b.second);
  };
  std::map<std::pair<std::string, std::string>, std::vector<const RunResult*>, decltype(before)>
      groups(before);
  for (const RunResult& run : runs)
    if (!run.inputFailed()) groups[{groupOf(run, each_station), run.method}].push_back(&run);
  std::string table =
      "| cases | method | runs | completed | successful | false positives | normal mm | lateral mm "
      "| rotation mrad | projection px | projection px of all completed | seconds, median / max |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [key, members] : groups) table += row(key.first, key.second, members);
  return table;
}

struct Arguments {
  std::string dataset;
  std::string out;
  std::vector<std::string> methods;
  std::vector<std::string> assignments;
  sessions::BatchOptions plan;
  RunLimits limits;
  int first_seed = 0;
  std::vector<std::string> results;
  bool each_station = false;
};

std::map<std::string, double> assigned(const std::vector<std::string>& assignments) {
  std::map<std::string, double> values;
  for (const std::string& text : assignments) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw CLI::ValidationError("--set", "\"" + text + "\" is not NAME=NUMBER");
    try {
      values[text.substr(0, equals)] = std::stod(text.substr(equals + 1));
    } catch (const std::exception&) {
      throw CLI::ValidationError("--set", "\"" + text + "\" is not NAME=NUMBER");
    }
  }
  return values;
}

void requireSettings(const std::map<std::string, double>& values,
                     const std::vector<std::unique_ptr<Peer>>& peers) {
  for (const auto& value : values) {
    const std::string& name = value.first;  // a lambda cannot take a structured binding along
    const bool known = std::any_of(peers.begin(), peers.end(), [&](const auto& peer) {
      const auto& all = peer->settings().all();
      return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    });
    if (!known) throw CLI::ValidationError("--set", "no peer has a setting \"" + name + "\"");
  }
}

/// A method to run; null: whs.
using Method = std::pair<std::string, Peer*>;

std::vector<Method> chosenMethods(const std::vector<std::string>& names,
                                  const std::vector<std::unique_ptr<Peer>>& peers) {
  std::vector<Method> all = {{sessions::kWhs, nullptr}};
  for (const auto& peer : peers) all.emplace_back(peer->name(), peer.get());
  if (names.empty()) return all;
  std::vector<Method> chosen;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Method& one) { return one.first == name; });
    if (found == all.end())
      throw CLI::ValidationError("--method", "\"" + name + "\" is not built in: see `peers list`");
    chosen.push_back(*found);
  }
  return chosen;
}

int run(const Arguments& arguments) {
  const std::vector<std::unique_ptr<Peer>> peers = builtPeers();
  const std::map<std::string, double> values = assigned(arguments.assignments);
  requireSettings(values, peers);
  for (const auto& peer : peers) peer->settings().take(values);
  const std::vector<Method> methods = chosenMethods(arguments.methods, peers);
  const sessions::Dataset dataset = sessions::readDataset(arguments.dataset);
  std::vector<sessions::PlannedRun> plan = sessions::planBatch(dataset, arguments.plan);
  std::erase_if(plan, [&](const auto& one) { return one.reseed < arguments.first_seed; });

  sessions::ResultsWriter writer(arguments.out, sessions::datasetFacts(dataset));
  for (const auto& [name, peer] : methods) {
    sessions::MethodFacts facts =
        peer != nullptr
            ? peerFacts(*peer, arguments.limits)
            : sessions::methodFacts(name, "default", *sessions::profileOptions("default"));
    facts.reseed_scale = arguments.limits.reseed_scale;
    writer.admit(facts);
  }
  writer.begin(sessions::sittingHere());
  for (const sessions::PlannedRun& planned : plan)
    for (const auto& [name, peer] : methods) {
      if (writer.has(name, planned.input->id, planned.reseed)) continue;
      const sessions::RunResult result = runOne(dataset, planned, peer, arguments.limits);
      writer.add(result);
      std::cerr << result.case_id << " " << result.reseed << " " << name << ": " << result.status
                << (result.success.value_or(false) ? ", success" : "") << ", "
                << (result.error ? result.error->projection_px.value_or(-1.0) : -1.0) << " px, "
                << result.seconds.total() << " s. " << result.message << std::endl;
    }
  writer.end();
  return 0;
}

int table(const Arguments& arguments) {
  const sessions::ResultsSet set =
      sessions::readResultsSet({arguments.results.begin(), arguments.results.end()});
  std::cout << peerTable(set.runs, arguments.each_station);
  return 0;
}

int list() {
  std::cout << "whs\n";
  for (const auto& peer : builtPeers()) {
    std::cout << peer->name() << "  (" << peer->version() << ")\n";
    for (const Setting& setting : peer->settings().all())
      std::cout << "    " << setting.name << "=" << setting.value << "  " << setting.help << "\n";
  }
  return 0;
}

void addRun(CLI::App& app, Arguments& arguments) {
  CLI::App* command = app.add_subcommand("run", "Runs the cases of a dataset by each method");
  command->add_option("--dataset", arguments.dataset, "dataset.json")->required();
  command->add_option("--out", arguments.out, "Results file; one that is there is gone on with")
      ->required();
  command->add_option("--method", arguments.methods, "Only these");
  command->add_option("--case", arguments.plan.cases, "Only these cases");
  command->add_option("--station", arguments.plan.stations, "Only cases of these stations");
  command->add_option("--tag", arguments.plan.tags, "Only cases with one of these tags");
  command->add_option("--set", arguments.assignments, "NAME=NUMBER: a setting of a peer");
  command->add_option("--reseed", arguments.plan.reseeds, "Further seeds per case");
  command->add_option("--reseed-scale", arguments.limits.reseed_scale,
                      "Draws further seeds this many times as far");
  command->add_option("--first-seed", arguments.first_seed, "1 leaves the dataset's own seeds out");
  command->add_option("--limit", arguments.limits.seconds, "Seconds that a run may take");
}

int peersMain(int argc, char** argv) {
  CLI::App app("whs beside other programs that find poses, from the same seeds");
  app.require_subcommand(1);
  Arguments arguments;
  addRun(app, arguments);
  CLI::App* tables = app.add_subcommand("table", "Results as Markdown (`whs tables` has others)");
  tables->add_option("RESULTS", arguments.results, "Results files")->required();
  tables->add_flag("--each-station", arguments.each_station, "Photographs object by object");
  app.add_subcommand("list", "The peers that are built in, and their settings");
  try {
    app.parse(argc, argv);
    if (app.got_subcommand("run")) return run(arguments);
    return app.got_subcommand("table") ? table(arguments) : list();
  } catch (const CLI::Error& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 3;
  }
}

}  // namespace
}  // namespace boresight::peers

int main(int argc, char** argv) { return boresight::peers::peersMain(argc, argv); }
