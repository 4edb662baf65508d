// SPDX-License-Identifier: Apache-2.0

#include <optional>

#include "app/commands.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/validated_pose_file.h"

namespace boresight::app {
namespace {

struct VerifyArguments {
  std::string file, folder, signers;
  bool no_run = false;
  bool full = false;
  bool not_validated = false;

  void addTo(CLI::App& command) {
    addFile(command, "file", file, "validated_pose.json")->required();
    addOption(command, "--folder", "FOLDER", folder,
              "Look below this folder for files that are not where the document names them, "
              "by their hashes")
        ->check(CLI::ExistingDirectory);
    addFile(
        command, "--signers", signers,
        "Allowed signers (ssh-keygen): those who decided must have signed the file with a key that "
        "this lists for their names, in FILE.sig or FILE.*.sig");
    CLI::Option* without_run =
        command.add_flag("--no-run", no_run,
                         "Skip the localization; pose, covariance and checks are then not proved");
    command.add_flag("--full", full, "Repeat the convergence test, too; takes one run per seed")
        ->excludes(without_run);
    command.add_flag("--allow-not-validated", not_validated,
                     "Exit with 0 also for a pose that is not validated: its values alone count");
  }
};

int verify(const VerifyArguments& arguments) {
  sessions::VerifyPlaces places;
  if (!arguments.folder.empty()) places.folder = arguments.folder;
  if (!arguments.signers.empty()) places.signers = arguments.signers;
  const sessions::VerifyReport report =
      sessions::verifyPose(arguments.file, !arguments.no_run, arguments.full, places);
  for (const sessions::VerifyFinding& finding : report.findings)
    print((finding.good ? "good        " : "WRONG       ") + finding.what + ": " + finding.text);
  for (const std::string& text : report.not_proved) print("not proved  " + text);
  print("stated: " + report.review_status);
  print(report.good() ? "all measured values agree with the document"
                      : "the document does NOT agree with the measured values");
  const bool accepted = report.validated || arguments.not_validated;
  if (!accepted) print("the pose is NOT VALIDATED");
  return report.good() && accepted ? kDone : kDifferent;
}

}  // namespace

void addVerify(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "verify",
      "Verifies a validated_pose.json: checks its hashes, runs its localization again, and "
      "compares pose, covariance and checks. Lists as not proved who decided, when, and why a "
      "check was waived. Exit status: 0 the pose is validated and all measured values agree, 6 "
      "otherwise",
      verify);
}

}  // namespace boresight::app
