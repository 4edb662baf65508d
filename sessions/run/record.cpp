// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/record.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "sessions/run/outside_matching.h"
#include "sessions/run/record_inputs.h"
#include "sessions/run/worker_pool.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The rows in use: the core's images may own room for a larger level.
BitMap recordBits(const BitImage& image) {
  BitMap map;
  map.width = image.width;
  map.height = image.height;
  const int used = BitImage::wordsPerRow(image.width);
  map.words.reserve(static_cast<std::size_t>(used) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y)
    map.words.insert(map.words.end(), image.row(y), image.row(y) + used);
  return map;
}

/// The first `count` elements, or as many as there are.
template <class T>
std::vector<T> firstOf(std::span<T> elements, std::int32_t count) {
  const auto wanted = static_cast<std::size_t>(std::max(0, count));
  const auto kept = elements.first(std::min(wanted, elements.size()));
  return {kept.begin(), kept.end()};
}

void recordScores(const MatchSet& matches, IterationTrace& trace) {
  double sum = 0.0;
  for (std::int32_t i = 0; i < matches.count; ++i) {
    const Match& match = matches.matches[static_cast<std::size_t>(i)];
    if (!match.searched) continue;
    const double score = whsScore(match.peak.counts, match.norms);
    trace.best_score = std::max(trace.best_score, score);
    sum += score;
  }
  trace.mean_score = matches.searched > 0 ? sum / matches.searched : 0.0;
}

void recordMatching(const Iteration& iteration, Stage reached, RecordLevel level,
                    IterationTrace& trace) {
  if (reached < Stage::kTemplates) return;
  trace.template_count = iteration.templates.count;
  trace.template_side_px = iteration.templates.side_px;
  if (level == RecordLevel::kFull)
    trace.templates = firstOf(iteration.templates.templates, iteration.templates.count);
  if (reached < Stage::kMatch) return;
  trace.searched_count = iteration.matches.searched;
  trace.correspondence_count = iteration.correspondence_count;
  recordScores(iteration.matches, trace);
  if (level == RecordLevel::kFull) {
    trace.matches = firstOf(iteration.matches.matches, iteration.matches.count);
    trace.correspondences = firstOf(iteration.correspondences, iteration.correspondence_count);
    trace.template_of = firstOf(iteration.template_of, iteration.correspondence_count);
  }
  if (reached < Stage::kPose) return;
  const PnpSolution& pnp = iteration.pnp;
  trace.pnp.camera_from_station = pnp.camera_from_station;
  trace.pnp.inlier_count = pnp.inlier_count;
  trace.pnp.rms_px = pnp.rms_px;
  trace.pnp.covariance = pnp.covariance;
  trace.pnp.samples = pnp.samples;
  if (level == RecordLevel::kFull) {
    trace.pnp.inlier = firstOf(pnp.inlier, iteration.correspondence_count);
    trace.pnp.residual_px = firstOf(pnp.residual_px, iteration.correspondence_count);
  }
}

void recordRefinement(const RefinementResult& refinement, RecordLevel level,
                      RefinementTrace& trace) {
  trace.camera_from_station = refinement.camera_from_station;
  trace.covariance = refinement.covariance;
  trace.sample_count = refinement.sample_count;
  trace.found_count = refinement.found_count;
  trace.used_count = refinement.used_count;
  trace.rms_px = refinement.rms_px;
  if (level == RecordLevel::kFull)
    trace.samples = firstOf(refinement.samples, refinement.sample_count);
}

void recordEnd(const Localizer& localizer, LocalizationTrace& trace) {
  const Workspace& workspace = localizer.workspace();
  trace.support = workspace.support;
  trace.partial = workspace.partial;
  trace.attempts = workspace.attempts;
  trace.rivals.assign(workspace.rivals.begin(), workspace.rivals.end());
  trace.status = workspace.status;
  trace.fault = workspace.fault;
  trace.camera_from_station = workspace.camera_from_station;
  trace.covariance = workspace.covariance;
  trace.digest = hexText(localizer.digest()).data();
  trace.arena_bytes = localizer.highWaterBytes();
}

