// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/sequence.h"

#include <utility>

#include "sessions/baselines/methods.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/problem.h"

namespace boresight::sessions {

DeclaredUncertainty assumedMotion() {
  return {.translation_m = Eigen::Vector3d::Constant(0.005),
          .rotation_deg = Eigen::Vector3d::Constant(1.0),
          .pivot = UncertaintyPivot::kStation};
}

Sequence::Sequence(SequenceInputs inputs)
    : inputs_(std::move(inputs)),
      follower_(inputs_.camera_from_station_seed, inputs_.uncertainty, inputs_.motion) {
  if (inputs_.ignore) ignore_ = inputs_.ignore->view();
}

RunResult Sequence::run(const Frame& frame, const std::stop_token& stop) {
  RunResult result;
  result.case_id = frame.name;
  result.dataset_index = frames_;
  result.station = inputs_.station;
  result.method = kWhs;
  result.camera_from_station_seed = follower_.camera_from_station();
  result.camera_from_station = follower_.camera_from_station();
  try {
    if (frame.image) {
      requireSameSize(*frame.image, inputs_.camera);
      result.inputs_sha256 = frame.image->pixels_sha256;
      localize(*frame.image, stop, result);
    } else {
      result.message = frame.problem;
    }
  } catch (const InputError& error) {
    result.message = error.what();
  }
  if (result.status.empty()) result.status = "input_error";
  if (!stop.stop_requested()) take(result);
  return result;
}

void Sequence::localize(const GrayImage& image, const std::stop_token& stop, RunResult& result) {
  const LocalizationProblem problem = problemOf(
      image, inputs_.ignore ? &ignore_ : nullptr, inputs_.camera, inputs_.scene.view(),
      follower_.camera_from_station(), follower_.uncertainty(), inputs_.camera_from_end_effector);
  result.message = seedConcern(problem.camera, problem.mesh, problem.camera_from_station_seed);
  if (!result.message.empty()) {
    result.status = "bad_seed";
    return;
  }
  if (runner_)
    runner_->restart(problem);
  else
    runner_ = std::make_unique<Runner>(problem, inputs_.options, inputs_.settings);
  runner_->advance(StepUntil::kEnd, stop);
  noteTrace(runner_->trace(), result);
  result.compared = comparedText(runner_->trace(), [](const Pose&) { return std::nullopt; });
  result.steps = runSteps(runner_->trace(), [](const Pose&) { return std::nullopt; });
}

void Sequence::take(const RunResult& result) {
  ++frames_;
  if (!result.completed) lost_.push_back(frames_);
  follower_.take(result.completed ? std::optional(result.camera_from_station) : std::nullopt);
}

std::string sequenceText(const Sequence& sequence) {
  const std::vector<std::int64_t>& lost = sequence.lost();
  const auto lost_count = static_cast<std::int64_t>(lost.size());
  std::string text = std::to_string(sequence.frames() - lost_count) + " of " +
                     std::to_string(sequence.frames()) + " frames accepted";
  if (lost.empty()) return text;
  text += ", " + std::to_string(lost_count) + " lost: ";
  for (std::size_t first = 0; first < lost.size();) {
    std::size_t last = first;
    while (last + 1 < lost.size() && lost[last + 1] == lost[last] + 1) ++last;
    if (last == first + 1) last = first;
    text += (first > 0 ? ", " : "") + std::to_string(lost[first]);
    if (last > first) text += "-" + std::to_string(lost[last]);
    first = last + 1;
  }
  return text;
}

}  // namespace boresight::sessions
