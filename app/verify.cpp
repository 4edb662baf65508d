// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/commands.h"
#include "sessions/review/verify_pose.h"

namespace boresight::app {
namespace {

struct VerifyArguments {
  std::string file;
  bool no_run = false;
};

int verify(const VerifyArguments& arguments) {
  const sessions::VerifyReport report = sessions::verifyPose(arguments.file, !arguments.no_run);
  for (const sessions::VerifyFinding& finding : report.findings)
    print((finding.good ? "good  " : "WRONG ") + finding.what + ": " + finding.text);
  print(report.standing);
  print(report.good() ? "the document verifies" : "the document does NOT verify");
  return report.good() ? kDone : kDifferent;
}

}  // namespace

void addVerify(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "Checks a validated_pose.json against the files that it names and against itself, and runs "
      "its localization again. Exit status 0 when all of it is as stated, 6 when it is not");
  auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("file", arguments->file, "validated_pose.json")
      ->required()
      ->type_name("FILE");
  command->add_flag("--no-run", arguments->no_run, "Do not run the localization again");
  command->callback([arguments, &exit_code] { exit_code = verify(*arguments); });
}

}  // namespace boresight::app
