// SPDX-License-Identifier: Apache-2.0

#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/report/pose_report.h"

namespace boresight::app {
namespace {

struct ReportArguments {
  std::string session, case_id, out;

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    addOption(command, "--case", "ID", case_id, "Case; required if the session has several");
    addFile(command, "--out", out, "PDF file")->required();
  }
};

int report(const ReportArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  sessions::requireWritable(arguments.out);
  const sessions::Session& session = document.session();
  std::string id = arguments.case_id;
  if (id.empty() && session.cases.size() == 1) id = session.cases.front()->id;
  if (id.empty()) throw CLI::ValidationError("--case", "the session has several cases; give one");
  (void)requireCase(document, id);
  const sessions::PoseReport pose_report = sessions::poseReport(session, id);
  sessions::writePoseReport(arguments.out, pose_report);
  print(id + ": " + pose_report.pose.review_status);
  return kDone;
}

}  // namespace

void addReport(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "report",
             "Writes a two-page PDF report of a case's pose: overlay, pose, inputs, decision, "
             "checks, residuals, iterations",
             report);
}

}  // namespace boresight::app
