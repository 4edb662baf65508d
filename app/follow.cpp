// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <future>
#include <iostream>
#include <map>

#include <nlohmann/json.hpp>

#include "app/batch_output.h"
#include "app/case_arguments.h"
#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/sequence.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/camera_field.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/video_frames.h"
#include "sessions/run/problem.h"
#include "sessions/session/input_check.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

using Clock = std::chrono::steady_clock;

struct FollowArguments : CaseArguments {
  std::string images, out, jsonl;
  std::vector<double> motion;  ///< mm, deg
  int threads = 0;
  Kernels kernels = bestKernels();

  void addTo(CLI::App& command);
};

void FollowArguments::addTo(CLI::App& command) {
  command
      .add_option("--images", images,
                  "Folder of the images, a text file with one image a line, or a video")
      ->required()
      ->type_name("PATH");
  CaseArguments::addTo(command);
  command.remove_option(command.get_option("--image"));
  addUncertaintyTo(command);
  addEndEffectorTo(command);
  command.get_option("--camera")->description(kCameraHelp)->required();
  command.get_option("--mesh")->required();
  command
      .add_option("--motion", motion,
                  "Largest motion between two images as seen from the camera: a length in mm along "
                  "each axis, an angle in deg about each axis through the station's centre")
      ->expected(2)
      ->check(numberIn(0.0, 1000.0))
      ->default_str("5 1")
      ->type_name("MM DEG");
  addThreads(command, threads);
  addKernels(command, kernels);
  addFile(command, "--out", out, "Results as an SQLite file; an existing file is continued")
      ->required();
  addFile(command, "--jsonl", jsonl, "Results as JSON lines");
}

sessions::DeclaredUncertainty motionOf(const FollowArguments& arguments) {
  sessions::DeclaredUncertainty motion = sessions::assumedMotion();
  if (arguments.motion.empty()) return motion;
  if (arguments.motion[1] > 180.0)
    throw CLI::ValidationError("--motion", "the angle is at most 180 deg");
  motion.translation_m.setConstant(1e-3 * arguments.motion[0]);
  motion.rotation_deg.setConstant(arguments.motion[1]);
  return motion;
}

std::unique_ptr<sessions::FrameSource> openFrames(const FollowArguments& arguments) {
  if (!sessions::isVideoName(arguments.images))
    return sessions::openImages(arguments.images, arguments.files().eight_bit);
  if (arguments.files().eight_bit != sessions::ImageReadOptions())
    throw CLI::ValidationError("--bit-depth, --levels, --bayer", "are not for a video");
  return sessions::openVideo(arguments.images);
}

/// InputError.
sessions::SequenceInputs inputsOf(const FollowArguments& arguments,
                                  const sessions::SessionCase& session_case) {
  if (!session_case.has_seed)
    throw sessions::InputError(arguments.seedFile(),
                               "the transforms do not join CAMERA and STATION; add the missing "
                               "one, or give a seed");
  sessions::SequenceInputs inputs;
  inputs.station = std::filesystem::path(arguments.mesh).stem().string();
  inputs.camera = session_case.camera;
  inputs.scene = sessions::readKnownScene(session_case);
  if (session_case.ignore)
    inputs.ignore = sessions::readIgnoreMask(session_case.ignore->file, inputs.camera.width,
                                             inputs.camera.height);
  inputs.camera_from_station_seed = session_case.camera_from_station_seed;
  inputs.uncertainty = session_case.uncertainty;
  inputs.motion = motionOf(arguments);
  inputs.camera_from_end_effector = session_case.camera_from_end_effector;
  inputs.options = arguments.optionsOf(session_case);
  inputs.settings.level = sessions::RecordLevel::kSummary;
  inputs.settings.memory_limit = arguments.options.memoryLimit();
  inputs.settings.threads = arguments.threads;
  inputs.settings.kernels = arguments.kernels;
  sessions::requireField(arguments.camera, "distortion", inputs.camera);
  sessions::requireSensibleSeed(inputs.camera, inputs.scene, inputs.camera_from_station_seed,
                                arguments.seedFile(), "camera_from_station");
  return inputs;
}

/// Of the sequence as a dataset: its images by their place alone.
sessions::DatasetFacts factsOf(const FollowArguments& arguments,
                               const sessions::SessionCase& session_case, std::int64_t frames) {
  sessions::DatasetFacts facts;
  facts.dataset = std::filesystem::absolute(arguments.images).lexically_normal().string();
  facts.cases = frames;
  facts.version = sessions::kVersion;
  nlohmann::ordered_json inputs = {{"images", facts.dataset},
                                   {"inputs", sessions::inputsDigest(session_case)},
                                   {"motion", sessions::toJson(motionOf(arguments))}};
  facts.dataset_sha256 = sessions::sha256Text(inputs.dump());
  return facts;
}

