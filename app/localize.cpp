// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <optional>

#include "app/case_arguments.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/checks/review_subject.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/report/result_file.h"
#include "sessions/run/image_quality.h"
#include "sessions/run/problem.h"
#include "sessions/run/runner.h"
#include "sessions/session/named_poses.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/doubtful_pose.h"
#include "sessions/trace/overlay.h"
#include "sessions/trace/run_text.h"
#include "sessions/trace/trace_file.h"

namespace boresight::app {
namespace {

struct LocalizeArguments : CaseArguments {
  MethodArguments method;
  int threads = 0;
  Kernels kernels = bestKernels();
  std::string out, trace, record, overlay;

  void addTo(CLI::App& command) {
    CaseArguments::addTo(command);
    addUncertaintyTo(command);
    addTruthTo(command);
    addEndEffectorTo(command);
    addRequirementTo(command);
    for (const char* name : {"--image", "--mesh"}) command.get_option(name)->required();
    method.addTo(command, false);
    addThreads(command, threads);
    addKernels(command, kernels);
    addFile(command, "--out", out, "Writes the result as JSON");
    addFile(command, "--trace", trace, "Writes all intermediate results (binary)");
    addFile(command, "--record", record,
            "Writes the onboard record of the run, run.whsr (core/record/FORMAT.md)");
    addFile(command, "--overlay", overlay,
            "Writes a PNG: seed orange, result blue, truth white over the image");
  }
};

sessions::RunProvenance provenance(const LocalizeArguments& arguments, const ReadCase& input,
                                   const LocalizerOptions& options) {
  sessions::RunProvenance run_provenance;
  run_provenance.method = arguments.method.methods.front();
  run_provenance.profile = arguments.options.profileName();
  run_provenance.changed_options =
      sessions::changedOptions(options, profileOptions(run_provenance.profile));
  for (auto& option : arguments.method.changedOptions(arguments.options.readMethodOptions()))
    run_provenance.changed_options.push_back(std::move(option));
  run_provenance.loaded = input.loaded.get();
  run_provenance.camera_file = arguments.cameraFile();
  run_provenance.seed_file = arguments.seedFile();
  run_provenance.truth_file = arguments.truth;
  run_provenance.config_file = arguments.options.config;
  run_provenance.warnings = input.notes;
  return run_provenance;
}

void writeOverlay(const std::string& file, const sessions::LoadedCase& loaded,
                  const sessions::LocalizationTrace& trace) {
  const sessions::SessionCase& session_case = loaded.source;
  std::vector<sessions::OverlayLayer> layers = {
      {"seed", session_case.camera_from_station_seed, sessions::kSeedColor}};
  if (trace.converged()) {
    layers.push_back({"result", trace.camera_from_station, sessions::kResultColor});
  } else if (const auto doubtful = sessions::doubtfulPose(trace)) {
    layers.push_back({"doubtful pose, " + sessions::probabilityPercent(doubtful->probability),
                      doubtful->camera_from_station, sessions::kDoubtfulColor});
  } else if (!trace.iterations.empty()) {
    layers.push_back({std::string("last hypothesis, ") + localizationStatusText(trace.status),
                      trace.iterations.back()->camera_from_station, sessions::kResultColor});
  }
  if (session_case.camera_from_station_truth)
    layers.push_back(
        {"truth", *session_case.camera_from_station_truth, sessions::kTruthColor, true});
  sessions::writeColorPng(file, sessions::drawOverlay(loaded.image.view(), session_case.camera,
                                                      loaded.scene.view(), layers));
}

/// The pose in the frames that have names.
void printNamedPoses(const sessions::SessionCase& session_case, const Pose& camera_from_station,
                     const Matrix6d& covariance) {
  for (const sessions::NamedPose& pose :
       sessions::namedPoses(session_case, camera_from_station, covariance))
    std::cout << "\n"
              << sessions::poseText(pose.reference_from_station, *pose.covariance,
                                    sessions::namedPoseTitle(pose),
                                    "origin of " + frameText(pose.frame));
}

/// Of a case with an end effector, in the frame that is named last.
void printCorrection(const sessions::LoadedCase& loaded, const sessions::LocalizationTrace& trace) {
  const sessions::SessionCase& session_case = loaded.source;
  if (!session_case.camera_from_end_effector) return;
  const Pose& pose = trace.camera_from_station;
  const Matrix6d covariance =
      sessions::poseCovariance(session_case, loaded.scene.view(), pose, trace.covariance).total();
  for (const sessions::Correction& correction :
       sessions::correctionsOf(session_case, pose, covariance))
    std::cout << "\n" << sessions::correctionText(correction);
}

void printResult(const sessions::LocalizationTrace& trace, const sessions::LoadedCase& loaded,
                 const std::optional<sessions::ImageQuality>& quality,
                 const std::optional<sessions::PoseError>& error) {
  using sessions::fixedText;
  const sessions::SessionCase& session_case = loaded.source;
  std::cout << sessions::iterationTable(trace) << "\n";
  std::cout << "image at the seed: " << sessions::imageQualityText(quality) << "\n";
  if (trace.converged()) {
    std::cout << "converged in " << trace.iterations.size() << " iterations, edge support "
              << sessions::percentText(trace.support.share(), 1) << ", "
              << fixedText(trace.seconds.total(), 2) << " s\n"
              << sessions::acceptanceText(trace) << "\n\n"
              << sessions::poseText(trace.camera_from_station, trace.covariance)
              << "(from the image only; errors of the mesh's scale and of the calibration are not "
                 "included)\n";
    printNamedPoses(session_case, trace.camera_from_station, trace.covariance);
    printCorrection(loaded, trace);
  } else {
    std::cout << "not converged: " << localizationStatusText(trace.status)
              << "; the best estimate remains the seed\n";
    if (const std::string text = sessions::acceptanceText(trace); !text.empty())
      std::cout << text << "\n";
  }
  if (error) {
    std::cout << (trace.converged() ? "against the truth" : "the seed against the truth")
              << " (at the camera): " << errorText(*error);
    if (error->projection_px)
      std::cout << ", projection " << fixedText(*error->projection_px, 2) << " px";
    std::cout << "\n";
  }
  if (!trace.digest.empty()) std::cout << "digest " << trace.digest << std::endl;
}

/// A fault is the input's or the program's, unless the options give too little room.
int exitCodeOf(const sessions::LocalizationTrace& trace) {
  if (trace.converged()) return kDone;
  if (trace.status != LocalizationStatus::kFault) return kNotConverged;
  const bool too_little =
      trace.fault == Status::kCapacityExceeded || trace.fault == Status::kArenaTooSmall;
  return too_little ? kNotConverged : kInternalFault;
}

/// Most that is downlinked of a run.
constexpr std::size_t kRecordRoomBytes = 64000;

void writeRecord(const std::string& file, const RecordWriter& record) {
  if (!record.complete())
    note("the onboard record is too small for the whole run; it lists the missing parts");
  sessions::writeFileAtomically(file, record.bytes());
}

int localizeImage(const LocalizeArguments& arguments) {
  if (!arguments.record.empty() && arguments.method.needsSetup())
    throw CLI::ValidationError("--record", "onboard records exist only for --method whs");
  arguments.requireSeed();
  const ReadCase input = readCase(arguments);
  const sessions::LoadedCase& loaded = *input.loaded;
  const LocalizerOptions options = arguments.optionsOf(loaded.source);
  requireWritable({arguments.out, arguments.trace, arguments.record, arguments.overlay});
  requireRunnable(loaded, arguments.cameraFile(), arguments.seedFile());
  for (const std::string& line : input.notes) note(line);
  sessions::RunSettings settings;
  settings.level =
      arguments.trace.empty() ? sessions::RecordLevel::kSummary : sessions::RecordLevel::kFull;
  settings.memory_limit = arguments.options.memoryLimit();
  settings.threads = arguments.threads;
  settings.kernels = arguments.kernels;
  settings.albedo_of_part = loaded.scene.albedo_of_part;
  std::vector<std::uint8_t> onboard(arguments.record.empty() ? 0 : kRecordRoomBytes);
  RecordWriter record(onboard);
  if (!arguments.record.empty()) settings.onboard_record = &record;
  sessions::Methods methods(arguments.method.setup(arguments.options));
  const sessions::LocalizationTrace trace =
      methods.localize(arguments.method.methods.front(), loaded.problem(), options, settings);
  sessions::requireAccepted(trace, {{arguments.image, ""},
                                    {arguments.cameraFile(), ""},
                                    {arguments.mesh, ""},
                                    {arguments.seedFile(), ""}});
  const auto error = sessions::truthError(loaded, trace.camera_from_station);
  printResult(trace, loaded, sessions::imageQualityOf(loaded.problem()), error);
  if (settings.memory_limit > 0) std::cout << "\n" << sessions::memoryTable(trace) << std::flush;
  if (!arguments.out.empty())
    sessions::writeJsonFile(
        arguments.out, sessions::resultJson(trace, error, provenance(arguments, input, options)));
  if (!arguments.trace.empty()) sessions::saveTrace(arguments.trace, trace);
  if (!arguments.record.empty()) writeRecord(arguments.record, record);
  if (!arguments.overlay.empty()) writeOverlay(arguments.overlay, loaded, trace);
  if (!trace.converged())
    note(std::string(localizationStatusText(trace.status)) + ": " + sessions::explanation(trace));
  return exitCodeOf(trace);
}

}  // namespace

void addLocalize(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "localize",
             "Finds the camera's pose relative to a station in one image, from a seed",
             localizeImage);
}

}  // namespace boresight::app
