// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/commands.h"
#include "app/open_session.h"
#include "sessions/io/atomic_file.h"
#include "sessions/report/pose_report.h"

namespace boresight::app {
namespace {

struct ReportArguments {
  std::string session;
  std::string case_id;
  std::string out;
};

int report(const ReportArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  sessions::requireWritable(arguments.out);
  const sessions::Session& session = document.session();
  std::string id = arguments.case_id;
  if (id.empty() && session.cases.size() == 1) id = session.cases.front()->id;
  if (id.empty()) throw CLI::ValidationError("--case", "the session has several: name one");
  (void)requireCase(document, id);
  const sessions::PoseReport made = sessions::poseReport(session, id);
  sessions::writePoseReport(arguments.out, made);
  print(id + ": " + made.pose.standing);
  return kDone;
}

}  // namespace

void addReport(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "report",
      "Writes a report of a case's pose as PDF: overlay, pose, inputs, decision, checks, residuals "
      "and the run's course, on two pages");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("session", arguments->session, "Session file")->required()->type_name("FILE");
  command->add_option("--case", arguments->case_id, "The case; needed where there are several")
      ->type_name("ID");
  command->add_option("--out", arguments->out, "PDF file")->required()->type_name("FILE");
  command->callback([arguments, &exit_code] { exit_code = report(*arguments); });
}

}  // namespace boresight::app
