// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <utility>

#include "app/batch_output.h"
#include "app/case_arguments.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/video_frames.h"
#include "sessions/run/problem.h"
#include "sessions/session/case_sequence.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

struct FollowArguments : CaseArguments {
  std::string images, out, jsonl;
  std::vector<double> motion;  ///< mm, deg
  int threads = 0;
  Kernels kernels = bestKernels();

  void addTo(CLI::App& command) {
    addOption(command, "--images", "PATH", images,
              "Folder of the images, a text file with one image a line, or a video")
        ->required();
    CaseArguments::addTo(command);
    command.remove_option(command.get_option("--image"));
    addUncertaintyTo(command);
    addEndEffectorTo(command);
    command.get_option("--camera")->description(kCameraHelp)->required();
    command.get_option("--mesh")->required();
    addOption(command, "--motion", "MM DEG", motion,
              "Largest motion between two images as seen from the camera: a length in mm along "
              "each axis, an angle in deg about each axis through the station's centre")
        ->expected(2)
        ->check(numberIn(0.0, 1000.0))
        ->default_str("5 1");
    addThreads(command, threads);
    addKernels(command, kernels);
    addFile(command, "--out", out, "Results as an SQLite file; an existing file is continued")
        ->required();
    addFile(command, "--jsonl", jsonl, "Results as JSON lines");
  }
};

sessions::DeclaredUncertainty motionOf(const FollowArguments& arguments) {
  sessions::DeclaredUncertainty motion = sessions::assumedMotion();
  if (arguments.motion.empty()) return motion;
  if (arguments.motion[1] > 180.0)
    throw CLI::ValidationError("--motion", "the angle is at most 180 deg");
  motion.translation_m.setConstant(1e-3 * arguments.motion[0]);
  motion.rotation_deg.setConstant(arguments.motion[1]);
  return motion;
}

void requireImagesWithRule(const FollowArguments& arguments) {
  if (sessions::isVideoName(arguments.images) &&
      arguments.files().eight_bit != sessions::ImageReadOptions())
    throw CLI::ValidationError("--bit-depth, --levels, --bayer", "are not for a video");
}

/// InputError.
sessions::SequenceOrder orderOf(const FollowArguments& arguments,
                                const sessions::SessionCase& session_case) {
  if (!session_case.has_seed)
    throw sessions::InputError(arguments.seedFile(),
                               "the transforms do not join CAMERA and STATION; add the missing "
                               "one, or give a seed");
  sessions::SequenceOrder order;
  order.images = arguments.images;
  order.session_case = session_case;
  order.session_case.image.eight_bit = arguments.files().eight_bit;
  order.motion = motionOf(arguments);
  order.profile = arguments.options.profileName();
  order.options = arguments.optionsOf(session_case);
  order.settings.memory_limit = arguments.options.memoryLimit();
  order.settings.threads = arguments.threads;
  order.settings.kernels = arguments.kernels;
  order.results = arguments.out;
  order.command = typedCommand();
  return order;
}

std::string rateText(const sessions::CaseSequence& sequence) {
  if (sequence.localized() == 0) return "";
  return "; " + sessions::fixedText(sequence.framesPerSecond(), 1) + " frames/s";
}

/// A line on a terminal, and bad images as they come.
void showProgress(const TerminalLine& line, const sessions::CaseSequence& sequence,
                  const sessions::RunResult& result) {
  line.erase();
  if (result.inputFailed()) std::cerr << sessions::plainLine(result.message);
  const sessions::Sequence& frames = sequence.sequence();
  std::string text = std::to_string(frames.frames());
  if (sequence.total() > 0) text += " of " + std::to_string(sequence.total());
  line.show(text + " frames, " + std::to_string(frames.lost().size()) + " lost" +
            rateText(sequence));
}

void followAll(sessions::CaseSequence& sequence, const FollowArguments& arguments,
               const std::stop_token& stop) {
  if (sequence.earlier() > 0)
    note(arguments.out + ": resumed, " + std::to_string(sequence.earlier()) + " frames are done");
  const TerminalLine line;
  while (const auto result = sequence.next(stop)) showProgress(line, sequence, *result);
  line.erase();
  for (const std::string& text : sequence.notes()) note(arguments.images + ": " + text);
  print(sessions::sequenceText(sequence.sequence()) + rateText(sequence));
}

int follow(FollowArguments& arguments) {
  arguments.requireSeed();
  (void)arguments.options.read();  // unknown options are rejected before files are read
  (void)motionOf(arguments);
  requireImagesWithRule(arguments);
  const sessions::MadeCase sequence_case = sessions::makeCase(arguments.files());
  auto source = sessions::openFrames(arguments.images, arguments.files().eight_bit);
  const sessions::SequenceOrder order = orderOf(arguments, sequence_case.made);
  const sessions::InputPlaces places{
      {}, {arguments.camera, "distortion"}, {}, {arguments.seedFile(), "camera_from_station"}};
  sessions::SequenceInputs inputs = sessions::sequenceInputs(order, places);
  requireWritable({arguments.out, arguments.jsonl});
  for (const std::string& line : sequence_case.notes) note(line);

  std::stop_source stop;
  std::int64_t frames = 0;
  std::int64_t lost = 0;
  const InterruptWatch watch(stop);
  {
    sessions::CaseSequence sequence(order, std::move(inputs), std::move(source));
    followAll(sequence, arguments, stop.get_token());
    frames = sequence.sequence().frames();
    lost = static_cast<std::int64_t>(sequence.sequence().lost().size());
  }
  if (!arguments.jsonl.empty())
    writeResultLines(arguments.jsonl, sessions::readResults(arguments.out).runs);
  if (watch.signal() != 0) note(kInterruptedNote);
  return watch.exitCode(lost < frames ? kDone : kNotConverged);
}

}  // namespace

void addFollow(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "follow",
             "Localizes the images of a sequence, each from the last accepted pose", follow);
}

}  // namespace boresight::app
