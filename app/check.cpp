// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <stop_token>

#include <nlohmann/json.hpp>

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/checks/checks.h"
#include "sessions/decision/check.h"
#include "sessions/decision/decision.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/case_run.h"

namespace boresight::app {
namespace {

using sessions::PoseSource;

std::vector<std::string> presetNames() {
  std::vector<std::string> names;
  for (const sessions::CheckPreset& preset : sessions::checkPresets()) names.push_back(preset.name);
  return names;
}

struct CheckArguments {
  std::string session;
  std::vector<std::string> cases;
  std::string source = "run";
  std::string preset, json;
  int convergence = sessions::kConvergenceSeeds;
  bool sentences = false;

  PoseSource poseSource() const {
    return source == "annotation" ? PoseSource::kAnnotation : PoseSource::kRun;
  }

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    addOption(command, "--case", "ID", cases, "Only this case; may be repeated");
    addChoice(command, "--source", source, {"run", "annotation"},
              "Pose to check: that of the last run, or that of the annotations");
    addOption(command, "--convergence-test", "N", convergence,
              "Number of further seeds of the convergence test; 0: no such test")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    addChoice(command, "--preset", preset, presetNames(),
              "Preset that replaces the session's limits, and its requirement for cases without an "
              "own one")
        ->type_name("NAME");
    addFile(command, "--json", json, "Write the checks to this file");
    command.add_flag("--sentences", sentences, "Print the findings of passed checks, too");
  }
};

/// A case's checks, or why there is no pose to check.
struct CheckedCase {
  std::string id;
  std::vector<sessions::Check> checks;
  std::string reason;
};

/// The session as it is judged: by its own preset and limits, or by another preset as it is.
sessions::Session judgedBy(const sessions::Session& session, const std::string& preset) {
  sessions::Session judged = session;
  if (!preset.empty()) judged.review = {preset, {}, session.review.second_person};
  return judged;
}

/// After a stop the convergence test is incomplete.
CheckedCase checkCase(const sessions::Session& session, const std::string& id,
                      const CheckArguments& arguments, const std::stop_token& stop) {
  const auto limits = sessions::checkLimits(session.review.preset, session.review.limits);
  if (arguments.poseSource() == PoseSource::kRun) {
    const sessions::RunRecord& run = sessions::currentRunOf(session, id);
    if (sessions::stalenessOf(run, session, arguments.session).options_changed)
      note(id + ": the run was made with other options than the session has now");
  }
  const auto subject = sessions::reviewSubject(session, sessions::loadCase(*session.findCase(id)),
                                               arguments.poseSource());
  const auto convergence = sessions::convergenceTest(subject, arguments.convergence, stop);
  return {id, sessions::checkPose(subject, limits, convergence), ""};
}

void writeJson(const CheckArguments& arguments, const std::string& preset,
               const std::vector<CheckedCase>& cases) {
  nlohmann::ordered_json json = {{"format", "boresight-checks"}, {"version", 1}};
  json["preset"] = preset;
  json["source"] = arguments.source;
  json["cases"] = nlohmann::ordered_json::array();
  for (const CheckedCase& checked_case : cases) {
    nlohmann::ordered_json result = {{"id", checked_case.id},
                                     {"passed", sessions::allPassed(checked_case.checks)}};
    if (!checked_case.reason.empty()) result["reason"] = checked_case.reason;
    result["checks"] = nlohmann::ordered_json::array();
    for (const sessions::Check& check : checked_case.checks)
      result["checks"].push_back(sessions::toJson(sessions::JudgedCheck{check, ""}));
    json["cases"].push_back(std::move(result));
  }
  sessions::writeJsonFile(arguments.json, json);
}

int checkSession(const CheckArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  requireWritable({arguments.json});
  const sessions::Session session = judgedBy(document.session(), arguments.preset);
  int exit_code = kDone;
  std::vector<CheckedCase> checked;
  std::stop_source stop;
  const InterruptWatch watch(stop);
  for (const std::string& id : requestedCases(document, arguments.cases)) {
    try {
      const CheckedCase next = checkCase(session, id, arguments, stop.get_token());
      if (watch.signal() != 0) break;
      checked.push_back(next);
      const CheckedCase& checked_case = checked.back();
      print(id);
      std::cout << sessions::checksText(checked_case.checks, arguments.sentences) << std::endl;
      if (exit_code == kDone && !sessions::allPassed(checked_case.checks))
        exit_code = kNotConverged;
    } catch (const sessions::InputError& error) {
      std::cerr << error.what() << std::endl;
      checked.push_back({id, {}, error.what()});
      exit_code = kBadInput;
    }
  }
  if (!arguments.json.empty()) writeJson(arguments, session.review.preset, checked);
  if (watch.signal() != 0) note("interrupted; the cases before were checked");
  return watch.exitCode(exit_code);
}

}  // namespace

void addCheck(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "check",
      "Checks the poses of a session, with --convergence-test also from further seeds. "
      "Exit status: 0 all checks pass, 4 a check fails, 3 no pose to check, or the inputs have "
      "changed since the run",
      checkSession);
}

}  // namespace boresight::app
