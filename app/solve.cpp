// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <vector>

#include "app/commands.h"
#include "core/pnp/pnp.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/points_file.h"
#include "sessions/report/run_text.h"
#include "sessions/report/text_table.h"

namespace boresight::app {
namespace {

constexpr std::size_t kFewestPoints = 4;

struct SolveArguments {
  std::string points;
  std::string camera;
  std::string out;
  double threshold_px = 8.0;
};

/// The enabled points of a file, and the pose that agrees with most of them.
struct Solution {
  std::vector<sessions::PointPair> points;
  std::vector<Correspondence> correspondences;
  std::vector<std::uint8_t> inlier;
  std::vector<double> residual_px;
  PnpSolution pnp;
};

Solution readEnabledPoints(const std::string& file) {
  Solution solution;
  for (const sessions::PointPair& point : sessions::readPoints(file)) {
    if (!point.enabled) continue;
    solution.points.push_back(point);
    solution.correspondences.push_back({point.point_in_station_m, point.pixel, point.sigma_px});
  }
  if (solution.points.size() < kFewestPoints)
    throw sessions::InputError(file, "points",
                               std::to_string(solution.points.size()) +
                                   " enabled points, a pose needs at least " +
                                   std::to_string(kFewestPoints));
  return solution;
}

Status solvePose(const Camera& camera, double threshold_px, Solution& solution) {
  const std::size_t count = solution.points.size();
  solution.inlier.resize(count);
  solution.residual_px.resize(count);
  solution.pnp.inlier = solution.inlier;
  solution.pnp.residual_px = solution.residual_px;
  Arena counter;
  PnpRansac counted;
  Status status = counted.create(static_cast<int>(count), counter);
  if (status != Status::kOk) return status;
  std::vector<std::byte> memory(counter.highWater() + Arena::kAlignment);
  Arena arena(memory);
  PnpRansac ransac;
  status = ransac.create(static_cast<int>(count), arena);
  if (status != Status::kOk) return status;
  PnpOptions options;
  options.sampler = PnpSampler::kP3p;
  options.min_inliers = static_cast<std::int32_t>(kFewestPoints);
  options.max_samples = 5000;
  status = ransac.begin(solution.correspondences, camera, {}, threshold_px, options, solution.pnp);
  bool done = false;
  while (status == Status::kOk && !done) status = ransac.step(done);
  return status;
}

void printSolution(const Camera& camera, const Solution& solution) {
  using sessions::fixedText;
  sessions::TextTable table({"point", "x px", "y px", "dx px", "dy px", "residual px", "used"});
  for (std::size_t i = 0; i < solution.points.size(); ++i) {
    const sessions::PointPair& point = solution.points[i];
    Eigen::Vector2d pixel;
    const bool seen =
        project(camera, solution.pnp.camera_from_station * point.point_in_station_m, pixel);
    const Eigen::Vector2d shift =
        seen ? Eigen::Vector2d(point.pixel - pixel) : Eigen::Vector2d::Constant(std::nan(""));
    table.add({point.id, fixedText(point.pixel.x(), 2), fixedText(point.pixel.y(), 2),
               fixedText(shift.x(), 3), fixedText(shift.y(), 3), fixedText(shift.norm(), 3),
               solution.inlier[i] != 0 ? "yes" : "no"});
  }
  std::cout << table.text() << "\n"
            << solution.pnp.inlier_count << " of " << solution.points.size() << " points used, rms "
            << fixedText(solution.pnp.rms_px, 3) << " px\n\n"
            << sessions::poseText(solution.pnp.camera_from_station, solution.pnp.covariance);
}

int solve(const SolveArguments& arguments) {
  if (!arguments.out.empty()) sessions::requireWritable(arguments.out);
  const Camera camera = sessions::readCamera(std::filesystem::path(arguments.camera));
  Solution solution = readEnabledPoints(arguments.points);
  const Status status = solvePose(camera, arguments.threshold_px, solution);
  if (status != Status::kOk) {
    note(std::string("no pose: ") + statusText(status) + "; " +
         std::to_string(solution.points.size()) + " points were given, at least " +
         std::to_string(kFewestPoints) + " must agree within " +
         sessions::fixedText(arguments.threshold_px, 1) +
         " px; check that the points are not on one line and that no pair is mixed up");
    return kNotConverged;
  }
  printSolution(camera, solution);
  if (!arguments.out.empty()) sessions::writePose(arguments.out, solution.pnp.camera_from_station);
  return kDone;
}

}  // namespace

void addSolve(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("solve", "Finds the pose from points that somebody marked in the image");
  auto arguments = std::make_shared<SolveArguments>();
  command->add_option("--points", arguments->points, "points.json")->required()->type_name("FILE");
  command->add_option("--camera", arguments->camera, "camera.json")->required()->type_name("FILE");
  command->add_option("--out", arguments->out, "Writes the pose as pose.json")->type_name("FILE");
  command
      ->add_option("--threshold", arguments->threshold_px,
                   "Points further from their projection than this are not used, px")
      ->check(CLI::Range(0.01, 10000.0))
      ->capture_default_str()
      ->type_name("PX");
  command->callback([arguments, &exit_code] { exit_code = solve(*arguments); });
}

}  // namespace boresight::app
