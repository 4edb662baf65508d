// SPDX-License-Identifier: Apache-2.0

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/exchange/annotation_exchange.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/review/validated_pose_file.h"

namespace boresight::app {
namespace {

/// Arguments that export and import share.
struct ExchangeArguments {
  std::string session, colmap, bop, points;
  std::vector<std::string> cases;

  /// Annotations are those of one case.
  const std::string& onlyCase() const {
    if (cases.size() != 1) throw CLI::ValidationError("--case", "give exactly one case");
    return cases.front();
  }
};

struct ExportArguments : ExchangeArguments {
  std::string landmarks, pose, bop_results;
  std::string poses = "annotations";
  int scene = 1;
  bool robust = false;

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    CLI::Option_group* what = command.add_option_group("What");
    addOption(*what, "--colmap", "DIR", colmap,
              "New folder with the poses as a COLMAP text model: cameras.txt, images.txt");
    addOption(*what, "--bop", "DIR", bop,
              "New folder with the poses as a BOP scene: scene_gt.json, scene_camera.json, and "
              "undistorted images in gray/");
    addFile(*what, "--pose", pose,
            "Pose of one case with its checks, hashes and decision (validated_pose.json). Pose, "
            "covariance and checks are measured again; a decision on other values is refused");
    addOption(*what, "--bop-results", "CSV", bop_results,
              "Poses for hand-over as a BOP19 results file");
    addFile(*what, "--points", points, "Annotations of one case as points.json or points.csv");
    addFile(*what, "--landmarks", landmarks,
            "Points of one case as landmarks.json; added to an existing file");
    what->require_option(1);
    addOption(command, "--case", "ID", cases,
              "Case to export; may be repeated for poses (default: all cases with a pose)");
    addChoice(command, "--poses", poses, {"annotations", "handed-over"},
              "Poses that --colmap and --bop write: annotations, or handed-over (validated, "
              "else of the last run, else of the annotations)");
    command.add_option("--scene", scene, "Number of the scene in --bop-results")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str();
    command.add_flag("--robust", robust, "Give annotations far from their projection less weight");
  }
};

struct ImportArguments : ExchangeArguments {
  bool replace = false;
  bool recover = false;

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    CLI::Option_group* what = command.add_option_group("What");
    addFile(*what, "--points", points, "points.json or points.csv of one case");
    addOption(*what, "--colmap", "DIR", colmap,
              "Folder with a COLMAP text model; images are known by their names");
    addOption(*what, "--bop", "DIR", bop,
              "Folder with a BOP scene; images are known by their numbers");
    what->require_option(1);
    addOption(command, "--case", "ID", cases, "Case of the annotations");
    command.add_flag("--replace", replace, "Replace annotations or truths that a case already has");
    addRecover(command, recover);
  }
};

void tell(const std::vector<std::string>& case_ids, const std::vector<std::string>& notes) {
  for (const std::string& id : case_ids) print(id);
  for (const std::string& text : notes) note(text);
}

void exportPose(const sessions::Session& session, const ExportArguments& arguments) {
  sessions::requireWritable(arguments.pose);
  const sessions::HandedPose pose =
      sessions::writeValidatedPose(arguments.pose, session, arguments.onlyCase());
  print(pose.case_id + ": " + pose.review_status);
}

sessions::ExportReport exportPoses(const sessions::Session& session,
                                   const ExportArguments& arguments) {
  if (!arguments.bop_results.empty())
    return sessions::exportBopResults(session, arguments.bop_results, arguments.cases,
                                      arguments.scene);
  const sessions::HandedPoses poses = arguments.poses == "annotations"
                                          ? sessions::annotatedPoses(session, arguments.cases)
                                          : sessions::posesToHandOver(session, arguments.cases);
  return arguments.colmap.empty() ? sessions::exportBop(session, arguments.bop, poses)
                                  : sessions::exportColmap(session, arguments.colmap, poses);
}

int exportFrom(const ExportArguments& arguments) {
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

int importInto(const ImportArguments& arguments) {
  sessions::SessionDocument document =
      openToEdit(arguments.session, arguments.recover, sessions::Access::kEditAndSave);
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
  std::stop_source stop;
  const InterruptWatch watch(stop);  // an import that is begun is saved
  document.apply(report.session, text);
  document.save();
  tell(report.case_ids, report.notes);
  return watch.exitCode(kDone);
}

}  // namespace

void addExport(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "export",
             "Exports poses or annotations of a session for other programs and prints the cases",
             exportFrom);
}

void addImport(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "import",
      "Imports annotations, or poses as the cases' truth, into a session and prints the cases",
      importInto);
}

}  // namespace boresight::app
