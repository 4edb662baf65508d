// SPDX-License-Identifier: Apache-2.0
// Begins and ends passes; pass_stages.cpp has the stages.
#include "core/localizer/pass.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

Status validateProblem(const LocalizationProblem& problem, const LocalizerOptions& options) {
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (options.loop.correction_point == CorrectionPoint::kEndEffector &&
      problem.end_effector_in_camera_m.isZero(0.0))
    return Status::kInvalidOption;  // no end effector is known
  if (problem.image.data == nullptr || problem.image.width != problem.camera.width ||
      problem.image.height != problem.camera.height) {
    return Status::kInvalidImage;
  }
  if (problem.color.data != nullptr && (problem.color.width != problem.image.width ||
                                        problem.color.height != problem.image.height)) {
    return Status::kInvalidImage;
  }
  if (!(problem.camera.valid_radius > 0.0)) return Status::kInvalidCamera;  // not prepared
  if (!isUsable(PosePrior{problem.camera_from_station_seed, problem.uncertainty}))
    return Status::kInvalidPose;
  if (!problem.end_effector_in_camera_m.allFinite()) return Status::kInvalidPose;
  return validateMesh(problem.mesh);
}

}  // namespace

Status Pass::create(const LocalizationProblem& problem, const LocalizerOptions& options,
                    std::span<std::byte> block, int workers, Kernels kernels) {
  problem_ = problem;
  options_ = options;
  workspace_ = {};
  workspace_.camera_from_station = problem.camera_from_station_seed;
  digest_ = DigestWriter();
  running_ = false;
  const Status valid = validateProblem(problem_, options_);
  if (valid != Status::kOk) return valid;
  const Status laid_out =
      memory_.create(problem_, options_, workers, kernels, block, workspace_.edges);
  if (laid_out != Status::kOk) return laid_out;
  levels_ = levelsOf(sizeOf(problem_), options_);
  seal_.sealTables(memory_.tables());
  seal_.sealEdges(workspace_.edges, levels_);
  scene_ = matchedBounds(problem_.mesh);
  const LocalizationProblem used = withoutUnusedInputs(problem, options);
  searched_ = {problem_.image,
               used.color,
               problem_.ignore,
               problem_.camera,
               problem_.mesh,
               scene_,
               problem_.camera_from_station_seed,
               problem_.uncertainty};
  const std::array<std::uint8_t, 32> inputs = inputDigest(options_, used);
  digest_.bytes(inputs);
  seal_.sealInputs(inputs);
  if (match_outside_) matchOutside(surfaces_);
  return Status::kOk;
}

void Pass::begin(const PassPlan& plan) {
  plan_ = plan;
  outcome_ = {};
  running_ = true;
  stage_begun_ = false;
  task_begun_ = false;
  evidence_complete_ = false;
  solver_waits_ = false;
  failed_ = LocalizationStatus::kRunning;
  memory_.tasks.open(0);
  switch (plan_.kind) {
    case PassKind::kEdges:
      stage_ = Stage::kEdges;
      break;
    case PassKind::kNearSearch:
    case PassKind::kSearch:
      dropOtherEdges();
      stage_ = Stage::kSearch;
      break;
    case PassKind::kMatch:
    case PassKind::kRefine:
      prepareRecord();
      stage_ = Stage::kRender;
      break;
    case PassKind::kEvidence:
    case PassKind::kSupport:
    case PassKind::kCompare:
    case PassKind::kMirror:
    case PassKind::kWider:
      stage_ = Stage::kSupport;
      break;
  }
}

/// Releases the edge maps of levels that are not matched: the renders lie in their memory.
void Pass::dropOtherEdges() {
  for (int level = 0; level < kPyramidLevels; ++level)
    if (level < levels_.fine || level > levels_.coarse)
      nth(workspace_.edges.level, level) = BitImage();
}

void Pass::prepareRecord() {
  dropOtherEdges();
  Iteration& iteration = record();
  iteration.index = workspace_.iterations;
  iteration.attempt = plan_.attempt;
  iteration.status = LocalizationStatus::kRunning;
  iteration.kind = plan_.kind == PassKind::kRefine ? IterationKind::kRefine : IterationKind::kMatch;
  iteration.level = plan_.level;
  iteration.camera_from_station_before = plan_.camera_from_station;
  iteration.uncertainty = plan_.uncertainty;
  iteration.threshold_px = plan_.threshold_px;
  if (!keepsRender(iteration)) iteration.render = renderMemory();
  iteration.templates.count = 0;
  iteration.matches.count = 0;
  iteration.matches.searched = 0;
  iteration.correspondence_count = 0;
  iteration.pnp.inlier_count = 0;
  iteration.refinement.sample_count = 0;
  iteration.refinement.found_count = 0;
  iteration.refinement.used_count = 0;
  workspace_.iteration = &iteration;
}

