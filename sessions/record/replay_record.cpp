// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "core/localizer/pose_change.h"
#include "core/localizer/pose_comparison.h"
#include "core/localizer/schedule.h"
#include "core/match/search_window.h"
#include "core/pnp/correspondence.h"
#include "core/record/record_hashes.h"
#include "core/templates/template_selection.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/problem.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/units.h"
#include "sessions/trace/iteration_trace.h"
#include "sessions/trace/match_details.h"
#include "sessions/trace/scene_render.h"

namespace boresight::sessions {
namespace {

/// Renders the scene level by level as a run would, and chooses templates in what it shows.
class ReplayScene {
 public:
  /// What `ground` points to must outlive the object.
  explicit ReplayScene(const LocalizationProblem& ground) : ground_(ground) {}

  /// False when the scene cannot be rendered from there.
  bool render(const Pose& camera_from_station, int level, RenderTrace& output) {
    if (level < 0 || level >= kPyramidLevels || !isUsable(camera_from_station)) return false;
    auto found = levels_.find(level);
    if (found == levels_.end()) {
      SceneRenderer created;
      const Camera camera = cameraAtLevel(ground_.camera, level);
      if (created.create(camera, ground_.mesh) != Status::kOk) return false;
      found = levels_.emplace(level, std::move(created)).first;
    }
    return found->second.render(camera_from_station, output) == Status::kOk;
  }

  /// Templates that the core chooses in a render of that level; none when it cannot.
  std::vector<Template> choose(const RenderTrace& render, int level, int side_px,
                               const TemplateOptions& options) const {
    const int width = render.edges.width;
    const int height = render.edges.height;
    if (side_px < 2 || side_px > std::min(width, height)) return {};
    Arena counter;
    TemplateSelector selector;
    if (selector.create(width, height, options, counter) != Status::kOk) return {};
    (void)createTemplateSet(options, counter);
    const std::size_t bytes = counter.highWater();
    const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
    Arena arena({memory.get(), bytes});
    if (selector.create(width, height, options, arena) != Status::kOk) return {};
    TemplateSet chosen = createTemplateSet(options, arena);
    (void)selector.select(render.view(), side_px, ground_.ignore, level, chosen);
    return {chosen.templates.begin(), chosen.templates.begin() + chosen.count};
  }

 private:
  const LocalizationProblem& ground_;
  std::map<int, SceneRenderer> levels_;
};

std::string inIteration(const IterationTrace& iteration) {
  return " in iteration " + std::to_string(iteration.index + 1);
}

Template templateAt(const RecordedTemplate& recorded, const RenderTrace& render,
                    const std::vector<Template>& chosen) {
  for (const Template& candidate : chosen)
    if (candidate.center_x == recorded.x && candidate.center_y == recorded.y) return candidate;
  Template result;
  result.center_x = recorded.x;
  result.center_y = recorded.y;
  result.depth_m = result.distinctness = std::numeric_limits<float>::quiet_NaN();
  result.point_in_station_m.setConstant(kUnknown);
  if (render.row_begin.empty() || recorded.x >= render.edges.width ||
      recorded.y >= render.edges.height)
    return result;
  const RenderView owned = render.view();
  const EdgeRender& view = owned.render;
  const std::int32_t pixel = findEdgePixel(view, recorded.x, recorded.y);
  if (pixel < 0) return result;
  const EdgePixel& edge = render.pixels[static_cast<std::size_t>(pixel)];
  Eigen::Vector3d point_in_station_m;
  if (!edgePointInStation(view, edge, point_in_station_m)) return result;
  result.depth_m = edge.depth_m;
  result.point_in_station_m = point_in_station_m;
  return result;
}

bool liesInside(const Template& item, int side_px, const RenderTrace& render) {
  const int half = side_px / 2;
  return side_px >= 2 && item.center_x >= half && item.center_y >= half &&
         item.center_x + half <= render.edges.width && item.center_y + half <= render.edges.height;
}

/// Iterations one after the other: what an iteration is depends on those before it.
class Replayer {
 public:
  Replayer(const OnboardRecord& record, const LocalizationProblem& ground)
      : record_(record), given_(ground), scene_(given_), recorded_plan_(planOf(record)) {
    if (record.inputs) {
      given_.camera_from_station_seed = record.inputs->camera_from_station_seed;
      given_.uncertainty = record.inputs->uncertainty;
      given_.end_effector_in_camera_m = record.inputs->end_effector_in_camera_m;
    }
    bounds_ = matchedBounds(ground.mesh);
    run_.replayed = true;
    run_.version = "onboard";
    run_.options = recorded_plan_.plan.options;
    run_.changes = recorded_plan_.plan.changes;
    run_.camera = ground.camera;
    run_.camera_from_station_seed = run_.camera_from_station = given_.camera_from_station_seed;
    run_.uncertainty = given_.uncertainty;
  }

