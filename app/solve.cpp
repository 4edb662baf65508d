// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <vector>

#include "app/commands.h"
#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/solution_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/session/case_annotations.h"

namespace boresight::app {
namespace {

struct SolveArguments {
  std::string points, camera, rig, session, case_id, seed, out, json;
  FrameArguments frames;
  bool alone = false;
  bool robust = false;

  /// Points with a camera, a rig, or a case of a session: each excludes the other two.
  void addTo(CLI::App& command) {
    CLI::Option* from_points = addFile(command, "--points", points, "points.json or points.csv");
    CLI::Option* from_camera = addFile(command, "--camera", camera, kCameraHelp);
    CLI::Option* from_rig =
        addFile(command, "--rig", rig,
                "rig.json: rigidly joined cameras with their points; the pose is that of the rig");
    CLI::Option* from_session =
        addFile(command, "--session", session,
                "Session with the case; solved as in the desktop program: with the annotations of "
                "its rig's other cases, from its seed");
    CLI::Option* of_case = addOption(command, "--case", "ID", case_id, "Case");
    command.add_flag("--alone", alone, "Leave out the other cases of its rig")->needs(from_session);
    CLI::Option* from_seed = addFile(command, "--seed", seed,
                                     "pose.json to start from, needed if no image has four points");
    frames.addTo(command);
    from_rig->excludes(from_points)->excludes(from_camera);
    for (CLI::Option* other : {from_points, from_camera, from_rig, from_seed})
      from_session->excludes(other);
    from_session->needs(of_case);
    of_case->needs(from_session);
    from_points->needs(from_camera);
    from_camera->needs(from_points);
    command.add_flag("--robust", robust, "Give annotations far from their projection less weight");
    addFile(command, "--out", out, "Writes the pose as pose.json");
    addFile(command, "--json", json,
            "Writes the solution: poses, covariances, residuals, influence of each annotation, "
            "warnings (sessions/annotation/solution_file.h)");
  }
};

std::vector<sessions::AnnotatedView> readViews(const SolveArguments& arguments) {
  if (!arguments.rig.empty()) return sessions::readRig(arguments.rig);
  sessions::AnnotatedView view;
  view.name = arguments.points;
  view.camera = sessions::readCamera(std::filesystem::path(arguments.camera));
  view.annotations = sessions::readAnnotations(std::filesystem::path(arguments.points));
  return {view};
}

/// Solves annotations from files, without a mesh or a session.
sessions::CaseAnnotationsSolution solveFiles(const SolveArguments& arguments) {
  sessions::CaseAnnotationsSolution solved;
  solved.annotations.views = readViews(arguments);
  solved.annotations.rigid = !arguments.rig.empty();
  sessions::SolveAnnotationsOptions options;
  options.robust = solved.annotations.robust = arguments.robust;
  if (!arguments.seed.empty()) {
    sessions::PoseFrames frames;
    if (arguments.rig.empty())
      frames =
          arguments.frames.of(sessions::readCameraFile(std::filesystem::path(arguments.camera)));
    options.rig_from_station_guess =
        sessions::readPose(std::filesystem::path(arguments.seed), frames).camera_from_station;
  }
  const auto& views = solved.annotations.views;
  solved.result = sessions::solveAnnotations(views, options);
  const Pose* known = options.rig_from_station_guess ? &*options.rig_from_station_guess : nullptr;
  if (solved.result.solution) known = &solved.result.solution->rig_from_station;
  solved.warnings = sessions::geometryWarnings(views, known, {});
  if (solved.result.solution)
    solved.left_out = sessions::leaveOneOut(views, *solved.result.solution);
  return solved;
}

/// A case of a session, as the desktop program solves it.
sessions::CaseAnnotationsSolution solveSession(const SolveArguments& arguments) {
  const sessions::SessionDocument document = openToRead(arguments.session);
  requireCase(document, arguments.case_id);
  sessions::Session session = document.session();
  session.robust_annotations |= arguments.robust;
  return sessions::solveCaseAnnotations(session, arguments.case_id, !arguments.alone);
}

int solve(const SolveArguments& arguments) {
  if (arguments.rig.empty() && arguments.points.empty() && arguments.session.empty())
    throw CLI::RequiredError("--points and --camera, or --rig, or --session and --case");
  const bool of_session = !arguments.session.empty();
  const sessions::CaseAnnotationsSolution solved =
      of_session ? solveSession(arguments) : solveFiles(arguments);
  requireWritable({arguments.out, arguments.json});
  const auto& views = solved.annotations.views;
  if (!arguments.json.empty())
    sessions::writeSolution(arguments.json, views, solved.result, solved.left_out, solved.warnings,
                            solved.annotations.robust);
  if (!solved.result.solution) {
    note("no pose: " + solved.result.reason);
    return kNotConverged;
  }
  std::cout << sessions::solutionText(views, *solved.result.solution, solved.left_out,
                                      solved.warnings);
  if (!arguments.out.empty())
    sessions::writePose(
        arguments.out,
        of_session ? *solved.camera_from_station() : solved.result.solution->rig_from_station, {},
        of_session ? solved.covariance() : solved.result.solution->covariance);
  return kDone;
}

}  // namespace

void addSolve(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "solve",
             "Solves for the pose from points and lines annotated in the image", solve);
}

}  // namespace boresight::app