/// Records an iteration when it is complete; its edge support is judged after that and may change
/// how it ended.
void noteIteration(const Localizer& localizer, const StepReport& report, RecordLevel level,
                   StageSeconds& seconds, LocalizationTrace& trace) {
  const Iteration* iteration = localizer.workspace().iteration;
  if (iteration == nullptr) return;
  if (report.iteration_complete) {
    trace.iterations.push_back(recordIteration(*iteration, report.stage, level));
  } else if (report.stage != Stage::kSupport || trace.iterations.empty()) {
    return;
  }
  trace.iterations.back().status = iteration->status;
  trace.iterations.back().seconds += seconds;
  seconds = {};
}

/// Steps until the run has finished, recording each iteration when it is complete.
void runSteps(Localizer& localizer, const RunSettings& settings, const std::stop_token& stop,
              LocalizationTrace& trace) {
  const RecordLevel level = settings.level;
  WorkerPool pool(settings.threads);
  const WorkerPool::Work work = [&localizer](int piece, int worker) {
    localizer.runTask(piece, worker);
  };
  Stopwatch watch;
  StageSeconds iteration_seconds;
  PlannedChanges changes(trace.changes);
  std::optional<OutsideMatching> outside;
  if (settings.method != nullptr) outside.emplace(localizer, *settings.method, stop);
  bool finished = false;
  while (!finished && !stop.stop_requested()) {
    if (changes.takeUp(localizer, trace.iterations.size()) && settings.onboard_record != nullptr)
      settings.onboard_record->changeOptions(localizer.options(), localizer.workspace().iterations);
    if (pool.workers() > 1 && localizer.tasks() > 1) {
      pool.run(localizer.tasks(), work, stop);
      if (stop.stop_requested()) break;
    }
    if (outside) outside->serve();
    const StepReport report = localizer.step();
    const double seconds = watch.lap();
    trace.seconds.add(report.stage, seconds);
    if (report.stage != Stage::kEdges) iteration_seconds.add(report.stage, seconds);
    if (report.stage == Stage::kEdges && report.stage_complete && level == RecordLevel::kFull)
      trace.edges = recordEdgeMap(localizer.workspace().edges);
    noteIteration(localizer, report, level, iteration_seconds, trace);
    if (settings.onboard_record != nullptr) settings.onboard_record->note(localizer, report);
    finished = report.finished;
    watch.lap();  // copying is the recorder's time, not the run's
  }
  const EdgeMap& edges = localizer.workspace().edges;
  trace.edges.low_threshold = edges.low_threshold;
  trace.edges.high_threshold = edges.high_threshold;
  trace.edges.edge_count = edges.edge_count;
}

}  // namespace

RenderTrace recordRender(const EdgeRender& render) {
  RenderTrace trace;
  trace.edges = recordBits(render.edges);
  trace.mask = recordBits(render.mask);
  trace.pixels = firstOf(render.pixels, render.pixel_count);
  trace.row_begin = firstOf(render.row_begin, render.edges.height + 1);
  trace.camera = render.camera;
  trace.camera_from_station = render.camera_from_station;
  return trace;
}

EdgeMapTrace recordEdgeMap(const EdgeMap& edges) {
  EdgeMapTrace trace;
  for (std::size_t i = 0; i < trace.level.size(); ++i) trace.level[i] = recordBits(edges.level[i]);
  trace.low_threshold = edges.low_threshold;
  trace.high_threshold = edges.high_threshold;
  trace.edge_count = edges.edge_count;
  return trace;
}

bool hasPose(const Iteration& iteration, Stage reached) {
  return (reached == Stage::kPose || reached == Stage::kRefine) &&
         iteration.status != LocalizationStatus::kPnpFailed &&
         iteration.status != LocalizationStatus::kFault;
}

IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level) {
  IterationTrace trace;
  trace.index = iteration.index;
  trace.attempt = iteration.attempt;
  trace.kind = iteration.kind;
  trace.level = iteration.level;
  trace.reached = reached;
  trace.status = iteration.status;
  trace.threshold_px = iteration.threshold_px;
  trace.camera_from_station_before = iteration.camera_from_station_before;
  trace.uncertainty = iteration.uncertainty;
  trace.edge_pixel_count = iteration.render.pixel_count;
  if (level == RecordLevel::kFull) trace.render = recordRender(iteration.render);
  const bool refines = iteration.kind == IterationKind::kRefine;
  if (!refines) {
    recordMatching(iteration, reached, level, trace);
    trace.wide = !iteration.restarts.empty();
    if (trace.wide)
      trace.hypotheses.assign(iteration.restarts.begin(), iteration.restarts.end());
    else
      trace.hypotheses.assign(iteration.hypotheses.begin(),
                              iteration.hypotheses.begin() + iteration.hypothesis_count);
    trace.chosen_hypothesis = iteration.chosen_hypothesis;
  } else if (reached >= Stage::kRefine) {
    recordRefinement(iteration.refinement, level, trace.refinement);
  }
  const bool solved = hasPose(iteration, reached);
  trace.camera_from_station =
      solved ? iteration.camera_from_station : iteration.camera_from_station_before;
  if (solved) {
    trace.correction_translation_m = iteration.correction_translation_m;
    trace.correction_rotation_rad = iteration.correction_rotation_rad;
    trace.correction_image_px = iteration.correction_image_px;
  }
  return trace;
}

std::size_t inputBytes(const LocalizationProblem& problem) {
  const ImageView& image = problem.image;
  const MeshView& mesh = problem.mesh;
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) +
         (problem.ignore != nullptr ? problem.ignore->words.size_bytes() : 0) +
         mesh.vertices_in_station_m.size_bytes() + mesh.faces.size_bytes() +
         mesh.part_of_face.size_bytes() + mesh.parts.size_bytes();
}

LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                           const RunSettings& settings, const std::stop_token& stop) {
  const LocalizerOptions& options = plan.options;
  LocalizationTrace trace;
  trace.version = kVersion;
  trace.options = options;
  trace.changes = plan.changes;
  trace.camera = problem.camera;
  trace.camera_from_station_seed = problem.camera_from_station_seed;
  trace.camera_from_station = problem.camera_from_station_seed;
  trace.uncertainty = problem.uncertainty;
  Stopwatch watch;
  trace.memory.inputs = inputBytes(problem);
  trace.memory.limit = settings.memory_limit;
  const bool limited = settings.memory_limit > 0;
  const Kernels kernels = limited ? Kernels::kPortable : settings.kernels;
  Status sized =
      requiredMemory(sizeOf(problem), options, settings.threads, trace.memory.use, kernels);
  if (sized == Status::kOk && limited && trace.memory.total() > settings.memory_limit)
    sized = Status::kArenaTooSmall;
  if (sized == Status::kOk && !planProblem(plan).empty()) sized = Status::kInvalidOption;
  if (sized != Status::kOk) {
    trace.status = LocalizationStatus::kFault;
    trace.fault = sized;
    return trace;
  }
  const std::size_t bytes =
      limited ? settings.memory_limit - trace.memory.inputs : trace.memory.use.total();
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
  Localizer localizer(problem, options, {memory.get(), bytes}, settings.threads, kernels);
  trace.seconds.initialization = watch.lap();
  if (settings.onboard_record != nullptr)
    settings.onboard_record->begin(recordInputs(problem), problem, options);
  runSteps(localizer, settings, stop, trace);
  if (settings.onboard_record != nullptr) settings.onboard_record->end(localizer);
  recordEnd(localizer, trace);
  return trace;
}

}  // namespace boresight::sessions