  LocalizationTrace replay(const std::stop_token& stop) {
    noteInputs();
    detect();
    for (const RecordedIteration& recorded : record_.iterations) {
      if (stop.stop_requested()) break;
      run_.iterations.push_back(std::make_shared<const IterationTrace>(iterationOf(recorded)));
    }
    finish();
    return std::move(run_);
  }

 private:
  void remark(const std::string& text) { run_.remarks.push_back(text); }

  const LocalizerOptions& optionsAt(std::int32_t index) const {
    const LocalizerOptions* options = &run_.options;
    for (const OptionChange& change : run_.changes)
      if (change.iteration <= index) options = &change.options;
    return *options;
  }

  void noteInputs() {
    for (const std::string& text : record_.missing)
      remark("The record is incomplete: " + text + ".");
    for (const std::string& text : recorded_plan_.remarks) remark(text);
    if (!record_.inputs) return;
    const RecordedInputs& onboard = *record_.inputs;
    RecordInputs record_inputs = recordInputs(withoutUnusedInputs(given_, run_.options));
    if (onboard.sha256.pixels != record_inputs.pixels) {
      // The run may have had the gray image alone.
      LocalizationProblem gray = given_;
      gray.color = {};
      record_inputs = recordInputs(gray);
    }
    same_size_ = onboard.width == given_.camera.width && onboard.height == given_.camera.height;
    if (!same_size_)
      remark("The run's image has " + sizeText(onboard.width, onboard.height) +
             " px, this case's camera " + sizeText(given_.camera.width, given_.camera.height) +
             "; the record may belong to another case; only its poses are shown.");
    else if (onboard.sha256.pixels != record_inputs.pixels)
      remark(
          "The run's pixels differ from this case's image (compressed downlink, or another image); "
          "edges, score maps and agreement are computed from this case's image.");
    if (onboard.sha256.ignore != record_inputs.ignore)
      remark("The run's ignore mask differs from this case's mask.");
    if (onboard.sha256.scene != record_inputs.scene)
      remark(
          "The run's mesh differs from this case's mesh; renders and points are computed from this "
          "case's mesh.");
    if (onboard.sha256.camera != record_inputs.camera)
      remark(
          "The run's camera differs from this case's camera; renders and points are computed with "
          "this case's camera.");
  }

  void detect() {
    auto edges = std::make_shared<EdgeMapTrace>();
    const Status status = detectEdges(given_.image, given_.ignore, run_.options.edges, *edges);
    if (status != Status::kOk) {
      remark(std::string("The image's edges cannot be computed: ") + statusText(status) + ".");
      if (record_.edges) edges->edge_count = record_.edges->edge_count;
    } else if (record_.edges && record_.inputs && same_size_) {
      EdgeMap map;
      for (std::size_t i = 0; i < map.level.size(); ++i) map.level[i] = edges->level[i].view();
      if (edgeMapHash(map) != record_.edges->sha256)
        remark("This case's image edges differ from those of the run on board: " +
               std::to_string(edges->edge_count) + " edge pixels on the ground, " +
               std::to_string(record_.edges->edge_count) + " on board.");
    }
    run_.edges = std::move(edges);
  }

  void startAttempt(const IterationTrace& iteration) {
    if (iteration.attempt == attempt_) return;
    const bool follows =
        !run_.iterations.empty() && run_.iterations.back()->index == iteration.index - 1;
    attempt_ = iteration.attempt;
    attempt_begin_.reset();
    if (iteration.attempt == 0) attempt_begin_ = 0;
    if (iteration.attempt > 0 && follows) attempt_begin_ = iteration.index;
    startFromCandidate(iteration);
  }

  /// Attempts of a run that searched start from a candidate: in a box of its own when its templates
  /// are matched, with a refinement otherwise.
  void startFromCandidate(const IterationTrace& iteration) {
    attempt_seed_ = seedOf(given_);
    if (!optionsAt(iteration.index).search.enabled || !attempt_begin_) return;
    const Pose& before = iteration.camera_from_station_before;
    if (iteration.kind == IterationKind::kRefine) {
      *attempt_begin_ -= optionsAt(iteration.index).loop.match_iterations;
      attempt_seed_ = seedOfRepeated(iteration);
    } else if (before != given_.camera_from_station_seed && isUsable(before))
      attempt_seed_ = {before, uncertaintyAbout(before, seedOf(given_), bounds_)};
    seeds_[iteration.attempt] = attempt_seed_;
  }

