// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "app/bop_arguments.h"
#include "app/commands.h"
#include "app/method_arguments.h"
#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_database.h"
#include "sessions/evaluation/summary.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_document.h"
#include "sessions/report/text_table.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

constexpr std::size_t kListedFailures = 40;

struct EvaluateArguments {
  DatasetArguments dataset;
  std::string out;
  std::string jsonl;
  std::string bop_csv;
  std::string mirror;
  OptionArguments options;
  MethodArguments method;
  sessions::BatchOptions batch;

  void addTo(CLI::App& command);
};

void EvaluateArguments::addTo(CLI::App& command) {
  command.add_option("--dataset", dataset.path, "dataset.json, or the folder of a BOP dataset")
      ->required()
      ->type_name("PATH");
  dataset.addTo(command);
  command.add_option("--case", batch.cases, "Only these cases")->type_name("ID");
  command.add_option("--tag", batch.tags, "Only cases with one of these tags")->type_name("T");
  command.add_option("--station", batch.stations, "Only cases of these stations")->type_name("S");
  method.addTo(command, true);
  addKernels(command, batch.kernels);
  options.addTo(command);
  command.add_option("--jobs", batch.jobs, "Runs at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str()
      ->type_name("N");
  addThreads(command, batch.threads);
  command
      .add_option("--reseed", batch.reseeds,
                  "Further seeds per case, uniform in the ellipsoids inscribed in its uncertainty")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command
      .add_option("--reseed-scale", batch.reseed_scale,
                  "Draws further seeds this many times as far; the declared uncertainty stays")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str()
      ->type_name("S");
  command
      .add_option("--mesh-of", batch.mesh_of,
                  "Deliberately wrong: this station's mesh for all others' cases; every completed "
                  "run counts as a gross false positive")
      ->type_name("STATION");
  command.add_option("--mirror", mirror, "Deliberately wrong: the mesh mirrored across this axis")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command.add_option("--out", out, "Results as an SQLite file")->required()->type_name("FILE");
  command.add_option("--jsonl", jsonl, "Results as JSON lines")->type_name("FILE");
  command
      .add_option("--bop-csv", bop_csv,
                  "Results of a BOP dataset as the challenge takes them (METHOD_SET-SPLIT.csv)")
      ->type_name("FILE");
}

volatile std::sig_atomic_t interrupted = 0;

void onInterrupt(int) { interrupted = 1; }

/// Turns an interrupt into a stop: what has been run is then still written.
class InterruptWatch {
 public:
  explicit InterruptWatch(const std::stop_source& source) {
    interrupted = 0;
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    thread_ = std::jthread([source](const std::stop_token& ended) {
      while (!ended.stop_requested()) {
        if (interrupted != 0) source.request_stop();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
  }
  ~InterruptWatch() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }

 private:
  std::jthread thread_;
};

/// A line that rewrites itself on a terminal, and bad inputs once each.
class Progress {
 public:
  void operator()(std::size_t done, std::size_t total, const sessions::RunResult& result) {
    completed_ += result.completed ? 1 : 0;
    if (result.inputFailed() && messages_.insert(result.message).second)
      std::cerr << (on_terminal_ ? "\r\033[K" : "") << result.message << std::endl;
    if (!on_terminal_) return;
    std::cerr << "\r\033[K" << done << " of " << total << " runs, " << completed_ << " completed";
    if (done == total) std::cerr << "\r\033[K";
    std::cerr.flush();
  }

 private:
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  std::size_t completed_ = 0;
  std::set<std::string> messages_;
};

sessions::BatchFacts factsOf(const EvaluateArguments& arguments, const sessions::Dataset& dataset,
                             bool whole) {
  const sessions::BatchOptions& batch = arguments.batch;
  const std::string profile = arguments.options.profileName();
  auto changed = sessions::changedOptions(batch.localizer, profileOptions(profile));
  for (auto& option : arguments.method.changedOptions(batch.method_setup.options))
    changed.push_back(std::move(option));
  return {{"version", sessions::kVersion},
          {"dataset", arguments.dataset.path},
          {"dataset_sha256", dataset.sha256},
          {"method", arguments.method.names()},
          {"profile", profile},
          {"options", sessions::toJson(changed).dump()},
          {"reseed", std::to_string(batch.reseeds)},
          {"reseed_scale", sessions::numberText(batch.reseed_scale)},
          {"mesh_of", batch.mesh_of},
          {"mirror", arguments.mirror},
          {"complete", whole ? "1" : "0"}};
}

void writeLines(const std::string& file, const std::vector<sessions::RunResult>& results) {
  std::string text;
  for (const sessions::RunResult& result : results) text += sessions::toJson(result).dump() + "\n";
  sessions::writeFileAtomically(file, text);
}

/// Before the work rather than after it.
void requireOneMethodOfBop(const EvaluateArguments& arguments, const sessions::Dataset& dataset) {
  if (arguments.method.methods.size() != 1)
    throw CLI::ValidationError("--bop-csv", "holds the results of one method");
  (void)sessions::bopResults(dataset, {});
}

int evaluate(EvaluateArguments& arguments) {
  sessions::requireWritable(arguments.out);
  for (const std::string& file : {arguments.jsonl, arguments.bop_csv})
    if (!file.empty()) sessions::requireWritable(file);
  if (!arguments.mirror.empty())
    arguments.batch.mirror = static_cast<sessions::MirrorAxis>(arguments.mirror.front() - 'x');
  arguments.batch.localizer = arguments.options.read();
  arguments.batch.method_setup = arguments.method.setup(arguments.options);
  arguments.batch.memory_limit = arguments.options.memoryLimit();
  const sessions::Dataset dataset = arguments.dataset.open();
  if (!arguments.bop_csv.empty()) requireOneMethodOfBop(arguments, dataset);
  for (const std::string& line : dataset.notes) note(line);

  std::stop_source stop;
  std::vector<sessions::RunResult> results;
  {
    const InterruptWatch watch(stop);
    auto progress = std::make_shared<Progress>();
    for (const std::string& method : arguments.method.methods) {
      arguments.batch.method = method;
      std::vector<sessions::RunResult> made = sessions::runBatch(
          dataset, arguments.batch,
          [progress](std::size_t done, std::size_t total, const sessions::RunResult& result) {
            (*progress)(done, total, result);
          },
          stop.get_token());
      results.insert(results.end(), made.begin(), made.end());
    }
  }
  const bool whole = !stop.stop_requested();
  sessions::writeResultsDatabase(arguments.out, results, factsOf(arguments, dataset, whole));
  if (!arguments.jsonl.empty()) writeLines(arguments.jsonl, results);
  if (!arguments.bop_csv.empty())
    sessions::writeBopResults(arguments.bop_csv, sessions::bopResults(dataset, results));
  std::cout << sessions::summaryTable(results) << "\n"
            << sessions::toleranceTable(results) << "\n"
            << sessions::failureList(results, kListedFailures) << std::flush;
  if (!whole) note("interrupted: the results hold what had been run");
  for (const sessions::RunResult& result : results)
    if (result.inputFailed()) return kBadInput;
  return whole ? kDone : kInternalFault;
}

}  // namespace

void addEvaluate(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Localizes the cases of a dataset and sums up the errors");
  auto arguments = std::make_shared<EvaluateArguments>();
  arguments->addTo(*command);
  command->callback([arguments, &exit_code] { exit_code = evaluate(*arguments); });
}

}  // namespace boresight::app
