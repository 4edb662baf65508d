// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/batch.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <iterator>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "sessions/evaluation/model_error.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/evaluation/run_inputs.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/config_file.h"
#include "sessions/log/program_log.h"
#include "sessions/run/image_quality.h"
#include "sessions/run/problem.h"
#include "sessions/run/runner.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// A value that the first thread to request it loads; a failure is the same for all.
template <class T>
using Shared = std::shared_future<T>;

template <class Load>
auto shared(Load&& load) {
  return std::async(std::launch::deferred, std::forward<Load>(load)).share();
}

struct StationScene {
  const Station* station;  ///< whose mesh `scene` is
  SceneMesh scene;
  std::vector<Eigen::Vector3f> matched_vertices;
};

struct CaseImage {
  GrayImage image;
  std::optional<IgnoreMask> ignore;
};

/// What the runs of a case share.
struct CaseWork {
  Shared<StationScene> scene;
  Shared<CaseImage> image;
  std::atomic<int> runs_left{0};
};

template <class Test>
bool selects(const std::vector<std::string>& filter, Test&& meets) {
  return filter.empty() || std::any_of(filter.begin(), filter.end(), meets);
}

void requireNames(const Dataset& dataset, const BatchOptions& options) {
  for (const std::string& id : options.cases)
    if (dataset.findCase(id) == nullptr)
      throw InputError(dataset.file, "cases", "there is no case \"" + id + "\"");
  std::vector<std::string> stations = options.stations;
  if (!options.mesh_of.empty()) stations.push_back(options.mesh_of);
  for (const std::string& id : stations)
    if (dataset.stations.count(id) == 0)
      throw InputError(dataset.file, "stations", "there is no station \"" + id + "\"");
}

/// Inputs of a scene; cases with the same inputs share it.
struct SceneInputs {
  std::string station;
  std::vector<PartSource> parts;  ///< placed

  bool operator==(const SceneInputs&) const = default;
};

/// Another station's parts have the state of their station.
SceneInputs sceneInputs(const Dataset& dataset, const Case& dataset_case,
                        const std::string& mesh_of) {
  Case posed = dataset_case;
  if (!mesh_of.empty()) {
    posed.station = mesh_of;
    posed.part_states.clear();
  }
  SceneInputs inputs{posed.station, {}};
  const FrameTree frames = framesOf(dataset, posed);
  for (const PartSource& part : partsOf(dataset, posed))
    if (part.state.used()) inputs.parts.push_back(placedPart(part, frames));
  return inputs;
}

StationScene loadScene(const SceneInputs& inputs, const Station& station,
                       const std::optional<MirrorAxis>& mirror) {
  SceneMesh scene = readScene(inputs.parts);
  if (mirror) scene = mirrored(std::move(scene), *mirror);
  std::vector<Eigen::Vector3f> vertices = matchedVertices(scene.view());
  return {&station, std::move(scene), std::move(vertices)};
}

std::optional<PoseError> errorOf(const Case& dataset_case, const Camera& camera,
                                 const Pose& estimate, const StationScene& scene) {
  if (!dataset_case.truth_camera_from_station) return std::nullopt;
  return wholeError(camera, *dataset_case.truth_camera_from_station, estimate,
                    dataset_case.camera_from_end_effector,
                    {scene.matched_vertices, &scene.station->symmetries});
}

/// The errors of poses on the way, without the costly ones of BOP.
std::optional<PoseError> judgedErrorOf(const Case& dataset_case, const Camera& camera,
                                       const Pose& estimate, const StationScene& scene) {
  if (!dataset_case.truth_camera_from_station) return std::nullopt;
  return errorToTruth(camera, *dataset_case.truth_camera_from_station, estimate,
                      dataset_case.camera_from_end_effector,
                      {scene.matched_vertices, &scene.station->symmetries});
}

class Batch {
 public:
  Batch(const Dataset& dataset, const BatchOptions& options, const std::vector<PlannedRun>& plan,
        const BatchProgress& progress);
  void run(const std::stop_token& stop);

 private:
  struct Item {
    PlannedRun run;
    CaseWork* work = nullptr;
  };

  void workUntilDone(const std::stop_token& stop);
  RunResult runItem(const Item& item, const std::stop_token& stop);
  void runLoaded(const Item& item, const std::stop_token& stop, RunResult& result);
  void finish(const RunResult& result);

  const Dataset& dataset_;
  const BatchOptions& options_;
  const BatchProgress& progress_;
  std::vector<std::unique_ptr<CaseWork>> cases_;
  std::vector<Item> items_;
  Methods methods_;
  RunInputs inputs_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  ///< over what follows
  std::size_t done_ = 0;
  std::exception_ptr fault_;
};

