// SPDX-License-Identifier: Apache-2.0

#include "app/commands.h"
#include "sessions/io/errors.h"
#include "sessions/review/validated_pose_file.h"

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
  for (const sessions::VerifyFinding& finding : report.findings)
    print((finding.good ? "good        " : "WRONG       ") + finding.what + ": " + finding.text);
  for (const std::string& text : report.not_proved) print("not proved  " + text);
  print("stated: " + report.review_status);
  print(report.good() ? "everything that was measured is as stated"
                      : "the document is NOT as stated");
  return report.good() ? kDone : kDifferent;
}

}  // namespace

void addVerify(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "verify",
      "Checks a validated_pose.json against the files that it names and against itself, runs its "
      "localization again, and compares pose, covariance and checks with those stated. It cannot "
      "prove who decided, when, and why a failed check was passed over: those are listed as not "
      "proved. Exit status 0 when everything that was measured is as stated, 6 when it is not",
      verify);
  addFile(*command, "file", arguments->file, "validated_pose.json")->required();
  CLI::Option* no_run = command->add_flag(
      "--no-run", arguments->no_run,
      "Do not run the localization again: pose, covariance and checks are not proved then");
  command
      ->add_flag("--full", arguments->full,
                 "Run the convergence test from further seeds again, too, which takes as long as "
                 "so many runs")
      ->excludes(no_run);
}

}  // namespace boresight::app
