// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <iostream>
#include <optional>
#include <stop_token>

#include "app/batch_output.h"
#include "app/case_arguments.h"
#include "app/commands.h"
#include "sessions/io/datasets/symmetries.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/session/views_run.h"
#include "sessions/text/plain_text.h"
#include "sessions/trace/run_text.h"

namespace boresight::app {
namespace {

struct RunArguments {
  std::string session;
  std::vector<std::string> cases;
  std::string again;
  CaseArguments stated;  ///< of it --end-effector, --requirement, --symmetry and --frames
  bool recover = false;
  bool views = false;

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    addOption(command, "--case", "ID", cases, "Only this case; may be repeated");
    addOption(command, "--again", "DIGEST", again,
              "Repeat the recorded run whose digest begins with these digits, with its "
              "options, and compare the digests")
        ->excludes("--case");
    command
        .add_flag("--views", views,
                  "Run each case together with the other views of its rig as one pose; the first "
                  "case of a rig gives seed and uncertainty")
        ->excludes("--again");
    stated.addEndEffectorTo(command);
    stated.addRequirementTo(command);
    stated.addSymmetryTo(command);
    stated.frames.addTo(command);
    for (const char* name : {"--end-effector", "--requirement", "--symmetry", "--frames"})
      command.get_option(name)->excludes("--again");
    addRecover(command, recover);
  }
};

/// Runs and records one case; a line to stdout. Empty, and nothing recorded, for a run that was
/// stopped.
std::optional<int> runOne(sessions::SessionDocument& document, const std::string& id,
                          const std::stop_token& stop) {
  const sessions::LocalizationTrace trace =
      sessions::runCase(document.session(), id, sessions::RecordLevel::kFull, stop);
  if (trace.status == LocalizationStatus::kRunning) return std::nullopt;
  const sessions::RunRecord run =
      sessions::storeRun(document.session(), id, trace, document.file());
  document.apply(sessions::withRun(document.session(), run), "Run " + id);
  print(id + ": " + run.status + ", " + std::to_string(trace.iterations.size()) +
        " iterations, digest " + run.digest);
  if (const std::string text = doubtfulPoseText(trace); !text.empty()) print(id + ": " + text);
  return trace.converged() ? kDone : kNotConverged;
}

/// Runs a case together with the other views of its rig and records a run of each.
std::optional<int> runTogether(sessions::SessionDocument& document, const std::string& id,
                               const std::stop_token& stop) {
  const auto views = sessions::runViews(document.session(), id, stop);
  for (const sessions::LocalizationTrace& view : views)
    if (view.status == LocalizationStatus::kRunning) return std::nullopt;
  const auto runs = sessions::storeViews(document.session(), views, document.file());
  sessions::Session next = document.session();
  for (const sessions::RunRecord& run : runs) next = sessions::withRun(next, run);
  document.apply(next, "Run " + id + " with the other views");
  bool converged = false;
  for (std::size_t v = 0; v < runs.size(); ++v) {
    print(runs[v].case_id + ": " + runs[v].status + ", " +
          std::to_string(views[v].iterations.size()) + " iterations, " +
          togetherText(views[v].views, runs[v].case_id) + ", digest " + runs[v].digest);
    converged = converged || views[v].converged();
  }
  return converged ? kDone : kNotConverged;
}

/// Each rig once, by the first of its requested cases; cases without other views alone.
bool rigHasRun(const sessions::Session& session, const std::string& id,
               const std::vector<std::string>& led) {
  const auto rigOf = [&session](const std::string& text) {
    const auto& rig = session.findCase(text)->rig;
    return rig ? rig->id : std::string();
  };
  return std::any_of(led.begin(), led.end(), [&](const std::string& leader) {
    return !rigOf(id).empty() && rigOf(leader) == rigOf(id);
  });
}

/// Repeats a recorded run with its options and reports whether the digest is the same.
int runAgain(const sessions::SessionDocument& document, const std::string& beginning) {
  const sessions::RunRecord& run = recordedRun(document, beginning);
  const sessions::LocalizationTrace trace = sessions::repeatRun(
      run, document.session(), document.file(), sessions::RecordLevel::kSummary);
  const bool same = trace.digest == run.digest;
  print(run.case_id + ": " + run.status + ", digest " + trace.digest +
        (same ? ", the same" : ", NOT the same as recorded"));
  return same ? kDone : kDifferent;
}

/// An edit of the cases, as if made in the window.
void takeStated(sessions::SessionDocument& document, const std::vector<std::string>& case_ids,
                const CaseArguments& arguments) {
  const sessions::CaseFiles files = arguments.files();
  const sessions::StatedInputs stated{files.camera_from_end_effector, files.requirement,
                                      arguments.statedSymmetries(),
                                      sessions::readFrameTransforms(arguments.frames.files)};
  if (stated.empty()) return;
  sessions::Session next = document.session();
  for (const std::string& id : case_ids) {
    if (stated.symmetries && !stated.symmetries->empty())
      sessions::requireInPlace(*stated.symmetries,
                               matchedBounds(sessions::readKnownScene(*next.findCase(id)).view()),
                               "case " + id);
    next = sessions::withStated(next, id, stated);
  }
  document.apply(next, "State end effector, requirement, symmetries, frames");
}

/// Runs the cases in their order, until a signal, and saves the session with the runs that ended.
int runAll(sessions::SessionDocument& document, const RunArguments& arguments) {
  const std::vector<std::string> case_ids = requestedCases(document, arguments.cases);
  std::stop_source stop;
  const InterruptWatch watch(stop);
  takeStated(document, case_ids, arguments.stated);
  int exit_code = kDone;
  std::exception_ptr failure;  // not of one case
  std::vector<std::string> led;
  for (const std::string& id : case_ids) {
    const bool together =
        arguments.views &&
        (!arguments.cases.empty() || !sessions::otherViews(document.session(), id).empty());
    if (together && rigHasRun(document.session(), id, led)) continue;
    if (together) led.push_back(id);
    try {
      const auto code = together ? runTogether(document, id, stop.get_token())
                                 : runOne(document, id, stop.get_token());
      if (exit_code == kDone) exit_code = code.value_or(kDone);
    } catch (const sessions::InputError& error) {
      // Errors of the case itself name it already.
      const std::string place = "case " + id + ": ", what = error.what();
      std::cerr << sessions::plainLine(what.starts_with(place) ? what : place + what);
      exit_code = kBadInput;
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    if (watch.signal() != 0 || failure) break;
  }
  document.save();
  if (failure) {
    note("the runs that ended before are saved");
    std::rethrow_exception(failure);
  }
  if (watch.signal() != 0) note("interrupted; the runs that ended are saved");
  return watch.exitCode(exit_code);
}

int runSession(const RunArguments& arguments) {
  sessions::SessionDocument document = openToEdit(arguments.session, arguments.recover);
  return arguments.again.empty() ? runAll(document, arguments)
                                 : runAgain(document, arguments.again);
}

}  // namespace

void addRun(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "run", "Runs the cases of a session and records the runs in it",
             runSession);
}

}  // namespace boresight::app
