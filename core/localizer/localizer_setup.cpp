// SPDX-License-Identifier: Apache-2.0
// What happens before the first step: profiles, checks, memory.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {

const char* localizationStatusText(LocalizationStatus status) {
  switch (status) {
    case LocalizationStatus::kRunning:
      return "running";
    case LocalizationStatus::kConverged:
      return "converged";
    case LocalizationStatus::kLeftUncertainty:
      return "left_uncertainty";
    case LocalizationStatus::kTooFewEdges:
      return "too_few_edges";
    case LocalizationStatus::kTooFewTemplates:
      return "too_few_templates";
    case LocalizationStatus::kTooFewMatches:
      return "too_few_matches";
    case LocalizationStatus::kPnpFailed:
      return "pnp_failed";
    case LocalizationStatus::kNotSupported:
      return "not_supported";
    case LocalizationStatus::kIterationLimit:
      return "iteration_limit";
    case LocalizationStatus::kFault:
      return "fault";
    case LocalizationStatus::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

const char* stageText(Stage stage) {
  switch (stage) {
    case Stage::kEdges:
      return "edges";
    case Stage::kRender:
      return "render";
    case Stage::kTemplates:
      return "templates";
    case Stage::kMatch:
      return "match";
    case Stage::kPose:
      return "pose";
    case Stage::kRefine:
      return "refine";
    case Stage::kSupport:
      return "support";
    case Stage::kFinished:
      return "finished";
  }
  return "unknown";
}

LocalizerOptions defaultProfile() { return {}; }

LocalizerOptions paperProfile() {
  LocalizerOptions options;
  options.render.max_edge_pixels = 200000;  // of the whole resolution
  options.templates.size_factor = 1.0;
  options.pnp.sampler = PnpSampler::kP3p;
  options.loop.match_iterations = options.loop.max_iterations;
  options.loop.coarse_size_px = 16384;
  options.loop.halved_size_px = 16384;
  options.loop.max_rolled_hypotheses = 1;
  options.loop.max_attempts = 1;
  options.loop.correction_point = CorrectionPoint::kCamera;
  options.loop.converged_image_px = 0.0;
  options.loop.enough_inliers = 2.0;
  options.loop.render_again_px = 0.0;
  options.loop.anchored = false;
  options.refinement.enabled = false;
  options.support.gate = false;
  return options;
}

ProblemSize sizeOf(const LocalizationProblem& problem) {
  return {problem.image.width,
          problem.image.height,
          static_cast<int>(problem.mesh.vertices_in_station_m.size()),
          static_cast<int>(problem.mesh.faces.size()),
          static_cast<int>(problem.mesh.parts.size()),
          problem.camera.model,
          problem.ignore != nullptr};
}

namespace {

/// Everything but the render and the samples.
Iteration createIteration(const LocalizerOptions& options, Arena& arena) {
  Iteration iteration;
  const auto templates = static_cast<std::size_t>(options.templates.count);
  iteration.templates = createTemplateSet(options.templates, arena);
  iteration.matches.matches = arena.allocate<Match>(templates);
  iteration.correspondences = arena.allocate<Correspondence>(templates);
  iteration.template_of = arena.allocate<std::int32_t>(templates);
  iteration.pnp.inlier = arena.allocate<std::uint8_t>(templates);
  iteration.pnp.residual_px = arena.allocate<double>(templates);
  return iteration;
}

/// Any camera of that model and size, for counting.
Camera placeholderCamera(const ProblemSize& size) {
  Camera camera;
  camera.model = size.model;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = camera.fy = std::max(size.width, size.height);
  camera.cx = 0.5 * size.width;
  camera.cy = 0.5 * size.height;
  return camera;
}

/// A mesh of the right size with nothing in it, for counting.
MeshView placeholderMesh(const ProblemSize& size) {
  MeshView mesh;
  mesh.vertices_in_station_m = {static_cast<const Eigen::Vector3f*>(nullptr),
                                static_cast<std::size_t>(size.vertices)};
  mesh.faces = {static_cast<const Face*>(nullptr), static_cast<std::size_t>(size.faces)};
  mesh.parts = {static_cast<const ScenePart*>(nullptr), static_cast<std::size_t>(size.parts)};
  return mesh;
}

Status validateProblem(const LocalizationProblem& problem, const LocalizerOptions& options) {
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (problem.image.data == nullptr || problem.image.width != problem.camera.width ||
      problem.image.height != problem.camera.height) {
    return Status::kInvalidImage;
  }
  if (!(problem.camera.valid_radius > 0.0)) return Status::kInvalidCamera;  // not prepared
  if (!isUsable(PosePrior{problem.camera_from_station_seed, problem.uncertainty}))
    return Status::kInvalidPose;
  return validateMesh(problem.mesh);
}

/// The block from its first aligned byte on.
std::span<std::byte> alignedBlock(std::span<std::byte> memory) {
  const std::size_t past = reinterpret_cast<std::uintptr_t>(memory.data()) % Arena::kAlignment;
  const std::size_t skipped = past > 0 ? Arena::kAlignment - past : 0;
  return memory.subspan(std::min(skipped, memory.size()));
}

}  // namespace

Localizer::Localizer(const LocalizationProblem& problem, const LocalizerOptions& options,
                     std::span<std::byte> memory, int workers, Kernels kernels)
    : problem_(problem),
      options_(options),
      memory_(alignedBlock(memory)),
      workers_(workers),
      kernels_(kernels) {
  if (memory_.empty()) {
    status_ = Status::kArenaTooSmall;
    return;
  }
  begin();
}

void Localizer::begin() {
  status_ = validateProblem(problem_, options_);
  if (status_ == Status::kOk) status_ = build();
  workspace_.status = LocalizationStatus::kRunning;
  workspace_.fault = Status::kOk;
  workspace_.iteration = nullptr;
  workspace_.support = {};
  workspace_.partial = {};
  workspace_.covariance = Matrix6d::Zero();
  workspace_.iterations = 0;
  workspace_.attempts = 1;
  workspace_.camera_from_station = problem_.camera_from_station_seed;
  camera_from_station_ = problem_.camera_from_station_seed;
  covariance_ = Matrix6d::Zero();
  // A uniform distribution's standard deviation is its half-width over the square root of 3.
  anchor_ = {problem_.camera_from_station_seed, scaled(problem_.uncertainty, 0.57735026918962576)};
  started_ = problem_;
  wide_round_ = options_.wide.isOn() ? WideRound::kRestarts : WideRound::kNone;
  weighing_ = false;
  finalist_count_ = 0;
  finalists_used_ = 0;
  rival_round_ = RivalRound::kNone;
  rival_count_ = 0;
  workspace_.rivals = {};
  stage_ = Stage::kEdges;
  stage_begun_ = false;
  iteration_pending_ = false;
  hypothesis_pending_ = false;
  iteration_ = 0;
  attempt_ = 0;
  current_ = 0;
  small_corrections_ = 0;
  failed_count_ = 0;
  openPieces(0);
  const ViewRole role = link_.role;
  link_ = {};
  link_.role = role;
  digest_ = DigestWriter();
  if (status_ != Status::kOk) return;
  bounds_ = matchedBounds(problem_.mesh);
  if (options_.wide.isOn()) grid_ = RestartGrid(problem_, bounds_, options_.wide);
  digestOptions(options_, digest_);
  digestProblem(problem_, digest_);
  if (match_outside_) matchOutside(surfaces_);
}

std::size_t MemoryUse::total() const {
  return kept + std::max(construction, *std::max_element(stage.begin(), stage.end()));
}

Status Localizer::requiredBytes(const ProblemSize& size, const LocalizerOptions& options,
                                int workers, std::size_t& bytes, Kernels kernels) {
  MemoryUse use;
  const Status status = requiredMemory(size, options, workers, use, kernels);
  bytes = use.total();
  return status;
}

Status Localizer::requiredMemory(const ProblemSize& size, const LocalizerOptions& options,
                                 int workers, MemoryUse& use, Kernels kernels) {
  LocalizationProblem problem;
  problem.image.width = size.width;
  problem.image.height = size.height;
  problem.camera = placeholderCamera(size);
  problem.mesh = placeholderMesh(size);
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (prepareCamera(problem.camera) != Status::kOk) return Status::kInvalidCamera;
  Localizer counter(problem, options, {}, workers, kernels);
  const Status status = counter.layOut(size);
  use = counter.memory_use_;
  return status;
}

/// Counts, then divides the block and lays everything out once more, in earnest.
Status Localizer::build() {
  kept_ = Arena();
  scratch_ = Arena();
  const Status status = layOut(sizeOf(problem_));
  if (status != Status::kOk) return status;
  if (memory_use_.total() > memory_.size()) return Status::kArenaTooSmall;
  kept_ = Arena(memory_.first(memory_use_.kept));
  scratch_ = Arena(memory_.subspan(memory_use_.kept));
  return layOut(sizeOf(problem_));
}

Status Localizer::layOut(const ProblemSize& size) {
  if (workers_ < 1 || workers_ > kMaxWorkers) return Status::kInvalidOption;
  coarse_level_ = coarseLevel(size.width, size.height, options_.loop);
  fine_level_ = std::max(0, coarse_level_ - 1);
  wide_level_ = wideLevel(size.width, size.height, options_);
  Status status = layOutKept();
  if (status == Status::kOk) status = layOutStages(size);
  if (kept_.countsOnly()) memory_use_.kept = kept_.highWater();
  if (status == Status::kOk && (kept_.exhausted() || scratch_.exhausted()))
    status = Status::kArenaTooSmall;
  return status;
}

Status Localizer::layOutKept() {
  Status status = buildAdjacency(problem_.mesh, kept_, scratch_, adjacency_);
  shareScratch(memory_use_.construction);
  for (int level = fine_level_; level <= wide_level_ && status == Status::kOk; ++level) {
    if (level > coarse_level_ && level < wide_level_) continue;
    status = RayGrid::create(cameraAtLevel(problem_.camera, level), kept_,
                             rays_[static_cast<std::size_t>(level)]);
  }
  layOutRenders();
  if (options_.wide.isOn()) layOutWideSearch();
  if (options_.ambiguity.enabled) layOutRivals();
  searches_ = kept_.allocate<WarpedSearch>(static_cast<std::size_t>(workers_));
  done_ = kept_.allocate<std::uint8_t>(static_cast<std::size_t>(
      std::max({options_.templates.count, EdgeRefinement::chunksOf(options_.refinement),
                EdgeRenderer::mostPieces(workers_)})));
  if (options_.templates.learn) {
    failed_in_station_m_ =
        kept_.allocate<Eigen::Vector3d>(static_cast<std::size_t>(options_.templates.count));
  }
  buffers_[0] = createIteration(options_, kept_);
  if (comparesHypotheses(options_)) buffers_[1] = createIteration(options_, kept_);
  return status;
}

EdgeRender Localizer::createRender(int level) {
  const Camera camera = cameraAtLevel(problem_.camera, level);
  const std::int32_t capacity = options_.render.max_edge_pixels >> (level - fine_level_);
  return createEdgeRender(camera.width, camera.height,
                          std::min(capacity, camera.width * camera.height), kept_);
}

/// The first iteration compares two coarse renders; later ones have one fine render in their place.
void Localizer::layOutRenders() {
  const std::size_t start = kept_.mark();
  coarse_render_[0] = createRender(coarse_level_);
  if (comparesHypotheses(options_)) coarse_render_[1] = createRender(coarse_level_);
  fine_render_ = coarse_render_[0];
  if (fine_level_ == coarse_level_) return;
  const std::size_t end = kept_.mark();
  kept_.rewind(start);
  fine_render_ = createRender(fine_level_);
  kept_.rewind(std::max(end, kept_.mark()));
}

/// One after the other in the same memory; the edges last, as that stage is the first to run.
Status Localizer::layOutStages(const ProblemSize& size) {
  const int width = ((size.width - 1) >> fine_level_) + 1;
  const int height = ((size.height - 1) >> fine_level_) + 1;
  std::size_t evidence_bytes = 0;
  Status status = renderer_.create(problem_.mesh, adjacency_, width, height, options_.render, kept_,
                                   scratch_, EdgeRenderer::kBandRows, workers_);
  shareScratch(bytesOf(Stage::kRender));
  if (options_.wide.isOn() && scratch_.countsOnly()) evidence_bytes = bytesOf(Stage::kRender);
  if (status == Status::kOk) status = selector_.create(width, height, options_.templates, scratch_);
  shareScratch(bytesOf(Stage::kTemplates));
  const int side = std::min(options_.templates.max_side_px, 512);
  WarpedSearch counted;
  for (int worker = 0; worker < workers_ && status == Status::kOk; ++worker) {
    WarpedSearch& search =
        searches_.empty() ? counted : searches_[static_cast<std::size_t>(worker)];
    status =
        search.create(side, std::max(width, height), options_.warp.enabled, kernels_, scratch_);
  }
  shareScratch(bytesOf(Stage::kMatch));
  if (status == Status::kOk) status = ransac_.create(options_.templates.count, scratch_);
  shareScratch(bytesOf(Stage::kPose));
  // The poses of restarts are rendered, too.
  if (scratch_.countsOnly())
    bytesOf(Stage::kPose) = std::max(bytesOf(Stage::kPose), evidence_bytes);
  if (status == Status::kOk) status = refinement_.create(options_.refinement, scratch_);
  if (options_.refinement.enabled) {
    buffers_[0].refinement.samples =
        scratch_.allocate<EdgeSample>(static_cast<std::size_t>(options_.refinement.max_samples));
  }
  shareScratch(bytesOf(Stage::kRefine));
  if (status == Status::kOk) {
    status = detector_.begin(problem_.image, problem_.ignore, options_.edges, kept_, scratch_,
                             fine_level_, workspace_.edges);
  }
  if (scratch_.countsOnly()) shareScratch(bytesOf(Stage::kEdges));
  return status;
}

/// What comes next takes the same memory.
void Localizer::shareScratch(std::size_t& bytes) {
  if (scratch_.countsOnly()) {
    bytes = scratch_.highWater();
    scratch_ = Arena();
  } else {
    scratch_.rewind(0);
  }
}

}  // namespace boresight
