// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <optional>

#include "app/commands.h"
#include "app/problem_inputs.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/image_file.h"
#include "sessions/report/result_file.h"
#include "sessions/run/overlay.h"
#include "sessions/run/problem.h"
#include "sessions/run/run_text.h"
#include "sessions/run/runner.h"
#include "sessions/run/trace_file.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/named_poses.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

struct LocalizeArguments : InputArguments {
  std::string truth;
  MethodArguments method;
  int threads = 0;
  Kernels kernels = bestKernels();
  std::string out, trace, record, overlay;

  void addTo(CLI::App& command);
};

struct Inputs : ProblemInputs {
  std::optional<sessions::PoseFile> truth;
};

void LocalizeArguments::addTo(CLI::App& command) {
  InputArguments::addTo(command);
  addFile(command, "--truth", truth,
          "pose.json with the true pose: errors are printed, an overlay shows it");
  method.addTo(command, false);
  addThreads(command, threads);
  addKernels(command, kernels);
  addFile(command, "--out", out, "Writes the result as JSON");
  addFile(command, "--trace", trace, "Writes everything in between (binary)");
  addFile(command, "--record", record,
          "Writes the onboard record of the run, run.whsr (core/record/FORMAT.md)");
  addFile(command, "--overlay", overlay,
          "Writes a PNG: seed red, result green, truth blue over the image");
}

/// In what the image's label contradicts what was given.
std::vector<std::string> labelWarnings(const LocalizeArguments& arguments, const Inputs& inputs) {
  sessions::SessionCase given;
  given.image.source.file = arguments.image;
  given.camera = inputs.camera;
  given.camera_reference = inputs.frames.reference;
  given.camera_from_station_seed = inputs.seed.camera_from_station;
  given.station_frame = inputs.seed.station_frame;
  if (inputs.truth) given.truth_frame = inputs.truth->station_frame;
  return sessions::labelWarnings(given);
}

Inputs readInputs(const LocalizeArguments& arguments) {
  Inputs inputs{readProblemInputs(arguments), std::nullopt};
  if (!arguments.truth.empty())
    inputs.truth = sessions::readPose(std::filesystem::path(arguments.truth), inputs.frames);
  for (const std::string& warning : labelWarnings(arguments, inputs))
    inputs.notes.push_back(warning);
  return inputs;
}

sessions::RunProvenance provenance(const LocalizeArguments& arguments, const Inputs& inputs) {
  sessions::RunProvenance made;
  made.method = arguments.method.methods.front();
  made.profile = arguments.options.profileName();
  made.changed_options = sessions::changedOptions(inputs.options, profileOptions(made.profile));
  for (auto& option : arguments.method.changedOptions(arguments.options.readMethodOptions()))
    made.changed_options.push_back(std::move(option));
  made.uncertainty = inputs.uncertainty;
  made.image = &inputs.image;
  made.scene = &inputs.scene;
  made.ignore = inputs.ignore_mask ? &*inputs.ignore_mask : nullptr;
  made.camera_file = arguments.cameraFile();
  if (inputs.image.label) made.image_label = inputs.image.label->identifiers;
  made.station_frame = inputs.seed.station_frame;
  made.camera_reference = inputs.frames.reference;
  made.seed_file = arguments.seed;
  made.truth_file = arguments.truth;
  made.config_file = arguments.options.config;
  made.warnings = inputs.notes;
  return made;
}

void writeOverlay(const std::string& file, const Inputs& inputs,
                  const sessions::LocalizationTrace& trace) {
  std::vector<sessions::OverlayLayer> layers = {
      {"seed", inputs.seed.camera_from_station, sessions::kSeedColor}};
  if (trace.converged()) {
    layers.push_back({"result", trace.camera_from_station, sessions::kResultColor});
  } else if (!trace.iterations.empty()) {
    layers.push_back({std::string("last hypothesis, ") + localizationStatusText(trace.status),
                      trace.iterations.back()->camera_from_station, sessions::kResultColor});
  }
  if (inputs.truth)
    layers.push_back({"truth", inputs.truth->camera_from_station, sessions::kTruthColor, true});
  sessions::writeColorPng(
      file, sessions::drawOverlay(inputs.image.view(), inputs.camera, inputs.scene.view(), layers));
}

std::optional<sessions::PoseError> errorAgainstTruth(const Inputs& inputs, const Pose& estimate) {
  if (!inputs.truth) return std::nullopt;
  const Pose& truth = inputs.truth->camera_from_station;
  sessions::PoseError error = sessions::poseError(truth, estimate, std::nullopt);
  error.projection_px = sessions::projectionError(inputs.camera, truth, estimate,
                                                  sessions::matchedVertices(inputs.scene.view()));
  return error;
}