Batch::Batch(const Dataset& dataset, const BatchOptions& options,
             const std::vector<PlannedRun>& plan, const BatchProgress& progress)
    : dataset_(dataset),
      options_(options),
      progress_(progress),
      methods_(options.method_setup),
      inputs_(dataset, options.mesh_of) {
  std::vector<std::pair<SceneInputs, Shared<StationScene>>> scenes;
  for (const PlannedRun& planned : plan) {
    if (items_.empty() || items_.back().run.input != planned.input) {
      CaseWork& work = *cases_.emplace_back(std::make_unique<CaseWork>());
      const SceneInputs inputs = sceneInputs(dataset, *planned.input, options.mesh_of);
      auto known = std::ranges::find(scenes, inputs, &decltype(scenes)::value_type::first);
      if (known == scenes.end())
        known = scenes.emplace(known, inputs, shared([this, inputs] {
                                 return loadScene(inputs, dataset_.stations.at(inputs.station),
                                                  options_.mirror);
                               }));
      work.scene = known->second;
      work.image = shared([this, &dataset_case = *planned.input] {
        return CaseImage{readCaseImage(dataset_, dataset_case),
                         readCaseMask(dataset_, dataset_case)};
      });
    }
    ++cases_.back()->runs_left;
    items_.push_back({planned, cases_.back().get()});
  }
}

void Batch::run(const std::stop_token& stop) {
  {
    std::vector<std::jthread> threads;
    const auto wanted = static_cast<std::size_t>(std::max(1, options_.jobs));
    for (std::size_t i = 0; i < std::min(wanted, items_.size()); ++i)
      threads.emplace_back([this, stop] {
        try {
          workUntilDone(stop);
        } catch (...) {  // rethrown on the caller's thread; no other run starts
          const std::lock_guard lock(mutex_);
          if (!fault_) fault_ = std::current_exception();
          next_ = items_.size();
        }
      });
  }
  if (fault_) std::rethrow_exception(fault_);
}

void Batch::workUntilDone(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const std::size_t index = next_++;
    if (index >= items_.size()) return;
    const Item& item = items_[index];
    const RunResult result = runItem(item, stop);
    if (--item.work->runs_left == 0) {
      item.work->image = {};
      item.work->scene = {};
    }
    if (!stop.stop_requested()) finish(result);
  }
}

void Batch::finish(const RunResult& result) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (progress_) progress_(done_, items_.size(), result);
}

RunResult Batch::runItem(const Item& item, const std::stop_token& stop) {
  const Case& dataset_case = *item.run.input;
  RunResult result;
  result.case_id = dataset_case.id;
  result.dataset_index = item.run.dataset_index;
  result.reseed = item.run.reseed;
  result.station = dataset_case.station;
  result.method = options_.method;
  result.tags = dataset_case.tags;
  result.requirement = dataset_case.requirement;
  try {
    runLoaded(item, stop, result);
  } catch (const FileError& error) {
    result.status = "input_error";
    result.message = error.what();
  } catch (const MethodError& error) {
    result.status = "method_error";
    result.message = dataset_case.id + ": " + error.what();
    if (dataset_case.truth_camera_from_station && dataset_case.requirement) result.success = false;
  } catch (const std::bad_alloc&) {
    result.status = "input_error";
    result.message = dataset_case.image.string() + ": not enough memory for this image and mesh";
  }
  return result;
}

void Batch::runLoaded(const Item& item, const std::stop_token& stop, RunResult& result) {
  const Case& dataset_case = *item.run.input;
  if (!dataset_case.uncertainty)
    throw InputError(dataset_.file, "cases." + dataset_case.id + ".uncertainty",
                     "neither the case nor its station states one");
  const Shared<StationScene> shared_scene = item.work->scene;
  const Shared<CaseImage> shared_image = item.work->image;
  const StationScene& scene = shared_scene.get();
  const CaseImage& image = shared_image.get();
  result.inputs_sha256 = inputs_.sha256(dataset_case);
  logEvent(LogLevel::kInfo, [&] {
    return "case " + dataset_case.id + ", seed " + std::to_string(item.run.reseed) + ", method " +
           options_.method + ": inputs SHA-256 " + result.inputs_sha256;
  });

  Pose seed = dataset_case.seed_camera_from_station;
  if (item.run.reseed > 0) {
    const Vector6d offset = drawOffset(*dataset_case.uncertainty, options_.reseed_scale,
                                       dataset_case.id, item.run.reseed);
    seed =
        seedForOffset(*dataset_case.truth_camera_from_station, offset,
                      dataset_case.uncertainty->pivot, matchedBounds(scene.scene.view()).centre());
  }
  const BitImage ignore = image.ignore ? image.ignore->view() : BitImage{};
  const LocalizationProblem problem = problemOf(
      image.image, image.ignore ? &ignore : nullptr, dataset_.cameraOf(dataset_case),
      scene.scene.view(), seed, *dataset_case.uncertainty, dataset_case.camera_from_end_effector);
  result.camera_from_station_seed = problem.camera_from_station_seed;
  result.camera_from_station = problem.camera_from_station_seed;
  result.seed_error =
      errorOf(dataset_case, problem.camera, problem.camera_from_station_seed, scene);

  result.image_quality = imageQualityOf(problem);
  const LocalizerOptions options =
      withFeatureSize(options_.localizer, scene.station->feature_size_m);
  result.message = seedConcern(problem.camera, problem.mesh, problem.camera_from_station_seed);
  if (result.message.empty()) {
    RunSettings settings;
    settings.level = options_.keep_matches ? RecordLevel::kFull : RecordLevel::kSummary;
    settings.memory_limit = options_.memory_limit;
    settings.threads = threadsOf(options_.threads, options_.memory_limit, options_.jobs);
    settings.kernels = options_.kernels;
    settings.albedo_of_part = scene.scene.albedo_of_part;
    const LocalizationTrace trace =
        methods_.localize(options_.method, problem, options, settings, stop);
    noteTrace(trace, result);
    const auto error_of = [&](const Pose& pose) {
      return judgedErrorOf(dataset_case, problem.camera, pose, scene);
    };
    result.compared = comparedText(trace, [&](const Pose& pose) -> std::optional<double> {
      const std::optional<PoseError> error = error_of(pose);
      if (!error || !dataset_case.requirement) return std::nullopt;
      return requirementShare(*error, *dataset_case.requirement);
    });
    result.steps = runSteps(trace, error_of);
  } else {
    result.status = "bad_seed";
  }
  result.error = errorOf(dataset_case, problem.camera, result.camera_from_station, scene);
  judge(options_.wrongMesh(), result);
}

}  // namespace

