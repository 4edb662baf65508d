// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/checks/checks.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"

namespace boresight::app {
namespace {

using sessions::PoseSource;
using sessions::Session;

struct DecideArguments {
  std::string session, case_id, by, comment;
  std::string source = "run";
  std::vector<std::string> waivers;
  int convergence = sessions::kConvergenceSeeds;
  bool validate = false;
  bool reject = false;
  bool approve = false;
  bool reopen = false;
  bool recover = false;

  sessions::Signature signature() const { return {by, comment}; }

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    addOption(command, "--case", "ID", case_id, "Case")->required();
    CLI::Option_group* what = command.add_option_group("What");
    what->add_flag("--validate", validate, "Validate the pose");
    what->add_flag("--reject", reject, "Reject the result");
    what->add_flag("--approve", approve, "Approve a validation as the second person");
    what->add_flag("--reopen", reopen, "Withdraw the last decision");
    what->require_option(1);
    addOption(command, "--by", "NAME", by, "Name of the person who decides")->required();
    addOption(command, "--comment", "TEXT", comment, "Reason of the decision")->required();
    addOption(command, "--waive", "CHECK=REASON", waivers,
              "Waives a failed check for this reason; may be repeated. `whs check --json` "
              "lists the names of the checks");
    addChoice(command, "--source", source, {"run", "annotation"},
              "Pose to decide on: that of the last run, or that of the annotations");
    addOption(
        command, "--convergence-test", "N", convergence,
        "Number of further seeds of the convergence test before a validation; 0: no such test")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    addRecover(command, recover);
  }
};

/// "coverage=half of it is dark" and the like.
sessions::CheckWaivers readWaivers(const DecideArguments& arguments) {
  sessions::CheckWaivers check_waivers;
  for (const std::string& text : arguments.waivers) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos || sign == 0)
      throw CLI::ValidationError("--waive", "'" + text + "' is not CHECK=REASON");
    check_waivers[text.substr(0, sign)] = text.substr(sign + 1);
  }
  return check_waivers;
}

/// Empty after a stop.
std::optional<Session> validatedCase(const Session& session, const DecideArguments& arguments,
                                     const std::stop_token& stop) {
  const auto source = arguments.source == "annotation" ? PoseSource::kAnnotation : PoseSource::kRun;
  const auto subject = sessions::reviewSubject(
      session, sessions::loadCase(*session.findCase(arguments.case_id)), source);
  const auto limits = sessions::checkLimits(session.review.preset, session.review.limits);
  const sessions::CheckWaivers waivers = readWaivers(arguments);
  // A pose that cannot be validated is rejected at once.
  const std::string concern = sessions::validationConcern(session, subject);
  if (!concern.empty()) throw sessions::DecisionError(concern);
  const sessions::ConvergenceResult convergence =
      sessions::convergenceTest(subject, arguments.convergence, stop);
  if (stop.stop_requested()) return std::nullopt;
  return sessions::validated(session, subject, sessions::checkPose(subject, limits, convergence),
                             waivers, arguments.signature(), convergence.seeds);
}

/// Checks of the result that is rejected: of its last run, else of its annotations. None, with a
/// note, where there is no pose or it cannot be read: it is rejected all the same.
std::vector<sessions::Check> checksOfRejected(const Session& session, const std::string& id) {
  const auto source = session.lastRunOf(id) != nullptr ? PoseSource::kRun : PoseSource::kAnnotation;
  if (source == PoseSource::kAnnotation && !session.annotations.contains(id)) return {};
  try {
    const auto subject =
        sessions::reviewSubject(session, sessions::loadCase(*session.findCase(id)), source);
    return sessions::checkPose(subject,
                               sessions::checkLimits(session.review.preset, session.review.limits));
  } catch (const std::exception& error) {
    note("rejected without checks: " + std::string(error.what()));
    return {};
  }
}

std::optional<Session> decided(const Session& session, const DecideArguments& arguments,
                               const std::stop_token& stop) {
  if (arguments.validate) return validatedCase(session, arguments, stop);
  const std::string run = sessions::lastRunDigest(session, arguments.case_id);
  if (arguments.approve)
    return sessions::approved(session, arguments.case_id, run, arguments.signature());
  if (arguments.reject)
    return sessions::rejected(session, arguments.case_id, run,
                              checksOfRejected(session, arguments.case_id), arguments.signature());
  return sessions::reopened(session, arguments.case_id, arguments.signature());
}

int decide(const DecideArguments& arguments) {
  if (!arguments.waivers.empty() && !arguments.validate)
    throw CLI::ValidationError("--waive", "needs --validate: no other decision waives a check");
  // A decision that cannot be saved leaves nothing that another operator could recover.
  sessions::SessionDocument document =
      openToEdit(arguments.session, arguments.recover, sessions::Access::kEditAndSave);
  (void)requireCase(document, arguments.case_id);
  std::stop_source stop;
  const InterruptWatch watch(stop);
  try {
    const std::optional<Session> next = decided(document.session(), arguments, stop.get_token());
    if (!next) {
      note("interrupted; nothing is decided");
      return watch.exitCode(kInternalFault);
    }
    document.apply(*next, "Decide on " + arguments.case_id);
  } catch (const sessions::DecisionError& error) {
    note(arguments.case_id + ": " + error.what());
    return kNotConverged;
  }
  document.save();  // also after a signal: the decision is complete
  print(arguments.case_id + ": " +
        reviewStatusText(reviewStatusOf(document.session(), arguments.case_id)));
  return watch.exitCode(kDone);
}

}  // namespace

void addDecide(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "decide",
             "Validates, rejects or approves the pose of a case, with name and comment. Exit "
             "status 4: the pose cannot be validated, as a failed check is not waived",
             decide);
}

}  // namespace boresight::app