  /// The last attempt repeats an iteration of the best one, in the box of that one.
  Seed seedOfRepeated(const IterationTrace& iteration) const {
    for (const auto& earlier : run_.iterations)
      if (earlier->kind == IterationKind::kRefine && seeds_.contains(earlier->attempt) &&
          earlier->camera_from_station_before == iteration.camera_from_station_before)
        return seeds_.at(earlier->attempt);
    return seedOf(given_);
  }

  /// The pose before a match, rolled.
  Pose matchedPose(const IterationTrace& iteration) const {
    const Pose& before = iteration.camera_from_station_before;
    const auto chosen = static_cast<std::size_t>(iteration.chosen_hypothesis);
    return chosen == 0 ? before
                       : rolledAboutScene(before, iteration.hypotheses[chosen].roll_rad, bounds_);
  }

  /// Whether the render from a pose is the one on board.
  bool renderAs(const RecordedIteration& recorded, const Pose& camera_from_station,
                IterationTrace& iteration) {
    return scene_.render(camera_from_station, iteration.level, iteration.render) &&
           (!recorded.render_sha256 ||
            renderHash(iteration.render.view()) == *recorded.render_sha256);
  }

  /// A refinement renders from the pose before it, keeps the render of an earlier one, or renders
  /// from a pose found before, as restarts do.
  bool renderRefined(const RecordedIteration& recorded, IterationTrace& iteration) {
    const Pose& before = iteration.camera_from_station_before;
    bool same = renderAs(recorded, before, iteration);
    // Where one render differs, others may, too: they would all be tried in vain.
    if (!noted_render_)
      for (auto from = refined_from_.rbegin(); !same && from != refined_from_.rend(); ++from)
        same = renderAs(recorded, *from, iteration);
    if (!same) {
      iteration.render = {};
      (void)scene_.render(before, iteration.level, iteration.render);
    }
    refined_from_.push_back(before);
    if (isUsable(iteration.camera_from_station))
      refined_from_.push_back(iteration.camera_from_station);
    return same;
  }

  void renderAgain(const RecordedIteration& recorded, IterationTrace& iteration) {
    const bool failed =
        iteration.reached == Stage::kRender && iteration.status == LocalizationStatus::kFault;
    if (!same_size_ || failed || !isUsable(iteration.camera_from_station_before)) return;
    const bool same = iteration.kind == IterationKind::kMatch
                          ? renderAs(recorded, matchedPose(iteration), iteration)
                          : renderRefined(recorded, iteration);
    if (same || std::exchange(noted_render_, true)) return;
    const bool rendered = !iteration.render.row_begin.empty();
    remark((rendered ? "The station's render differs from that on board"
                     : "The station cannot be rendered") +
           inIteration(iteration) +
           ", possibly in others; points of templates may be missing or differ.");
  }

  Match matchOf(const RecordedTemplate& recorded, const Template& item,
                const IterationTrace& iteration) const {
    Match match;
    if (liesInside(item, iteration.template_side_px, iteration.render)) {
      const BitImage edges = iteration.render.edges.view();
      const BitImage mask = iteration.render.mask.view();
      match.norms =
          whsNorms({&edges, &mask, item.center_x, item.center_y, iteration.template_side_px});
      if (item.point_in_station_m.allFinite() && attempt_begin_)
        match.window = searchWindow(iteration.render.camera,
                                    iteration.camera_from_station_before * item.point_in_station_m,
                                    iteration.uncertainty, iteration.template_side_px);
    }
    if (!recorded.searched) return match;
    match.searched = true;
    match.at_border = recorded.at_border;
    match.x = static_cast<double>(recorded.found_x);
    match.y = static_cast<double>(recorded.found_y);
    match.peak.x = static_cast<int>(std::lround(std::clamp(match.x, -1e6, 1e6)));
    match.peak.y = static_cast<int>(std::lround(std::clamp(match.y, -1e6, 1e6)));
    return match;
  }

