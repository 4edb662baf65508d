// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>
#include <thread>
#include <tuple>
#include <utility>

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_inputs.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/tables/method_tables.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

constexpr std::size_t kListedFailures = 40;

/// The two numbers of "2/8"; nothing unless 1 <= first <= second.
std::optional<std::pair<int, int>> shardNumbers(const std::string& text) {
  int shard = 0;
  int shards = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%c", &shard, &shards, &rest) != 2 || shard < 1 ||
      shard > shards)
    return std::nullopt;
  return std::pair(shard, shards);
}

std::string shardProblem(const std::string& text) {
  return shardNumbers(text) ? std::string()
                            : "\"" + text + "\" is not I/N with I from 1 to N, e.g. 2/8";
}

struct EvaluateArguments {
  DatasetArguments dataset;
  std::string out, jsonl, bop_csv, mirror, shard;
  OptionArguments options;
  MethodArguments method;
  sessions::BatchOptions batch;

  void addTo(CLI::App& command) {
    addOption(command, "--dataset", "PATH", dataset.path,
              "dataset.json, or the folder of a BOP dataset")
        ->required();
    dataset.addTo(command);
    addOption(command, "--case", "ID", batch.cases, "Only these cases");
    addOption(command, "--tag", "T", batch.tags, "Only cases with one of these tags");
    addOption(command, "--station", "S", batch.stations, "Only cases of these stations");
    method.addTo(command, true);
    addKernels(command, batch.kernels);
    options.addTo(command);
    batch.jobs = 0;
    addOption(command, "--jobs", "N", batch.jobs, "Number of runs in parallel")
        ->check(CLI::Range(1, 256))
        ->default_str("one per core");
    addThreads(command, batch.threads);
    addOption(command, "--reseed", "N", batch.reseeds,
              "Number of further seeds per case, uniform in the ellipsoids inscribed in its "
              "uncertainty")
        ->check(CLI::Range(0, 1000000));
    addOption(command, "--reseed-scale", "S", batch.reseed_scale,
              "Factor on the errors of further seeds; the declared uncertainty does not change")
        ->check(numberIn(0.0, 1000.0))
        ->capture_default_str();
    addOption(command, "--mesh-of", "STATION", batch.mesh_of,
              "Negative test: uses this station's mesh for the cases of all others; a "
              "completed run is a gross false positive");
    addChoice(command, "--mirror", mirror, {"x", "y", "z"},
              "Negative test: mirrors the mesh across this axis");
    addOption(command, "--shard", "I/N", shard,
              "Runs share I of N of the cases, e.g. 2/8; `whs merge` joins the results")
        ->check(CLI::Validator(shardProblem, "I/N"));
    command.add_flag("--keep-matches", batch.keep_matches,
                     "Stores every template of every iteration in the results");
    addFile(command, "--out", out, "Results as an SQLite file; an existing file is continued")
        ->required();
    addFile(command, "--jsonl", jsonl, "Results as JSON lines");
    addFile(command, "--bop-csv", bop_csv,
            "Results of a BOP dataset in the challenge's format (METHOD_SET-SPLIT.csv)");
  }
};

/// A line on a terminal, and bad inputs once each.
class Progress {
 public:
  explicit Progress(std::size_t total) : total_(total) {}
  void operator()(const sessions::RunResult& result) {
    ++done_;
    completed_ += result.completed ? 1 : 0;
    line_.erase();
    if (result.inputFailed() && messages_.insert(result.message).second)
      std::cerr << sessions::plainLine(result.message);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began_;
    if (done_ < total_)
      line_.show(sessions::batchProgressText(done_, total_, completed_, passed.count()));
  }

 private:
  TerminalLine line_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  std::size_t completed_ = 0;
  std::set<std::string> messages_;
};

sessions::BatchRun batchRunOf(const EvaluateArguments& arguments) {
  sessions::BatchRun batch_run = sessions::thisBatchRun();
  batch_run.command = typedCommand();
  batch_run.jobs = arguments.batch.jobs;
  batch_run.threads = sessions::threadsOf(arguments.batch.threads, arguments.batch.memory_limit,
                                          arguments.batch.jobs);
  batch_run.kernels = kernelsName(arguments.batch.kernels);
  batch_run.shard = arguments.shard;
  batch_run.reseeds = arguments.batch.reseeds;
  return batch_run;
}

sessions::MethodFacts factsOf(const EvaluateArguments& arguments, const std::string& method) {
  sessions::MethodFacts facts =
      sessions::methodFacts(method, arguments.options.profileName(), arguments.batch.localizer);
  if (method != sessions::kWhs)
    sessions::addMethodOptions(
        arguments.method.changedOptions(arguments.batch.method_setup.options), facts);
  if (sessions::needsMatcher(method)) facts.note = "matcher: " + arguments.method.matcher;
  facts.reseed_scale = arguments.batch.reseed_scale;
  facts.mesh_of = arguments.batch.mesh_of;
  facts.mirror = arguments.mirror;
  return facts;
}

/// The runs of a plan that each method still has to do.
using Work = std::vector<std::pair<std::string, std::vector<sessions::PlannedRun>>>;

