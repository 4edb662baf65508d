// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <vector>

#include "app/commands.h"
#include "sessions/annotation/marks_file.h"
#include "sessions/annotation/rig_file.h"
#include "sessions/annotation/solution_text.h"
#include "sessions/annotation/solve_marks.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/pose_file.h"

namespace boresight::app {
namespace {

struct SolveArguments {
  std::string points;
  std::string camera;
  std::string rig;
  std::string seed;
  std::string out;
  bool robust = false;
};

std::vector<sessions::MarkedView> readViews(const SolveArguments& arguments) {
  if (!arguments.rig.empty()) return sessions::readRig(arguments.rig);
  sessions::MarkedView view;
  view.name = arguments.points;
  view.camera = sessions::readCamera(std::filesystem::path(arguments.camera));
  view.marks = sessions::readMarks(std::filesystem::path(arguments.points));
  return {view};
}

int solve(const SolveArguments& arguments) {
  if (!arguments.out.empty()) sessions::requireWritable(arguments.out);
  const std::vector<sessions::MarkedView> views = readViews(arguments);
  sessions::SolveMarksOptions options;
  options.robust = arguments.robust;
  if (!arguments.seed.empty())
    options.rig_from_station_guess =
        sessions::readPose(std::filesystem::path(arguments.seed)).camera_from_station;
  const sessions::MarksResult result = sessions::solveMarks(views, options);
  if (!result.solution) {
    note("no pose: " + result.reason);
    return kNotConverged;
  }
  std::cout << sessions::solutionText(views, *result.solution);
  if (!arguments.out.empty()) sessions::writePose(arguments.out, result.solution->rig_from_station);
  return kDone;
}

}  // namespace

void addSolve(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "solve", "Finds the pose from points and lines that somebody marked in the image");
  auto arguments = std::make_shared<SolveArguments>();
  CLI::Option* points =
      command->add_option("--points", arguments->points, "points.json")->type_name("FILE");
  CLI::Option* camera =
      command->add_option("--camera", arguments->camera, "camera.json")->type_name("FILE");
  CLI::Option* rig = command->add_option("--rig", arguments->rig,
                                         "rig.json: cameras that moved as one, with their points; "
                                         "the pose is the rig's");
  rig->type_name("FILE")->excludes(points)->excludes(camera);
  points->needs(camera);
  camera->needs(points);
  command
      ->add_option("--seed", arguments->seed,
                   "pose.json to start from, where no image has four points")
      ->type_name("FILE");
  command->add_flag("--robust", arguments->robust, "Points far from their projection count less");
  command->add_option("--out", arguments->out, "Writes the pose as pose.json")->type_name("FILE");
  command->callback([arguments, &exit_code] {
    if (arguments->rig.empty() && arguments->points.empty())
      throw CLI::RequiredError("--points and --camera, or --rig");
    exit_code = solve(*arguments);
  });
}

}  // namespace boresight::app