  void fillTemplates(const RecordedIteration& entry, IterationTrace& iteration) {
    if (!entry.templates || !same_size_) return;
    const std::vector<Template> chosen =
        scene_.choose(iteration.render, iteration.level, iteration.template_side_px,
                      optionsAt(iteration.index).templates);
    int unknown = 0;
    double sum = 0.0;
    for (const RecordedTemplate& recorded : *entry.templates) {
      iteration.templates.push_back(templateAt(recorded, iteration.render, chosen));
      const Template& item = iteration.templates.back();
      if (!item.point_in_station_m.allFinite()) ++unknown;
      if (iteration.reached < Stage::kMatch) continue;
      iteration.matches.push_back(matchOf(recorded, item, iteration));
      RecordedScore score{static_cast<double>(recorded.score), std::nullopt};
      if (recorded.second_score) score.second_score = static_cast<double>(*recorded.second_score);
      iteration.recorded_scores.push_back(score);
      if (!recorded.searched) continue;
      iteration.best_score = std::max(iteration.best_score, score.score);
      sum += score.score;
    }
    if (iteration.searched_count > 0) iteration.mean_score = sum / iteration.searched_count;
    if (unknown > 0)
      remark(std::to_string(unknown) + " of " + std::to_string(entry.templates->size()) +
             " templates lie on no rendered edge" + inIteration(iteration) +
             "; their points are unknown.");
  }

  /// Pairs of points and places, in the order of the templates; residuals are the recorded pose's.
  void fillPairs(const RecordedIteration& recorded, IterationTrace& iteration) const {
    const double scale = static_cast<double>(1 << iteration.level);
    const bool solved =
        iteration.reached >= Stage::kPose && iteration.status != LocalizationStatus::kPnpFailed;
    for (std::size_t i = 0; i < iteration.matches.size(); ++i) {
      const Template& item = iteration.templates[i];
      const Match& match = iteration.matches[i];
      if (!match.searched || !item.point_in_station_m.allFinite()) continue;
      Correspondence pair;
      pair.point_in_station_m = item.point_in_station_m;
      pair.pixel = atFullResolution({match.x, match.y}, iteration.level);
      pair.sigma_px = kMatchSigma_px * scale;
      iteration.correspondences.push_back(pair);
      iteration.template_of.push_back(static_cast<std::int32_t>(i));
      if (!solved) continue;
      Eigen::Vector2d projected;
      const bool seen =
          project(run_.camera, iteration.camera_from_station * pair.point_in_station_m, projected);
      iteration.pnp.inlier.push_back((*recorded.templates)[i].inlier ? 1 : 0);
      iteration.pnp.residual_px.push_back(seen ? (projected - pair.pixel).norm() : kUnknown);
    }
  }

  IterationTrace iterationOf(const RecordedIteration& recorded) {
    IterationTrace iteration = recorded.trace;
    startAttempt(iteration);
    if (attempt_begin_)
      iteration.uncertainty = uncertaintyAt(attempt_seed_, optionsAt(iteration.index).loop,
                                            std::max(0, iteration.index - *attempt_begin_),
                                            iteration.camera_from_station_before);
    renderAgain(recorded, iteration);
    if (iteration.kind == IterationKind::kMatch) {
      fillTemplates(recorded, iteration);
      fillPairs(recorded, iteration);
    } else if (!std::exchange(noted_refinement_, true)) {
      remark(
          "Records do not hold the edge points of refinements; run the case again on the ground to "
          "show them.");
    }
    return iteration;
  }

  void finish() {
    for (const RecordedIteration& recorded : record_.iterations) {
      if (recorded.support) run_.support = *recorded.support;
      run_.attempts = std::max(run_.attempts, recorded.trace.attempt + 1);
    }
    if (!record_.end) return;
    const RecordedEnd& end = *record_.end;
    run_.finished = end.status != LocalizationStatus::kRunning;
    run_.stage = Stage::kFinished;
    run_.attempts = end.attempts;
    run_.status = end.status;
    run_.fault = end.fault;
    run_.camera_from_station = end.camera_from_station;
    run_.covariance = end.covariance;
    run_.digest = end.digest;
  }

  const OnboardRecord& record_;
  LocalizationProblem given_;  ///< the ground's, with the record's seed
  ReplayScene scene_;
  RecordedPlan recorded_plan_;
  BoundingBox bounds_;
  LocalizationTrace run_;
  bool same_size_ = true;
  std::int32_t attempt_ = -1;
  std::optional<std::int32_t> attempt_begin_;  ///< index of its first iteration, if known
  Seed attempt_seed_;                          ///< where it started, and within what
  std::map<std::int32_t, Seed> seeds_;         ///< of the attempts of a run that searched
  std::vector<Pose> refined_from_;             ///< poses that later refinements may render from
  bool noted_render_ = false;
  bool noted_refinement_ = false;
};

}  // namespace

LocalizationTrace replayRecord(const OnboardRecord& record, const LocalizationProblem& ground,
                               const std::stop_token& stop) {
  return Replayer(record, ground).replay(stop);
}

}  // namespace boresight::sessions
