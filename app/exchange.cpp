// SPDX-License-Identifier: Apache-2.0

#include "app/commands.h"
#include "sessions/exchange/annotation_exchange.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/review/validated_pose_file.h"

namespace boresight::app {
namespace {

/// What export and import have in common.
struct ExchangeArguments {
  std::string session;
  std::string colmap;
  std::string bop;
  std::string points;
  std::string landmarks;
  std::string pose;
  std::string bop_results;
  std::string poses = "annotations";
  int scene = 1;
  std::vector<std::string> cases;
  bool robust = false;
  bool replace = false;
  bool recover = false;

  /// Annotations are those of one case.
  const std::string& onlyCase() const {
    if (cases.size() != 1) throw CLI::ValidationError("--case", "give exactly one case");
    return cases.front();
  }
};

void tell(const std::vector<std::string>& case_ids, const std::vector<std::string>& notes) {
  for (const std::string& id : case_ids) print(id);
  for (const std::string& text : notes) note(text);
}

void exportPose(const sessions::Session& session, const ExchangeArguments& arguments) {
  sessions::requireWritable(arguments.pose);
  const sessions::HandedPose pose =
      sessions::writeValidatedPose(arguments.pose, session, arguments.onlyCase());
  print(pose.case_id + ": " + pose.review_status);
}

sessions::ExportReport exportPoses(const sessions::Session& session,
                                   const ExchangeArguments& arguments) {
  if (!arguments.bop_results.empty())
    return sessions::exportBopResults(session, arguments.bop_results, arguments.cases,
                                      arguments.scene);
  const sessions::CasePoses poses =
      arguments.poses == "annotations"
          ? sessions::annotatedPoses(session, arguments.cases)
          : sessions::posesToHandOver(session, arguments.cases);
  return arguments.colmap.empty() ? sessions::exportBop(session, arguments.bop, poses)
                                  : sessions::exportColmap(session, arguments.colmap, poses);
}

int exportFrom(const ExchangeArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  sessions::Session session = document.session();
  session.robust_annotations |= arguments.robust;
  for (const std::string& id : arguments.cases) (void)requireCase(document, id);
  if (!arguments.points.empty()) {
    sessions::exportAnnotations(session, arguments.onlyCase(), arguments.points);
    tell(arguments.cases, {});
  } else if (!arguments.landmarks.empty()) {
    tell(arguments.cases,
         sessions::exportLandmarks(session, arguments.onlyCase(), arguments.landmarks));
  } else if (!arguments.pose.empty()) {
    exportPose(session, arguments);
  } else {
    const sessions::ExportReport report = exportPoses(session, arguments);
    tell(report.case_ids, report.notes);
  }
  return kDone;
}

int importInto(const ExchangeArguments& arguments) {
  sessions::SessionDocument document = openToEdit(arguments.session, arguments.recover);
  const sessions::Session& session = document.session();
  for (const std::string& id : arguments.cases) (void)requireCase(document, id);
  sessions::ImportReport report;
  std::string text = "Import poses";
  if (!arguments.points.empty()) {
    text = "Import annotations of " + arguments.onlyCase();
    report = sessions::importAnnotations(session, arguments.onlyCase(), arguments.points,
                                         arguments.replace);
  } else if (!arguments.colmap.empty()) {
    report = sessions::importColmap(session, arguments.colmap, arguments.replace);
  } else {
    report = sessions::importBop(session, arguments.bop, arguments.replace);
  }
  document.apply(report.session, text);
  document.save();
  tell(report.case_ids, report.notes);
  return kDone;
}

}  // namespace

void addExport(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "export",
      "Exports poses or annotations of a session for other programs and prints the cases",
      exportFrom);
  addFile(*command, "session", arguments->session, "Session file")->required();
  CLI::Option_group* what = command->add_option_group("What");
  what->add_option("--colmap", arguments->colmap,
                   "New folder with the poses as a COLMAP text model: cameras.txt, images.txt")
      ->type_name("DIR");
  what->add_option(
          "--bop", arguments->bop,
          "New folder with the poses as a BOP scene: scene_gt.json, scene_camera.json, and "
          "undistorted images in gray/")
      ->type_name("DIR");
  addFile(*what, "--pose", arguments->pose,
          "Pose of one case with its checks, hashes and decision (validated_pose.json). Pose, "
          "covariance and checks are measured again; a decision on other values is refused");
  what->add_option("--bop-results", arguments->bop_results,
                   "Poses for hand-over as a BOP19 results file")
      ->type_name("CSV");
  addFile(*what, "--points", arguments->points,
          "Annotations of one case as points.json or points.csv");
  addFile(*what, "--landmarks", arguments->landmarks,
          "Points of one case as landmarks.json; added to an existing file");
  what->require_option(1);
  command
      ->add_option("--case", arguments->cases,
                   "Case to export; may be repeated for poses (default: all cases with a pose)")
      ->type_name("ID");
  command
      ->add_option("--poses", arguments->poses,
                   "Poses that --colmap and --bop write: annotations, or handed-over (validated, "
                   "else of the last run, else of the annotations)")
      ->check(CLI::IsMember({"annotations", "handed-over"}))
      ->capture_default_str();
  command->add_option("--scene", arguments->scene, "Number of the scene in --bop-results")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_flag("--robust", arguments->robust,
                    "Give annotations far from their projection less weight");
}

void addImport(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "import",
      "Imports annotations, or poses as the cases' truth, into a session and prints the cases",
      importInto);
  addFile(*command, "session", arguments->session, "Session file")->required();
  CLI::Option_group* what = command->add_option_group("What");
  addFile(*what, "--points", arguments->points, "points.json or points.csv of one case");
  what->add_option("--colmap", arguments->colmap,
                   "Folder with a COLMAP text model; images are known by their names")
      ->type_name("DIR");
  what->add_option("--bop", arguments->bop,
                   "Folder with a BOP scene; images are known by their numbers")
      ->type_name("DIR");
  what->require_option(1);
  command->add_option("--case", arguments->cases, "Case of the annotations")->type_name("ID");
  command->add_flag("--replace", arguments->replace,
                    "Replace annotations or truths that a case already has");
  command->add_flag("--recover", arguments->recover,
                    "Recover edits that a killed program left in the session's journal");
}

}  // namespace boresight::app
