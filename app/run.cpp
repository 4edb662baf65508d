// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "app/open_session.h"
#include "sessions/io/errors.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"

namespace boresight::app {
namespace {

struct RunArguments {
  std::string session;
  std::vector<std::string> cases;
  std::string again;
  bool recover = false;
};

/// The cases to run: those asked for, or all.
std::vector<std::string> selectedCases(const sessions::SessionDocument& document,
                                       const std::vector<std::string>& asked) {
  for (const std::string& id : asked) (void)requireCase(document, id);
  if (!asked.empty()) return asked;
  std::vector<std::string> all;
  for (const auto& one : document.session().cases) all.push_back(one->id);
  return all;
}

/// Runs and records one case; a line to stdout, a reason for a failure to stderr.
int runOne(sessions::SessionDocument& document, const std::string& id) {
  const sessions::LocalizationTrace trace = sessions::runCase(document.session(), id);
  const sessions::RunRecord run =
      sessions::storeRun(document.session(), id, trace, document.file());
  document.apply(sessions::withRun(document.session(), run), "Run " + id);
  std::cout << id << ": " << run.status << ", " << trace.iterations.size() << " iterations, digest "
            << run.digest << std::endl;
  return trace.converged() ? kDone : kNotConverged;
}

/// Runs a recorded run once more, by the options that it had, and says whether it is the same.
int runAgain(const sessions::SessionDocument& document, const std::string& beginning) {
  const sessions::RunRecord& run = recordedRun(document, beginning);
  const sessions::RunPlan plan = sessions::planOf(run, document.session(), document.file());
  const auto loaded = sessions::loadCase(*document.session().findCase(run.case_id));
  const sessions::LocalizationTrace trace =
      sessions::runCase(*loaded, plan, sessions::RecordLevel::kSummary);
  const bool same = trace.digest == run.digest;
  std::cout << run.case_id << ": " << run.status << ", digest " << trace.digest
            << (same ? ", the same" : ", NOT the same as recorded") << std::endl;
  return same ? kDone : kNotConverged;
}

int runSession(const RunArguments& arguments) {
  sessions::SessionDocument document = openToEdit(arguments.session, arguments.recover);
  if (!arguments.again.empty()) return runAgain(document, arguments.again);
  int exit_code = kDone;
  for (const std::string& id : selectedCases(document, arguments.cases)) {
    try {
      const int code = runOne(document, id);
      if (exit_code == kDone) exit_code = code;
    } catch (const sessions::InputError& error) {
      std::cerr << "case " << id << ": " << error.what() << std::endl;
      exit_code = kBadInput;
    }
  }
  document.save();
  return exit_code;
}

}  // namespace

void addRun(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("run", "Runs the cases of a session and records the runs in it");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("session", arguments->session, "Session file")->required()->type_name("FILE");
  command->add_option("--case", arguments->cases, "Only this case; may be repeated")
      ->type_name("ID");
  command
      ->add_option(
          "--again", arguments->again,
          "Instead: run a recorded run once more, with the options that it had and took up "
          "on its way, and compare; the beginning of its digest")
      ->type_name("DIGEST")
      ->excludes("--case");
  command->add_flag("--recover", arguments->recover,
                    "Take edits that a killed program left in the session's journal");
  command->callback([arguments, &exit_code] { exit_code = runSession(*arguments); });
}

}  // namespace boresight::app
