// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <vector>

#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/queue.h"
#include "sessions/review/run_difference.h"
#include "sessions/session/case_run.h"

namespace boresight::app {
namespace {

struct QueueArguments {
  std::string session, csv;
  int jobs = 1;
  bool differences = false;

  void addTo(CLI::App& command) {
    addFile(
        command, "session", session,
        "Session file, or results of `whs evaluate` (.sqlite), whose runs are listed as they ended")
        ->required();
    command.add_option("--jobs", jobs, "Number of cases that are checked in parallel")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    CLI::Option* list = addFile(command, "--csv", csv, "Write the list to this file");
    command
        .add_flag("--differences", differences,
                  "Compare each case's last run with the previous run instead: better or worse by "
                  "the truth, or by the checks without truth")
        ->excludes(list);
  }
};

int listQueue(const std::vector<sessions::QueueRow>& rows, const QueueArguments& arguments) {
  std::cout << sessions::queueText(rows) << std::flush;
  if (!arguments.csv.empty())
    sessions::writeFileAtomically(arguments.csv, sessions::queueCsv(rows));
  return kDone;
}

/// Each case's last run against the one before it.
int listDifferences(const sessions::Session& session) {
  int exit_code = kDone;
  int counts[3] = {};
  for (const auto& session_case : session.cases) {
    const auto pair = sessions::lastTwoRuns(session, session_case->id);
    if (!pair) {
      note("case " + session_case->id + ": fewer than two runs to compare");
      continue;
    }
    try {
      const auto result = sessions::compareRuns(session, pair->before->digest, pair->after->digest,
                                                sessions::loadCase(*session_case));
      ++counts[static_cast<int>(result.change)];
      std::cout << sessions::differenceText(result) << std::endl;
    } catch (const sessions::InputError& error) {
      note(error.what());
      exit_code = kBadInput;
    }
  }
  std::cout << counts[0] << " better, " << counts[1] << " worse, " << counts[2] << " the same"
            << std::endl;
  return exit_code;
}

bool isResults(const std::string& file) {
  return std::filesystem::path(file).extension() == ".sqlite";
}

int queue(const QueueArguments& arguments) {
  const std::string& file = arguments.session;
  if (isResults(file) && arguments.differences)
    throw CLI::ValidationError("--differences",
                               "needs a session; to compare results use "
                               "`whs tables RESULTS --against RESULTS`");
  requireWritable({arguments.csv});
  if (isResults(file)) return listQueue(sessions::resultsQueue(file), arguments);
  const sessions::SessionDocument document = openToRead(file);
  return arguments.differences
             ? listDifferences(document.session())
             : listQueue(sessions::queueRows(document.session(), arguments.jobs), arguments);
}

}  // namespace

void addQueue(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "queue",
      "Checks the last runs of a session's cases and lists the worst first: failed runs, failed "
      "checks, smallest margin to a limit, largest distance from the seed. Decided cases come last",
      queue);
}

}  // namespace boresight::app
