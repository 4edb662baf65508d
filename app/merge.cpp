// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/commands.h"
#include "sessions/evaluation/results_merge.h"

namespace boresight::app {
namespace {

struct MergeArguments {
  std::string out;
  std::vector<std::string> inputs;
};

int merge(const MergeArguments& arguments) {
  const sessions::MergeCounts counts =
      sessions::mergeResults(arguments.out, {arguments.inputs.begin(), arguments.inputs.end()});
  print(arguments.out + ": " + std::to_string(counts.runs) + " runs" +
        (counts.equal > 0
             ? "; " + std::to_string(counts.equal) + " were there more than once, alike"
             : ""));
  return kDone;
}

}  // namespace

void addMerge(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "merge",
      "Joins results of `whs evaluate`, e.g. of shards, into one file; refuses runs that "
      "contradict each other");
  auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option("OUT", arguments->out,
                   "The file to make; what is in one that is there already stays")
      ->required()
      ->type_name("FILE");
  command->add_option("IN", arguments->inputs, "Results files")->required()->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = merge(*arguments); });
}

}  // namespace boresight::app
