// SPDX-License-Identifier: Apache-2.0
// PnP, checks, onboard records, results files.
#include <nlohmann/json.hpp>

#include "app/python/module.h"
#include "sessions/annotation/solve_annotations.h"
#include "sessions/checks/checks.h"
#include "sessions/decision/decision.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/record/onboard_record.h"

namespace boresight::python {
namespace {

using Path = std::filesystem::path;
using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// As of annotations in files.
constexpr double kLeastSigma_px = 1e-6;
constexpr double kMostSigma_px = 1e4;

py::dict solvePnp(const Rows3& points_in_station_m, const Rows2& pixels, const Path& camera,
                  double sigma_px, bool robust, const std::optional<Eigen::Matrix4d>& guess) {
  if (points_in_station_m.rows() != pixels.rows())
    throw py::value_error("as many pixels as points are needed");
  if (!points_in_station_m.allFinite() || !pixels.allFinite())
    throw py::value_error("points and pixels must be finite");
  if (!(sigma_px >= kLeastSigma_px && sigma_px <= kMostSigma_px))
    throw py::value_error("sigma_px must be from 1e-06 to 10000");
  sessions::AnnotatedView view;
  view.camera = sessions::readCameraFile(camera).camera;
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) {
    sessions::PointPair pair;
    pair.id = "p" + std::to_string(i);
    pair.point_in_station_m = points_in_station_m.row(i).transpose();
    pair.pixel = pixels.row(i).transpose();
    pair.sigma_px = sigma_px;
    view.annotations.points.push_back(std::move(pair));
  }
  sessions::SolveAnnotationsOptions options;
  options.robust = robust;
  if (guess) options.rig_from_station_guess = poseOf(*guess);
  const auto result = sessions::solveAnnotations({&view, 1}, options);
  if (!result.solution) throw py::value_error(result.reason);
  const sessions::AnnotationsSolution& solution = *result.solution;
  py::dict dict;
  dict["camera_from_station"] = matrixOf(solution.rig_from_station);
  dict["covariance"] = solution.covariance;
  dict["rms_px"] = solution.rms_px;
  dict["noise_factor"] = solution.noise_factor;
  Rows2 residuals(pixels.rows(), 2);
  for (Eigen::Index i = 0; i < residuals.rows(); ++i)
    residuals.row(i) =
        solution.annotations[static_cast<std::size_t>(i)].residual_px.transpose();
  dict["residual_px"] = residuals;
  return dict;
}

py::list checkRun(const Run& run, const std::string& preset, int convergence_seeds) {
  if (!run.trace.converged()) throw py::value_error("the run did not converge: no pose to check");
  const sessions::CheckLimits limits = sessions::checkLimits(preset, {});
  const sessions::ReviewSubject subject =
      sessions::runSubject(run.loaded,
                           run.loaded->source.requirement.value_or(
                               sessions::findCheckPreset(preset)->requirement),
                           run.trace);
  std::vector<sessions::Check> checks;
  {
    const py::gil_scoped_release release;
    checks = sessions::checkPose(subject, limits,
                                 sessions::convergenceTest(subject, convergence_seeds));
  }
  py::list list;
  for (const sessions::Check& check : checks)
    list.append(pythonOf(sessions::toJson(sessions::JudgedCheck{check, ""})));
  return list;
}

py::list readRuns(const Path& file) {
  py::list list;
  for (const sessions::RunResult& run : sessions::readResults(file).runs)
    list.append(pythonOf(sessions::toJson(run)));
  return list;
}

py::dict readOnboard(const Path& file) {
  const sessions::OnboardRecord record = sessions::readRecord(file);
  py::dict dict;
  dict["missing"] = record.missing;
  if (record.inputs)
    dict["camera_from_station_seed"] = matrixOf(record.inputs->camera_from_station_seed);
  py::list iterations;
  for (const sessions::RecordedIteration& recorded : record.iterations) {
    py::dict iteration;
    iteration["camera_from_station"] = matrixOf(recorded.trace.camera_from_station);
    iteration["templates"] = recorded.trace.template_count;
    iteration["inliers"] = recorded.trace.pnp.inlier_count;
    iteration["correction_translation_m"] = recorded.trace.correction_translation_m;
    iterations.append(iteration);
  }
  dict["iterations"] = iterations;
  if (!record.end) return dict;
  dict["status"] = localizationStatusText(record.end->status);
  dict["digest"] = record.end->digest;
  dict["camera_from_station"] = matrixOf(record.end->camera_from_station);
  dict["covariance"] = record.end->covariance;
  return dict;
}

}  // namespace

void addResults(py::module_& module) {
  module.def("solve_pnp", &solvePnp, py::arg("points_in_station_m"), py::arg("pixels"),
             py::arg("camera"), py::arg("sigma_px") = 1.0, py::arg("robust") = false,
             py::arg("guess") = std::nullopt,
             "Pose of a camera (a camera.json) from points (n, 3) and pixels (n, 2), with "
             "covariance and residuals.");
  module.def("check", &checkRun, py::arg("run"), py::arg("preset") = "sample_transfer",
             py::arg("convergence_seeds") = 0,
             "Checks of a run's pose, as *Review* lists them: a list of dicts.");
  module.def("read_results", &readRuns, py::arg("file"),
             "Runs of a results file of `whs evaluate`: a list of dicts.");
  module.def("read_record", &readOnboard, py::arg("file"), "An onboard record.");
}

}  // namespace boresight::python