/// Results of an earlier process, by the frame's name; none when there is no file.
std::map<std::string, sessions::RunResult> earlierResults(const std::string& file) {
  std::map<std::string, sessions::RunResult> earlier;
  if (!std::filesystem::exists(file)) return earlier;
  sessions::forEachRun(file, [&earlier](sessions::RunResult&& result) {
    if (!result.inputFailed()) earlier.emplace(result.case_id, std::move(result));
  });
  return earlier;
}

/// A line on a terminal, and bad images as they come.
class FollowProgress {
 public:
  explicit FollowProgress(std::int64_t total) : total_(total) {}

  void operator()(const sessions::Sequence& sequence, const sessions::RunResult& result) {
    ++done_;
    line_.erase();
    if (result.inputFailed()) std::cerr << sessions::plainLine(result.message);
    std::string text = std::to_string(sequence.frames());
    if (total_ > 0) text += " of " + std::to_string(total_);
    line_.show(text + " frames, " + std::to_string(sequence.lost().size()) + " lost" + rateText());
  }
  void end() const { line_.erase(); }
  /// "; 31.0 frames/s" of those that this process localized; "" when there are none.
  std::string rateText() const {
    if (done_ == 0) return "";
    const std::chrono::duration<double> passed = Clock::now() - began_;
    return "; " + sessions::fixedText(static_cast<double>(done_) / passed.count(), 1) + " frames/s";
  }

 private:
  TerminalLine line_;
  Clock::time_point began_ = Clock::now();
  std::int64_t total_;
  std::int64_t done_ = 0;
};

/// Localizes the frames; the next one is read meanwhile.
void followAll(sessions::FrameSource& source, const std::string& out,
               const std::map<std::string, sessions::RunResult>& earlier,
               sessions::Sequence& sequence, sessions::ResultsWriter& writer,
               FollowProgress& progress, const std::stop_token& stop) {
  const auto readNext = [&source] {
    return std::async(std::launch::async, [&source] { return source.next(); });
  };
  if (!earlier.empty())
    note(out + ": resumed, " + std::to_string(earlier.size()) + " frames are done");
  for (auto ahead = readNext();;) {
    const std::optional<sessions::Frame> frame = ahead.get();
    if (!frame || stop.stop_requested()) return;
    ahead = readNext();
    if (const auto known = earlier.find(frame->name); known != earlier.end()) {
      sequence.take(known->second);
      continue;
    }
    const sessions::RunResult result = sequence.run(*frame, stop);
    if (stop.stop_requested()) return;
    writer.add(result);
    progress(sequence, result);
  }
}

sessions::BatchRun batchRunOf(const FollowArguments& arguments) {
  sessions::BatchRun batch_run = sessions::thisBatchRun();
  batch_run.command = typedCommand();
  batch_run.threads = sessions::threadsOf(arguments.threads, arguments.options.memoryLimit());
  batch_run.kernels = kernelsName(arguments.kernels);
  return batch_run;
}

int follow(FollowArguments& arguments) {
  arguments.requireSeed();
  (void)arguments.options.read();  // options that do not exist are refused before files are read
  (void)motionOf(arguments);
  const sessions::MadeCase sequence_case = sessions::makeCase(arguments.files());
  const std::unique_ptr<sessions::FrameSource> source = openFrames(arguments);
  const sessions::SequenceInputs inputs = inputsOf(arguments, sequence_case.made);
  for (const std::string& file : {arguments.out, arguments.jsonl})
    if (!file.empty()) sessions::requireWritable(file);
  for (const std::string& line : sequence_case.notes) note(line);

  std::stop_source stop;
  sessions::Sequence sequence(inputs);
  {
    const InterruptWatch watch(stop);
    sessions::ResultsWriter writer(arguments.out,
                                   factsOf(arguments, sequence_case.made, source->count()));
    writer.admit(
        sessions::methodFacts(sessions::kWhs, arguments.options.profileName(), inputs.options));
    const auto earlier = earlierResults(arguments.out);
    writer.begin(batchRunOf(arguments));
    FollowProgress progress(source->count());
    followAll(*source, arguments.out, earlier, sequence, writer, progress, stop.get_token());
    progress.end();
    if (!stop.stop_requested()) writer.end();
    print(sessions::sequenceText(sequence) + progress.rateText());
  }
  if (!arguments.jsonl.empty())
    writeResultLines(arguments.jsonl, sessions::readResults(arguments.out).runs);
  if (stop.stop_requested()) {
    note("interrupted; run the same command again to continue");
    return kInternalFault;
  }
  const auto lost = static_cast<std::int64_t>(sequence.lost().size());
  return lost < sequence.frames() ? kDone : kNotConverged;
}

}  // namespace

void addFollow(CLI::App& app, int& exit_code) {
  const auto [command, arguments] =
      addCommand(app, exit_code, "follow",
                 "Localizes the images of a sequence, each from the last accepted pose", follow);
  arguments->addTo(*command);
}

}  // namespace boresight::app
