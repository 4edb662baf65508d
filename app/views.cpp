// SPDX-License-Identifier: Apache-2.0

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/rig_views.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_writer.h"
#include "sessions/session/views_run.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

struct ViewsArguments {
  std::string dataset, out;
  std::vector<std::string> rigs;
  OptionArguments options;
  int threads = 0;
  Kernels kernels = bestKernels();
};

std::string errorText(const sessions::PoseError& error,
                      const std::optional<Pose>& camera_from_end_effector) {
  using sessions::fixedText;
  return std::string("; off the truth at the ") + sessions::judgedPlace(camera_from_end_effector) +
         ": normal " + fixedText(error.normal_mm, 3) + " mm, lateral " +
         fixedText(error.lateral_mm, 3) + " mm, rotation " + fixedText(error.rotation_mrad, 3) +
         " mrad";
}

void printRig(const sessions::RigViews& rig, const sessions::RigRun& run) {
  using sessions::fixedText;
  const bool converged = run.result.status == LocalizationStatus::kConverged;
  print(rig.id + ": " + localizationStatusText(run.result.status) + " in " +
        std::to_string(run.result.iterations) + " iterations, " + fixedText(run.seconds, 2) + " s");
  if (run.result.status == LocalizationStatus::kFault)
    print(std::string("  ") + statusText(run.result.fault));
  for (std::size_t v = 0; v < run.views; ++v) {
    const ViewReport& view = run.result.views[v];
    const auto error = converged ? sessions::viewError(rig, run, v) : std::nullopt;
    print("  " + rig.cases[v]->id + " (" + rig.cases[v]->camera +
          "): " + localizationStatusText(view.status) + ", " + std::to_string(view.inliers) +
          " of " + std::to_string(view.correspondences) + " matches agree, " +
          std::to_string(view.edges_used) + " edge places, edge support " +
          fixedText(100.0 * view.support.share(), 1) + " %" +
          (error ? errorText(*error, rig.cases[v]->camera_from_end_effector) : ""));
  }
}

void requireOffered(const LocalizerOptions& options) {
  const std::string refusal = sessions::viewsRefusal(options);
  if (!refusal.empty()) throw CLI::ValidationError("--set", refusal);
}

int localizeRigs(const ViewsArguments& arguments) {
  const LocalizerOptions options = arguments.options.read();
  requireOffered(options);
  const sessions::Dataset dataset = sessions::readDataset(arguments.dataset);
  if (!arguments.out.empty()) sessions::requireWritable(arguments.out);
  for (const std::string& line : dataset.notes) note(line);
  const std::vector<std::string> ids =
      arguments.rigs.empty() ? sessions::rigIds(dataset) : arguments.rigs;
  if (ids.empty()) throw sessions::InputError(dataset.file, "cases", "none has a rig");
  nlohmann::ordered_json json = {{"format", "boresight-views-result"}, {"version", 1}};
  json["rigs"] = nlohmann::ordered_json::array();
  bool all_converged = true;
  for (const std::string& id : ids) {
    const sessions::RigViews rig = sessions::readRigViews(dataset, id);
    const sessions::RigRun run = sessions::localizeViews(
        rig, options, {.threads = arguments.threads, .kernels = arguments.kernels});
    printRig(rig, run);
    json["rigs"].push_back(sessions::toJson(rig, run));
    all_converged = all_converged && run.result.status == LocalizationStatus::kConverged;
  }
  if (!arguments.out.empty()) sessions::writeJsonFile(arguments.out, json);
  return all_converged ? kDone : kNotConverged;
}

}  // namespace

void addViews(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "views",
      "Finds one pose from several images: the cases of a dataset that share a rig, i.e. cameras "
      "of a rigid rig, or one camera at known places of its arm",
      localizeRigs);
  addFile(*command, "--dataset", arguments->dataset, "dataset.json whose cases name rigs")
      ->required();
  command->add_option("--rig", arguments->rigs, "Which of its rigs; without it all")
      ->type_name("ID");
  arguments->options.addTo(*command);
  addThreads(*command, arguments->threads);
  addKernels(*command, arguments->kernels);
  addFile(*command, "--out", arguments->out, "Writes the results as JSON");
}

}  // namespace boresight::app