EdgeRender& Pass::renderMemory() {
  const auto record = static_cast<std::size_t>(plan_.record);
  return plan_.level == levels_.coarse ? memory_.coarse_render[record] : memory_.fine_render;
}

/// Whether the last refinement's render shows the scene as a new render would.
bool Pass::keepsRender(const Iteration& iteration) const {
  const Camera& camera = nth(memory_.rays, plan_.level).camera();
  return iteration.render.camera.width == camera.width &&
         displacementBetween_px(iteration.render.camera_from_station, plan_.rendered_from_station,
                                scene_, problem_.camera) < plan_.keep_render_px;
}

int Pass::tasks() const { return running_ && !task_begun_ ? memory_.tasks.count() : 0; }

void Pass::runTask(int task, int worker) {
  if (task < 0 || task >= tasks() || worker < 0 ||
      static_cast<std::size_t>(worker) >= memory_.searches.size())
    return;
  if (memory_.tasks.isDone(task)) return;
  if (stage_ == Stage::kRender) {
    memory_.renderer.runTask(task, worker);
  } else if (stage_ == Stage::kMatch) {
    WhsSearch& search = nth(memory_.searches, worker);
    if (beginMatch(task, search)) {
      while (!search.step()) {
      }
      finishMatch(task, search);
    }
  } else {
    memory_.refinement.searchChunk(task);
  }
  memory_.tasks.markDone(task);
}

PassNeed Pass::needs() const {
  if (!running_) return PassNeed::kNothing;
  if (match_outside_ && !matches_supplied_ && stage_ == Stage::kMatch) return PassNeed::kMatches;
  if (!solver_waits_) return PassNeed::kNothing;
  return stage_ == Stage::kPose ? PassNeed::kPose : PassNeed::kRound;
}

/// Ends the pass.
StepReport Pass::end(Stage stage) {
  outcome_.reached = stage;
  running_ = false;
  memory_.tasks.open(0);
  return StepReport::of(stage, true);
}

/// Too little data for a pose.
StepReport Pass::endFailed(Stage stage, LocalizationStatus status) {
  Iteration& iteration = record();
  iteration.status = status;
  if (solve_outside_) {
    failed_ = status;
    outcome_.reached = stage;
    iteration.correspondence_count = 0;
    stage_ = plan_.kind == PassKind::kRefine ? Stage::kRefine : Stage::kPose;
    stage_begun_ = false;
    return StepReport::of(stage, true);
  }
  if (plan_.kind == PassKind::kMatch) {
    iteration.pnp.inlier_count = 0;
    iteration.pnp.camera_from_station = plan_.camera_from_station;
  }
  return end(stage);
}

StepReport Pass::endFaulted(Stage stage, Status fault) {
  outcome_.fault = workspace_.fault = fault;
  return end(stage);
}

void Pass::show(const Ruling& ruling) {
  Iteration& shown = nth(memory_.records, ruling.record);
  workspace_.iteration = &shown;
  if (ruling.failed()) shown.status = ruling.status;
  if ((ruling.iteration_complete || ruling.failed()) && shown.index == workspace_.iterations)
    ++workspace_.iterations;
}

void Pass::changeOptions(const LocalizerOptions& options) {
  const LocalizationProblem used = withoutUnusedInputs(problem_, options);
  const bool held = seal_.holdsInputs(options_, withoutUnusedInputs(problem_, options_));
  options_ = options;
  if (held) seal_.sealInputs(inputDigest(options_, used));
  memory_.selector.setOptions(options.templates);
  memory_.refinement.setOptions(options.refinement);
  digest_.tag("changed");
  digestOptions(options, digest_);
}

bool Pass::memoryHolds() const {
  return seal_.holdsInputs(options_, withoutUnusedInputs(problem_, options_)) &&
         seal_.holdsTables(memory_.tables()) && seal_.holdsEdges(workspace_.edges, levels_);
}

void Pass::finish(LocalizationStatus status, const Pose& camera_from_station,
                  const Matrix6d& covariance) {
  const bool converged = status == LocalizationStatus::kConverged;
  workspace_.status = status;
  workspace_.camera_from_station =
      converged ? camera_from_station : problem_.camera_from_station_seed;
  if (converged) workspace_.covariance = covariance;
  if (searches()) digestHypotheses(workspace_.hypotheses, digest_);
  digest_.tag(localizationStatusText(status));
  digestPose(workspace_.camera_from_station, digest_);
}

}  // namespace boresight
