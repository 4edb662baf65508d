// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "app/commands.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/review/queue.h"
#include "sessions/review/run_difference.h"
#include "sessions/session/case_run.h"

namespace boresight::app {
namespace {

struct QueueArguments {
  std::string session;
  std::string csv;
  int jobs = 1;
  bool differences = false;
};

int listQueue(const sessions::Session& session, const QueueArguments& arguments) {
  if (!arguments.csv.empty()) sessions::requireWritable(arguments.csv);
  const auto rows = sessions::queueRows(session, arguments.jobs);
  std::cout << sessions::queueText(rows) << std::flush;
  if (!arguments.csv.empty())
    sessions::writeFileAtomically(arguments.csv, sessions::queueCsv(rows));
  return kDone;
}

/// Each case's last run against the one before it.
int listDifferences(const sessions::Session& session) {
  int exit_code = kDone;
  int counts[3] = {};
  for (const auto& one : session.cases) {
    const auto pair = sessions::lastTwoRuns(session, one->id);
    if (!pair) {
      note("case " + one->id + ": it has no two runs to compare");
      continue;
    }
    try {
      const auto made = sessions::compareRuns(session, pair->before->digest, pair->after->digest,
                                              sessions::loadCase(*one));
      ++counts[static_cast<int>(made.change)];
      std::cout << sessions::differenceText(made) << std::endl;
    } catch (const sessions::InputError& error) {
      note(error.what());
      exit_code = kBadInput;
    }
  }
  std::cout << counts[0] << " better, " << counts[1] << " worse, " << counts[2] << " the same"
            << std::endl;
  return exit_code;
}

int queue(const QueueArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  return arguments.differences ? listDifferences(document.session())
                               : listQueue(document.session(), arguments);
}

}  // namespace

void addQueue(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "queue",
      "Checks the last runs of a session's cases and lists them with the most trouble first: runs "
      "that failed, then failed checks, the margin to a check's limit, the distance from the seed; "
      "what is decided comes last",
      queue);
  addFile(*command, "session", arguments->session, "Session file")->required();
  command->add_option("--jobs", arguments->jobs, "Cases that are checked at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  auto* csv = command->add_option("--csv", arguments->csv, "Write the list to this file");
  csv->type_name("FILE");
  command
      ->add_flag("--differences", arguments->differences,
                 "Instead: compare each case's last run with the one before it, and say whether it "
                 "is better or worse, by the truth where it is known, else by the checks")
      ->excludes(csv);
}

}  // namespace boresight::app