/// The pose in the frames that have names.
void printNamedPoses(const Inputs& inputs, const Pose& camera_from_station) {
  for (const sessions::NamedPose& pose : sessions::namedPoses(
           inputs.frames.reference, inputs.seed.station_frame, camera_from_station))
    std::cout << "\n"
              << sessions::poseText(pose.reference_from_station, Matrix6d::Zero(),
                                    sessions::namedPoseTitle(pose));
}

void printResult(const sessions::LocalizationTrace& trace, const Inputs& inputs,
                 const std::optional<sessions::PoseError>& error) {
  using sessions::fixedText;
  std::cout << sessions::iterationTable(trace) << "\n";
  if (trace.converged()) {
    std::cout << "converged in " << trace.iterations.size() << " iterations, edge support "
              << fixedText(100.0 * trace.support.share(), 1) << " %, "
              << (trace.evidence.places > 0
                      ? "probability " + fixedText(100.0 * trace.probability, 1) + " %, "
                      : std::string())
              << fixedText(trace.seconds.total(), 2) << " s\n\n"
              << sessions::poseText(trace.camera_from_station, trace.covariance)
              << "(by the picture alone: errors of the mesh's scale and of the calibration are not "
                 "in it)\n";
    printNamedPoses(inputs, trace.camera_from_station);
  } else {
    std::cout << "not converged: " << localizationStatusText(trace.status)
              << "; the best estimate remains the seed\n";
  }
  if (error) {
    std::cout << (trace.converged() ? "against the truth" : "the seed against the truth")
              << " (at the camera): normal " << fixedText(error->normal_mm, 3) << " mm, lateral "
              << fixedText(error->lateral_mm, 3) << " mm, rotation "
              << fixedText(error->rotation_mrad, 3) << " mrad";
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
    note("the onboard record has no room for some of the run; it says what is missing");
  sessions::writeFileAtomically(file, record.bytes());
}

int localizeImage(const LocalizeArguments& arguments) {
  if (!arguments.record.empty() && arguments.method.needsSetup())
    throw CLI::ValidationError("--record", "the onboard record is of runs with --method whs alone");
  const Inputs inputs = readInputs(arguments);
  for (const std::string& file :
       {arguments.out, arguments.trace, arguments.record, arguments.overlay})
    if (!file.empty()) sessions::requireWritable(file);
  requireSensibleSeed(inputs, arguments.seed);
  for (const std::string& line : inputs.notes) note(line);
  sessions::RunSettings settings;
  settings.level =
      arguments.trace.empty() ? sessions::RecordLevel::kSummary : sessions::RecordLevel::kFull;
  settings.memory_limit = arguments.options.memoryLimit();
  settings.threads = arguments.threads;
  settings.kernels = arguments.kernels;
  std::vector<std::uint8_t> onboard(arguments.record.empty() ? 0 : kRecordRoomBytes);
  RecordWriter record(onboard);
  if (!arguments.record.empty()) settings.onboard_record = &record;
  sessions::Methods methods(arguments.method.setup(arguments.options));
  const sessions::LocalizationTrace trace = methods.localize(
      arguments.method.methods.front(), inputs.problem(), inputs.options, settings);
  sessions::requireAccepted(trace, {{arguments.image, ""},
                                    {arguments.cameraFile(), ""},
                                    {arguments.mesh.mesh, ""},
                                    {arguments.seed, ""}});
  const auto error = errorAgainstTruth(inputs, trace.camera_from_station);
  printResult(trace, inputs, error);
  if (settings.memory_limit > 0) std::cout << "\n" << sessions::memoryTable(trace) << std::flush;
  if (!arguments.out.empty())
    sessions::writeResult(arguments.out, trace, error, provenance(arguments, inputs));
  if (!arguments.trace.empty()) sessions::saveTrace(arguments.trace, trace);
  if (!arguments.record.empty()) writeRecord(arguments.record, record);
  if (!arguments.overlay.empty()) writeOverlay(arguments.overlay, inputs, trace);
  if (!trace.converged())
    note(std::string(localizationStatusText(trace.status)) + ": " + sessions::explanation(trace));
  return exitCodeOf(trace);
}

}  // namespace

void addLocalize(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "localize",
      "Finds the camera's pose relative to a station in one image, from a seed", localizeImage);
  arguments->addTo(*command);
}

}  // namespace boresight::app
