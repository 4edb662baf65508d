// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "sessions/io/errors.h"
#include "sessions/review/verify_pose.h"

namespace boresight::app {
namespace {

struct VerifyArguments {
  std::string file;
  bool no_run = false;
  bool full = false;
};

int verify(const VerifyArguments& arguments) {
  const sessions::VerifyReport report =
      sessions::verifyPose(arguments.file, !arguments.no_run, arguments.full);
  const auto print = [](const char* found, const std::string& text) {
    std::cout << found << sessions::oneLine(text) << "\n";
  };
  for (const sessions::VerifyFinding& finding : report.findings)
    print(finding.good ? "good        " : "WRONG       ", finding.what + ": " + finding.text);
  for (const std::string& text : report.not_proved) print("not proved  ", text);
  print("", "stated: " + report.standing);
  std::cout << (report.good() ? "everything that was measured is as stated"
                              : "the document is NOT as stated")
            << std::endl;
  return report.good() ? kDone : kDifferent;
}

}  // namespace

void addVerify(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "Checks a validated_pose.json against the files that it names and against itself, runs its "
      "localization again, and compares pose, covariance and checks with those stated. It cannot "
      "prove who decided, when, and why a failed check was passed over: those are listed as not "
      "proved. Exit status 0 when everything that was measured is as stated, 6 when it is not");
  auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("file", arguments->file, "validated_pose.json")
      ->required()
      ->type_name("FILE");
  CLI::Option* no_run = command->add_flag(
      "--no-run", arguments->no_run,
      "Do not run the localization again: pose, covariance and checks are not proved then");
  command
      ->add_flag("--full", arguments->full,
                 "Run the convergence test from further seeds again, too, which takes as long as "
                 "so many runs")
      ->excludes(no_run);
  command->callback([arguments, &exit_code] { exit_code = verify(*arguments); });
}

}  // namespace boresight::app
