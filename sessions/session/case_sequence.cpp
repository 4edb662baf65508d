// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_sequence.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/baselines/methods.h"
#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/run/problem.h"
#include "sessions/session/input_check.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

/// How samples become 8 bit.
nlohmann::ordered_json ruleJson(const ImageReadOptions& rule) {
  nlohmann::ordered_json json = {{"table", rule.table}};
  if (rule.bit_depth) json["bit_depth"] = *rule.bit_depth;
  if (rule.levels) json["levels"] = {rule.levels->black, rule.levels->white};
  if (rule.bayer) json["bayer"] = kBayerPatternNames[static_cast<std::size_t>(*rule.bayer)];
  return json;
}

/// Of the sequence as a dataset: its images by their place and rule. The case's own image is none;
/// the pixels of a frame are stored with its run.
DatasetFacts sequenceFacts(const SequenceOrder& order, std::int64_t frames) {
  SessionCase without_image = order.session_case;
  without_image.image = {};
  DatasetFacts facts;
  facts.dataset = std::filesystem::absolute(order.images).lexically_normal().string();
  facts.cases = frames;
  facts.version = kVersion;
  nlohmann::ordered_json inputs = {{"images", utf8Text(facts.dataset)},
                                   {"inputs", inputsDigest(without_image)},
                                   {"motion", toJson(order.motion)},
                                   {"rule", ruleJson(order.session_case.image.eight_bit)}};
  if (order.session_case.camera_from_end_effector)
    inputs["end_effector"] = toJson(*order.session_case.camera_from_end_effector);
  facts.dataset_sha256 = sha256Text(inputs.dump());
  return facts;
}

BatchRun sequenceBatchRun(const SequenceOrder& order) {
  BatchRun batch = thisBatchRun();
  batch.command = order.command;
  batch.threads = threadsOf(order.settings.threads, order.settings.memory_limit);
  batch.kernels = kernelsName(order.settings.kernels);
  return batch;
}

/// Results of an earlier process, by the frame's name; none when there is no file.
std::map<std::string, RunResult> earlierResults(const std::filesystem::path& file) {
  std::map<std::string, RunResult> earlier;
  if (!std::filesystem::exists(file)) return earlier;
  forEachRun(file, [&earlier](RunResult&& result) {
    if (!result.inputFailed()) earlier.emplace(result.case_id, std::move(result));
  });
  return earlier;
}

std::optional<IgnoreMask> sequenceMask(const SessionCase& session_case, const GrayImage* image) {
  const bool strokes = image != nullptr && !session_case.ignore_strokes.empty();
  if (!session_case.ignore && !strokes) return std::nullopt;
  IgnoreMask mask =
      readKnownMask(session_case, session_case.camera.width, session_case.camera.height);
  if (strokes) {
    requireSameSize(*image, session_case.camera);
    applyStrokes(session_case.ignore_strokes, image->view(), mask);
  }
  return mask;
}

}  // namespace

SequenceInputs sequenceInputs(const SequenceOrder& order, const InputPlaces& places,
                              const GrayImage* image) {
  const SessionCase& session_case = order.session_case;
  SequenceInputs inputs;
  inputs.station = session_case.parts.front().source.mesh.stem().string();
  inputs.camera = session_case.camera;
  inputs.scene = readKnownScene(session_case);
  inputs.ignore = sequenceMask(session_case, image);
  inputs.camera_from_station_seed = session_case.camera_from_station_seed;
  inputs.uncertainty = session_case.uncertainty;
  inputs.motion = order.motion;
  inputs.camera_from_end_effector = session_case.camera_from_end_effector;
  inputs.options = order.options;
  inputs.settings = order.settings;
  inputs.settings.level = RecordLevel::kSummary;
  requireField(places.camera.file, places.camera.field, inputs.camera);
  requireSensibleSeed(inputs.camera, inputs.scene, inputs.camera_from_station_seed,
                      places.seed.file, places.seed.field);
  return inputs;
}

CaseSequence::CaseSequence(const SequenceOrder& order, SequenceInputs inputs,
                           std::unique_ptr<FrameSource> source)
    : source_(std::move(source)),
      total_(source_->count()),
      results_(order.results),
      writer_(order.results, sequenceFacts(order, total_)),
      notes_(source_->notes()),
      sequence_(std::move(inputs)) {
  writer_.admit(methodFacts(kWhs, order.profile, order.options));
  earlier_ = earlierResults(order.results);
  for (const auto& [name, result] : earlier_) places_.insert(result.dataset_index);
  writer_.begin(sequenceBatchRun(order));
  began_ = std::chrono::steady_clock::now();
  readAhead();
}

void CaseSequence::readAhead() {
  ahead_ = std::async(std::launch::async, [this] { return source_->next(); });
}

std::optional<RunResult> CaseSequence::next(const std::stop_token& stop) {
  if (!ahead_.valid()) return std::nullopt;
  const std::optional<Frame> frame = ahead_.get();
  if (stop.stop_requested()) return std::nullopt;
  if (!frame) {
    notes_ = source_->notes();
    writer_.end();
    return std::nullopt;
  }
  readAhead();
  requireSamePlace(*frame);
  if (const auto known = earlier_.find(frame->name); known != earlier_.end()) {
    sequence_.take(known->second);
    return known->second;
  }
  RunResult result = sequence_.run(*frame, stop);
  if (stop.stop_requested()) return std::nullopt;
  writer_.add(result);
  ++localized_;
  passed_ = std::chrono::steady_clock::now() - began_;
  return result;
}

void CaseSequence::requireSamePlace(const Frame& frame) const {
  const auto refuse = [this, &frame](const std::string& change) {
    throw OutputError(results_, "frame " + frame.name + " " + change + "; name another file");
  };
  const std::int64_t place = sequence_.frames();
  const auto known = earlier_.find(frame.name);
  if (known == earlier_.end()) {
    if (places_.contains(place)) refuse("was added between frames that are done");
    return;
  }
  const RunResult& held = known->second;
  if (held.dataset_index != place)
    refuse("was number " + std::to_string(held.dataset_index + 1) + " and is number " +
           std::to_string(place + 1) + " now");
  if (frame.image && !held.inputs_sha256.empty() &&
      held.inputs_sha256 != frame.image->pixels_sha256)
    refuse("has other pixels than when it was localized");
}

double CaseSequence::framesPerSecond() const {
  return localized_ > 0 ? static_cast<double>(localized_) / passed_.count() : 0.0;
}

SequenceRow sequenceRow(const RunResult& result, const Eigen::Vector3d& centre_in_station_m) {
  SequenceRow row;
  row.number = result.dataset_index + 1;
  row.name = result.case_id;
  row.accepted = result.completed;
  row.probability = result.probability;
  row.seconds = result.seconds.total();
  if (!result.completed) {
    row.reason = result.message.empty() ? result.status : result.message;
    return row;
  }
  row.camera_from_station = result.camera_from_station;
  const Eigen::Vector3d pivot_in_camera_m = result.camera_from_station_seed * centre_in_station_m;
  const Vector6d offset = offsetAboutPivot(result.camera_from_station_seed,
                                           result.camera_from_station, pivot_in_camera_m);
  row.turned_deg = offset.head<3>().norm() / kDegree_rad;
  row.moved_mm = 1e3 * offset.tail<3>().norm();
  return row;
}

}  // namespace boresight::sessions