/// InputError when an input of a run that is done has changed since.
Work workLeft(const EvaluateArguments& arguments, const sessions::Dataset& dataset,
              const std::vector<sessions::PlannedRun>& plan,
              const sessions::ResultsWriter& writer) {
  sessions::RunInputs inputs(dataset, arguments.batch.mesh_of);
  Work work;
  std::size_t left = 0;
  for (const std::string& method : arguments.method.methods) {
    work.emplace_back(method, plan);
    std::erase_if(work.back().second, [&](const sessions::PlannedRun& run) {
      const auto held = writer.inputsOf(method, run.input->id, run.reseed);
      if (held) inputs.requireUnchanged(*run.input, *held, arguments.out);
      return held.has_value();
    });
    left += work.back().second.size();
  }
  const std::size_t all = plan.size() * arguments.method.methods.size();
  if (left < all)
    note(arguments.out + ": resumed, " + std::to_string(all - left) + " of " + std::to_string(all) +
         " runs are done");
  return work;
}

/// Prints the rate of the runs made by this command.
void runAll(EvaluateArguments& arguments, const sessions::Dataset& dataset, const Work& work,
            sessions::ResultsWriter& writer, const std::stop_token& stop) {
  std::size_t total = 0;
  std::size_t done = 0;
  for (const auto& [method, runs] : work) total += runs.size();
  if (total == 0) return;
  const auto began = std::chrono::steady_clock::now();
  writer.begin(batchRunOf(arguments));
  Progress progress(total);
  for (const auto& [method, runs] : work) {
    arguments.batch.method = method;
    sessions::runPlanned(
        dataset, arguments.batch, runs,
        [&](std::size_t, std::size_t, const sessions::RunResult& result) {
          writer.add(result);
          progress(result);
          ++done;
        },
        stop);
  }
  if (!stop.stop_requested()) writer.end();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
  print(std::to_string(done) + " runs in " + sessions::fixedText(passed.count(), 1) + " s, " +
        sessions::fixedText(static_cast<double>(done) / passed.count(), 2) + " runs/s");
}

void printSummary(const std::vector<sessions::RunResult>& results) {
  std::vector<sessions::Table> tables = {sessions::summaryTable(results)};
  if (std::any_of(results.begin(), results.end(),
                  [](const sessions::RunResult& run) { return run.success.has_value(); }))
    tables.push_back(sessions::toleranceTable(results));
  tables.push_back(sessions::timeTable(results));
  for (const sessions::Table& table : tables)
    std::cout << sessions::tableText(table, sessions::TableFormat::kText) << "\n";
  std::cout << sessions::failureList(results, kListedFailures) << std::flush;
}

/// Before the work rather than after it.
void requireOneMethodOfBop(const EvaluateArguments& arguments, const sessions::Dataset& dataset) {
  if (arguments.method.methods.size() != 1)
    throw CLI::ValidationError("--bop-csv", "holds the results of one method");
  (void)sessions::bopResults(dataset, {});
}

/// For the requested method only: the results may hold others from before.
void writeBopCsv(const EvaluateArguments& arguments, const sessions::Dataset& dataset,
                 std::vector<sessions::RunResult> results) {
  std::erase_if(results, [&](const sessions::RunResult& run) {
    return run.method != arguments.method.methods.front();
  });
  sessions::writeBopResults(arguments.bop_csv, sessions::bopResults(dataset, results));
}

void readArguments(EvaluateArguments& arguments) {
  if (!arguments.mirror.empty())
    arguments.batch.mirror = static_cast<sessions::MirrorAxis>(arguments.mirror.front() - 'x');
  if (!arguments.shard.empty())
    std::tie(arguments.batch.shard, arguments.batch.shards) = *shardNumbers(arguments.shard);
  arguments.batch.localizer = arguments.options.read();
  arguments.batch.method_setup = arguments.method.setup(arguments.options);
  arguments.batch.memory_limit = arguments.options.memoryLimit();
}

/// Runs side by side use the cores better than the threads of one run; with fewer runs than cores
/// the threads share the rest.
int jobsFor(std::size_t runs) {
  constexpr std::size_t kMost = 256;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp(runs, std::size_t{1}, std::min(cores, kMost)));
}

int evaluate(EvaluateArguments& arguments) {
  readArguments(arguments);
  const sessions::Dataset dataset = arguments.dataset.open();
  requireWritable({arguments.out, arguments.jsonl, arguments.bop_csv});
  if (!arguments.bop_csv.empty()) requireOneMethodOfBop(arguments, dataset);
  for (const std::string& line : dataset.notes) note(line);
  const std::vector<sessions::PlannedRun> plan = sessions::planBatch(dataset, arguments.batch);
  if (arguments.batch.jobs == 0) arguments.batch.jobs = jobsFor(plan.size());

  std::stop_source stop;
  const InterruptWatch watch(stop);  // to the end: all that is done is written, listed and counted
  {
    sessions::ResultsWriter writer(arguments.out, sessions::datasetFacts(dataset));
    for (const std::string& method : arguments.method.methods)
      writer.admit(factsOf(arguments, method));
    runAll(arguments, dataset, workLeft(arguments, dataset, plan, writer), writer,
           stop.get_token());
  }
  const std::vector<sessions::RunResult> results = sessions::readResults(arguments.out).runs;
  if (!arguments.jsonl.empty()) writeResultLines(arguments.jsonl, results);
  if (!arguments.bop_csv.empty()) writeBopCsv(arguments, dataset, results);
  printSummary(results);
  if (watch.signal() != 0) note(kInterruptedNote);
  return watch.exitCode(std::ranges::any_of(results, &sessions::RunResult::inputFailed) ? kBadInput
                                                                                        : kDone);
}

}  // namespace

void addEvaluate(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "evaluate",
             "Localizes the cases of a dataset and prints a summary of the errors", evaluate);
}

}  // namespace boresight::app
