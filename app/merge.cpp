// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <stop_token>

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/evaluation/results_file.h"

namespace boresight::app {
namespace {

struct MergeArguments {
  std::string out;
  std::vector<std::string> inputs;

  void addTo(CLI::App& command) {
    addFile(command, "OUT", out,
            "Output file; runs in an existing file are kept, also when it is one of the inputs")
        ->required();
    addFile(command, "IN", inputs, "Results files")->required();
  }
};

int merge(const MergeArguments& arguments) {
  std::stop_source stop;
  const InterruptWatch watch(stop);
  const std::optional<sessions::MergeCounts> counts = sessions::mergeResults(
      arguments.out, {arguments.inputs.begin(), arguments.inputs.end()}, stop.get_token());
  if (!counts) {
    note("interrupted; " + arguments.out + " is as it was");
    return watch.exitCode(kInternalFault);
  }
  print(arguments.out + ": " + std::to_string(counts->runs) + " runs" +
        (counts->equal > 0 ? "; " + std::to_string(counts->equal) + " were duplicates" : ""));
  return kDone;
}

}  // namespace

void addMerge(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "merge",
             "Merges results of `whs evaluate`, e.g. of shards, into one file; runs that "
             "contradict each other are refused",
             merge);
}

}  // namespace boresight::app
