// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/run/runner.h"
#include "sessions/session/pose_comparer.h"
#include "sessions/session/session_maker.h"
#include "sessions/session/views_run.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

using nlohmann::ordered_json;
using sessions::fixedText;

struct ViewsArguments {
  std::string dataset, out;
  std::vector<std::string> rigs;
  OptionArguments options;
  int threads = 0;
  Kernels kernels = bestKernels();

  void addTo(CLI::App& command) {
    addFile(command, "--dataset", dataset, "dataset.json with cases that have rigs")->required();
    addOption(command, "--rig", "ID", rigs, "Rig to localize; may be repeated (default: all)");
    options.addTo(command);
    addThreads(command, threads);
    addKernels(command, kernels);
    addFile(command, "--out", out, "Writes the results as JSON");
  }
};

/// One rig, solved from the seed of its first case.
struct RigRun {
  std::string rig;
  std::vector<const sessions::Case*> cases;       ///< of the dataset, in its order
  std::vector<sessions::PoseComparer> comparers;  ///< of the cases
  sessions::JointResult joint;
  double seconds = 0.0;

  bool converged() const { return joint.result.status == LocalizationStatus::kConverged; }
  /// At the end effector, or at the camera; nothing without a pose or a truth.
  std::optional<sessions::PoseError> errorOf(std::size_t view) const {
    const sessions::Case& dataset_case = *cases[view];
    if (!converged() || !dataset_case.truth_camera_from_station) return std::nullopt;
    return comparers[view].difference(*dataset_case.truth_camera_from_station,
                                      joint.result.views[view].camera_from_station);
  }
};

/// In the order of their first cases.
std::vector<std::string> rigIds(const sessions::Dataset& dataset) {
  std::vector<std::string> ids;
  for (const sessions::Case& dataset_case : dataset.cases)
    if (dataset_case.rig && std::find(ids.begin(), ids.end(), dataset_case.rig->id) == ids.end())
      ids.push_back(dataset_case.rig->id);
  return ids;
}

/// InputError when the dataset has no such rig, or its views cannot be solved together.
RigRun runRig(const sessions::Dataset& dataset, const std::string& rig,
              const ViewsArguments& arguments, LocalizerOptions options) {
  RigRun run;
  run.rig = rig;
  std::vector<std::string> ids;
  for (const sessions::Case& dataset_case : dataset.cases)
    if (dataset_case.rig && dataset_case.rig->id == rig) {
      run.cases.push_back(&dataset_case);
      ids.push_back(dataset_case.id);
    }
  const std::string place = "rig \"" + rig + "\"";
  if (ids.empty()) throw sessions::InputError(dataset.file, place, "no case names it");
  const sessions::Session session = sessions::makeSession(dataset, ids);
  const std::string alone = ids.size() > 1 ? sessions::whyAlone(session, ids.front()) : "";
  if (!alone.empty()) throw sessions::InputError(dataset.file, place, alone);
  const sessions::SessionCase& first = *session.cases.front();
  const auto first_loaded = sessions::loadCase(first);
  for (const auto& session_case : session.cases)
    run.comparers.emplace_back(*session_case, first_loaded->scene.view());
  const auto loaded = sessions::loadViews(first_loaded, sessions::otherViews(session, ids.front()));
  if (options.templates.feature_size_m == 0.0)
    options.templates.feature_size_m = first.feature_size_m.value_or(0.0);
  sessions::Runner runner(loaded->problem(), options, ids,
                          {.level = sessions::RecordLevel::kSummary,
                           .threads = arguments.threads,
                           .kernels = arguments.kernels});
  runner.advance(sessions::StepUntil::kEnd);
  run.joint = runner.joint();
  run.seconds = runner.trace().seconds.total();
  return run;
}

void printRig(const RigRun& run) {
  const ViewsResult& result = run.joint.result;
  print(run.rig + ": " + localizationStatusText(result.status) + " in " +
        std::to_string(result.iterations) + " iterations, " + fixedText(run.seconds, 2) + " s");
  if (result.status == LocalizationStatus::kFault)
    print(std::string("  ") + statusText(result.fault));
  for (std::size_t v = 0; v < run.cases.size(); ++v) {
    const ViewReport& view = result.views[v];
    std::string error_text;
    if (const auto error = run.errorOf(v))
      error_text = std::string("; error at the ") +
                   sessions::judgedPlace(run.cases[v]->camera_from_end_effector) + ": " +
                   errorText(*error);
    print("  " + run.cases[v]->id + " (" + run.cases[v]->camera +
          "): " + localizationStatusText(view.status) + ", " + std::to_string(view.inliers) +
          " of " + std::to_string(view.correspondences) + " matches agree, " +
          std::to_string(view.edges_used) + " edge points, edge support " +
          sessions::percentText(view.support.share(), 1) + error_text);
  }
}

ordered_json viewJson(const RigRun& run, std::size_t v) {
  const ViewReport& report = run.joint.result.views[v];
  ordered_json json = {{"case", run.cases[v]->id},
                       {"camera", run.cases[v]->camera},
                       {"status", localizationStatusText(report.status)},
                       {"matches", report.correspondences},
                       {"inliers", report.inliers},
                       {"edges_used", report.edges_used},
                       {"edges_rms_px", report.edges_rms_px},
                       {"edge_support", report.support.share()}};
  if (run.converged()) json["camera_from_station"] = sessions::toJson(report.camera_from_station);
  if (const auto error = run.errorOf(v)) json["error"] = sessions::toJson(*error);
  return json;
}

/// Pose and covariance in the rig's frame, and each view with its errors where it has a truth.
ordered_json toJson(const RigRun& run) {
  const ViewsResult& result = run.joint.result;
  ordered_json json = {{"rig", run.rig},
                       {"status", localizationStatusText(result.status)},
                       {"iterations", result.iterations},
                       {"attempts", result.attempts},
                       {"rig_from_station", sessions::toJson(result.rig_from_station)}};
  if (result.status == LocalizationStatus::kFault) json["fault"] = statusText(result.fault);
  if (run.converged()) json["covariance"] = sessions::toJson(result.covariance);
  json["views"] = ordered_json::array();
  for (std::size_t v = 0; v < run.cases.size(); ++v) json["views"].push_back(viewJson(run, v));
  json["seconds"] = run.seconds;
  json["digest"] = run.joint.digest;
  return json;
}

int localizeRigs(const ViewsArguments& arguments) {
  const LocalizerOptions options = arguments.options.read();
  arguments.options.noteUnlimited();
  const sessions::Dataset dataset = sessions::readDataset(arguments.dataset);
  requireWritable({arguments.out});
  for (const std::string& line : dataset.notes) note(line);
  const std::vector<std::string> ids = arguments.rigs.empty() ? rigIds(dataset) : arguments.rigs;
  if (ids.empty()) throw sessions::InputError(dataset.file, "cases", "none has a rig");
  ordered_json json = {{"format", "boresight-views-result"}, {"version", 1}};
  json["rigs"] = ordered_json::array();
  bool all_converged = true;
  for (const std::string& id : ids) {
    const RigRun run = runRig(dataset, id, arguments, options);
    printRig(run);
    json["rigs"].push_back(toJson(run));
    all_converged = all_converged && run.converged();
  }
  if (!arguments.out.empty()) sessions::writeJsonFile(arguments.out, json);
  return all_converged ? kDone : kNotConverged;
}

}  // namespace

void addViews(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "views",
             "Solves for one pose from several images: cases of a dataset that share a rig "
             "(joined cameras, or one camera on an arm)",
             localizeRigs);
}

}  // namespace boresight::app