SceneMesh mirrored(SceneMesh scene, MirrorAxis axis) {
  const auto index = static_cast<Eigen::Index>(axis);
  const float twice_middle_m =
      static_cast<float>(2.0 * matchedBounds(scene.view()).centre()[index]);
  const std::size_t first_in_camera = firstVertexInCamera(scene.view());
  for (std::size_t i = 0; i < first_in_camera; ++i) {
    Eigen::Vector3f& vertex = scene.vertices_in_station_m[i];
    vertex[index] = twice_middle_m - vertex[index];
  }
  for (std::size_t f = 0; f < scene.faces.size(); ++f)
    if (!scene.parts[scene.part_of_face[f]].fixed_to_camera)
      std::swap(scene.faces[f].vertex[1], scene.faces[f].vertex[2]);
  return scene;
}

std::vector<PlannedRun> planBatch(const Dataset& dataset, const BatchOptions& options) {
  requireNames(dataset, options);
  std::vector<PlannedRun> plan;
  std::int64_t selected = 0;
  for (std::size_t dataset_index = 0; dataset_index < dataset.cases.size(); ++dataset_index) {
    const Case& dataset_case = dataset.cases[dataset_index];
    if (!selects(options.cases, [&](const auto& id) { return id == dataset_case.id; }) ||
        !selects(options.stations,
                 [&](const auto& station) { return station == dataset_case.station; }) ||
        !selects(options.tags, [&](const auto& tag) { return dataset_case.hasTag(tag); }) ||
        dataset_case.station == options.mesh_of)
      continue;
    if (selected++ % options.shards != options.shard - 1) continue;
    const int reseeds = dataset_case.truth_camera_from_station ? options.reseeds : 0;
    for (int reseed = 0; reseed <= reseeds; ++reseed)
      plan.push_back({&dataset_case, static_cast<std::int64_t>(dataset_index), reseed});
  }
  if (selected == 0) throw InputError(dataset.file, "cases", "none meets all filters");
  return plan;
}

void runPlanned(const Dataset& dataset, const BatchOptions& options,
                const std::vector<PlannedRun>& plan, const BatchProgress& progress,
                const std::stop_token& stop) {
  Batch(dataset, options, plan, progress).run(stop);
}

std::string durationText(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0) return "?";
  if (seconds < 59.5) return fixedText(seconds, 0) + " s";
  const auto minutes = static_cast<long long>(std::llround(seconds / 60.0));
  if (minutes < 60) return std::to_string(minutes) + " min";
  if (minutes < 24 * 60) return formatText("%lld h %02lld min", minutes / 60, minutes % 60);
  const long long hours = std::llround(seconds / 3600.0);
  return formatText("%lld %s %lld h", hours / 24, hours < 48 ? "day" : "days", hours % 24);
}

std::string batchProgressText(std::size_t done, std::size_t total, std::size_t completed,
                              double seconds_since_began) {
  std::string text = std::to_string(done) + " of " + std::to_string(total) + " runs, " +
                     std::to_string(completed) + " completed";
  if (done == 0 || !(seconds_since_began > 0.0)) return text;
  const double seconds_each = seconds_since_began / static_cast<double>(done);
  text += ", " + fixedText(3600.0 / seconds_each, 0) + " an hour";
  if (done < total)
    text += ", " + durationText(seconds_each * static_cast<double>(total - done)) + " left";
  return text;
}

}  // namespace boresight::sessions
