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
  std::string points;
  std::string camera;
  std::string rig;
  std::string session;
  std::string case_id;
  std::string seed;
  std::string out;
  std::string json;
  FrameArguments frames;
  bool alone = false;
  bool robust = false;
};

std::vector<sessions::AnnotatedView> readViews(const SolveArguments& arguments) {
  if (!arguments.rig.empty()) return sessions::readRig(arguments.rig);
  sessions::AnnotatedView view;
  view.name = arguments.points;
  view.camera = sessions::readCamera(std::filesystem::path(arguments.camera));
  view.annotations = sessions::readAnnotations(std::filesystem::path(arguments.points));
  return {view};
}

/// Annotations in files of their own: nothing but they says where the station is.
sessions::CaseAnnotationsSolution solveFiles(const SolveArguments& arguments) {
  sessions::CaseAnnotationsSolution case_annotations_solution;
  case_annotations_solution.annotations.views = readViews(arguments);
  case_annotations_solution.annotations.rigid = !arguments.rig.empty();
  sessions::SolveAnnotationsOptions options;
  options.robust = case_annotations_solution.annotations.robust = arguments.robust;
  if (!arguments.seed.empty()) {
    sessions::PoseFrames frames;
    if (arguments.rig.empty())
      frames =
          arguments.frames.of(sessions::readCameraFile(std::filesystem::path(arguments.camera)));
    options.rig_from_station_guess =
        sessions::readPose(std::filesystem::path(arguments.seed), frames).camera_from_station;
  }
  const auto& views = case_annotations_solution.annotations.views;
  case_annotations_solution.result = sessions::solveAnnotations(views, options);
  const Pose* known = options.rig_from_station_guess ? &*options.rig_from_station_guess : nullptr;
  if (case_annotations_solution.result.solution)
    known = &case_annotations_solution.result.solution->rig_from_station;
  case_annotations_solution.warnings = sessions::geometryWarnings(views, known, {});
  if (case_annotations_solution.result.solution)
    case_annotations_solution.left_out =
        sessions::leaveOneOut(views, *case_annotations_solution.result.solution);
  return case_annotations_solution;
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
  const sessions::CaseAnnotationsSolution case_annotations_solution =
      of_session ? solveSession(arguments) : solveFiles(arguments);
  for (const std::string& file : {arguments.out, arguments.json})
    if (!file.empty()) sessions::requireWritable(file);
  const auto& views = case_annotations_solution.annotations.views;
  if (!arguments.json.empty())
    sessions::writeSolution(arguments.json, views, case_annotations_solution.result,
                            case_annotations_solution.left_out, case_annotations_solution.warnings,
                            case_annotations_solution.annotations.robust);
  if (!case_annotations_solution.result.solution) {
    note("no pose: " + case_annotations_solution.result.reason);
    return kNotConverged;
  }
  std::cout << sessions::solutionText(views, *case_annotations_solution.result.solution,
                                      case_annotations_solution.left_out,
                                      case_annotations_solution.warnings);
  if (!arguments.out.empty())
    sessions::writePose(arguments.out,
                        of_session ? *case_annotations_solution.camera_from_station()
                                   : case_annotations_solution.result.solution->rig_from_station,
                        {},
                        of_session ? case_annotations_solution.covariance()
                                   : case_annotations_solution.result.solution->covariance);
  return kDone;
}

/// Three ways to say what is solved, each of which excludes the others.
void addSources(CLI::App& command, SolveArguments& arguments) {
  CLI::Option* points =
      command.add_option("--points", arguments.points, "points.json or points.csv");
  CLI::Option* camera = command.add_option("--camera", arguments.camera, kCameraHelp);
  CLI::Option* rig = command.add_option(
      "--rig", arguments.rig,
      "rig.json: rigidly joined cameras with their points; the pose is that of the rig");
  CLI::Option* session =
      command.add_option("--session", arguments.session,
                         "Session with the case; solved as in the desktop program: with the "
                         "annotations of its rig's other cases, from its working pose or seed");
  CLI::Option* option = command.add_option("--case", arguments.case_id, "Case");
  CLI::Option* alone =
      command.add_flag("--alone", arguments.alone, "Leave out the other cases of its rig");
  CLI::Option* seed = command.add_option(
      "--seed", arguments.seed, "pose.json to start from, needed if no image has four points");
  for (CLI::Option* file : {points, camera, rig, session, seed}) file->type_name("FILE");
  option->type_name("ID");
  arguments.frames.addTo(command);
  rig->excludes(points)->excludes(camera);
  session->excludes(points)->excludes(camera)->excludes(rig)->excludes(seed);
  session->needs(option);
  option->needs(session);
  alone->needs(session);
  points->needs(camera);
  camera->needs(points);
}

}  // namespace

void addSolve(CLI::App& app, int& exit_code) {
  const auto [command, arguments] =
      addCommand(app, exit_code, "solve",
                 "Solves for the pose from points and lines annotated in the image", solve);
  addSources(*command, *arguments);
  command->add_flag("--robust", arguments->robust,
                    "Give annotations far from their projection less weight");
  addFile(*command, "--out", arguments->out, "Writes the pose as pose.json");
  addFile(*command, "--json", arguments->json,
          "Writes the solution: poses, covariances, residuals, influence of each annotation, "
          "warnings (sessions/annotation/solution_file.h)");
}

}  // namespace boresight::app
