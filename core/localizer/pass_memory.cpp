// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/pass_memory.h"

#include <algorithm>

#include "core/base/nth.h"
#include "core/edges/edge_map.h"
#include "core/localizer/schedule.h"

namespace boresight {
namespace {

/// Memory of an iteration without render and samples.
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

/// Size of the images that the search uses.
int channelsOf(const LocalizerOptions& options) {
  return options.search.color ? ColorView::kChannels : 1;
}

/// An empty mesh of the right size, for counting.
MeshView placeholderMesh(const ProblemSize& size) {
  MeshView mesh;
  mesh.vertices_in_station_m = {static_cast<const Eigen::Vector3f*>(nullptr),
                                static_cast<std::size_t>(size.vertices)};
  mesh.faces = std::span<const Face>(static_cast<const Face*>(nullptr),
                                     static_cast<std::size_t>(size.faces));
  mesh.parts = {static_cast<const ScenePart*>(nullptr), static_cast<std::size_t>(size.parts)};
  return mesh;
}

}  // namespace

/// Runs twice: with counting arenas, then in the block.
struct PassMemory::Layout {
  const LocalizationProblem& problem;
  const LocalizerOptions& options;
  int workers;
  Kernels kernels;
  RunLevels levels;
  PassMemory& to;
  EdgeMap& edges;
  std::size_t render_bytes = 0;  ///< of the renders, at the beginning of the scratch

  Status run();
  Status layOutKept();
  Status layOutStages();
  Status layOutAfterMatches();
  Status layOutSearches(int longest_px);
  void layOutRenders();
  EdgeRender createRender(int level);
  void shareScratch(std::size_t& bytes, std::size_t first);
  void shareBehindRenders(std::size_t& bytes) { shareScratch(bytes, render_bytes); }
  std::size_t& bytesOf(Stage stage) { return nth(to.use_.stage, stage); }
};

std::size_t MemoryUse::total() const {
  return kept + std::max(construction, *std::max_element(stage.begin(), stage.end()));
}

Status PassMemory::measure(const ProblemSize& size, const LocalizerOptions& options, int workers,
                           Kernels kernels, MemoryUse& use) {
  LocalizationProblem problem;
  problem.image.width = size.width;
  problem.image.height = size.height;
  problem.camera = placeholderCamera(size);
  problem.mesh = placeholderMesh(size);
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (prepareCamera(problem.camera) != Status::kOk) return Status::kInvalidCamera;
  PassMemory counter;
  EdgeMap edges;
  const Status status =
      Layout{problem, options, workers, kernels, levelsOf(size, options), counter, edges}.run();
  use = counter.use_;
  return status;
}

Status PassMemory::create(const LocalizationProblem& problem, const LocalizerOptions& options,
                          int workers, Kernels kernels, std::span<std::byte> block,
                          EdgeMap& edges) {
  kept_ = Arena();
  scratch_ = Arena();
  use_ = MemoryUse();
  Layout layout{problem, options, workers, kernels, levelsOf(sizeOf(problem), options),
                *this,   edges};
  const Status counted = layout.run();
  if (counted != Status::kOk) return counted;
  if (use_.total() > block.size()) return Status::kArenaTooSmall;
  tables_ = block.first(table_bytes_);
  kept_ = Arena(block.first(use_.kept));
  scratch_ = Arena(block.subspan(use_.kept));
  return layout.run();
}

Status PassMemory::Layout::run() {
  if (workers < 1 || workers > kMaxWorkers) return Status::kInvalidOption;
  Status status = layOutKept();
  if (status == Status::kOk) status = layOutStages();
  if (to.kept_.countsOnly()) to.use_.kept = to.kept_.highWater();
  if (status == Status::kOk && (to.kept_.exhausted() || to.scratch_.exhausted()))
    status = Status::kArenaTooSmall;
  return status;
}

Status PassMemory::Layout::layOutKept() {
  Arena& kept = to.kept_;
  Status status = buildAdjacency(problem.mesh, kept, to.scratch_, to.adjacency_);
  shareScratch(to.use_.construction, 0);
  for (int level = levels.fine; level <= levels.coarse && status == Status::kOk; ++level) {
    status = RayGrid::create(cameraAtLevel(problem.camera, level), kept, nth(to.rays, level));
  }
  if (kept.countsOnly()) to.table_bytes_ = kept.mark();
  to.searches = kept.allocate<WhsSearch>(workers);
  to.tasks.create(static_cast<std::size_t>(std::max({options.templates.count,
                                                     EdgeRefinement::chunksOf(options.refinement),
                                                     EdgeRenderer::mostTasks(workers)})),
                  kept);
  to.records[0] = createIteration(options, kept);
  if (comparesHypotheses(options)) to.records[1] = createIteration(options, kept);
  return status;
}

EdgeRender PassMemory::Layout::createRender(int level) {
  const Camera camera = cameraAtLevel(problem.camera, level);
  const std::int32_t capacity = options.render.max_edge_pixels >> (level - levels.fine);
  return createEdgeRender(camera.width, camera.height,
                          std::min(capacity, camera.width * camera.height), to.scratch_);
}

/// The first iteration compares two coarse renders; later ones have one fine render in their place.
void PassMemory::Layout::layOutRenders() {
  Arena& arena = to.scratch_;
  const auto nextInSamePlace = [&] {
    render_bytes = std::max(render_bytes, arena.mark());
    arena.rewind(0);
  };
  to.coarse_render[0] = createRender(levels.coarse);
  if (comparesHypotheses(options)) to.coarse_render[1] = createRender(levels.coarse);
  to.fine_render = to.coarse_render[0];
  nextInSamePlace();
  if (levels.fine != levels.coarse) to.fine_render = createRender(levels.fine);
  nextInSamePlace();
  if (!options.search.enabled) return;
  (void)to.search.create(channelsOf(options), arena);
  nextInSamePlace();
  (void)to.competing.create(channelsOf(options), arena);
  nextInSamePlace();
}

/// One after the other in the same memory, behind the renders; the edges of the image last and in
/// the place of the renders, too, as that stage is the first to run.
Status PassMemory::Layout::layOutStages() {
  Arena& kept = to.kept_;
  Arena& scratch = to.scratch_;
  layOutRenders();
  std::size_t of_renders = 0;
  shareBehindRenders(of_renders);
  const int width = ((problem.image.width - 1) >> levels.fine) + 1;
  const int height = ((problem.image.height - 1) >> levels.fine) + 1;
  const int least = options.search.enabled ? PoseSearch::kLongestView_px : 1;
  const int widest = std::max(width, least);
  Status status =
      to.renderer.create(problem.mesh, to.adjacency_, widest, std::max(height, least),
                         options.render, kept, scratch, EdgeRenderer::bandRowsOf(widest), workers);
  shareBehindRenders(bytesOf(Stage::kRender));
  if (options.search.enabled) bytesOf(Stage::kSearch) = bytesOf(Stage::kRender);
  if (status == Status::kOk) status = to.selector.create(width, height, options.templates, scratch);
  shareBehindRenders(bytesOf(Stage::kTemplates));
  if (status == Status::kOk) status = layOutSearches(std::max(width, height));
  shareBehindRenders(bytesOf(Stage::kMatch));
  if (status == Status::kOk) status = to.ransac.create(options.templates.count, scratch);
  shareBehindRenders(bytesOf(Stage::kPose));
  if (status == Status::kOk) status = layOutAfterMatches();
  if (status == Status::kOk) {
    status = to.detector.begin(problem.image, problem.ignore, options.edges, kept, scratch,
                               {levels.fine, levels.coarse}, edges);
  }
  if (scratch.countsOnly()) shareScratch(bytesOf(Stage::kEdges), 0);
  return status;
}

/// The samples of a refinement remain valid until the next render. Behind them first the
/// refinement works, then the evidence is measured, then the focal length.
Status PassMemory::Layout::layOutAfterMatches() {
  Arena& scratch = to.scratch_;
  if (options.refinement.enabled) {
    to.records[0].refinement.samples = scratch.allocate<EdgeSample>(options.refinement.max_samples);
  }
  const std::size_t samples_end = scratch.mark();
  Status status = to.refinement.create(options.refinement, scratch);
  shareScratch(bytesOf(Stage::kRefine), samples_end);
  if (options.search.enabled) {
    if (status == Status::kOk) status = to.evidence.create(channelsOf(options), scratch);
    scratch.rewind(samples_end);
    if (status == Status::kOk) status = to.region.create(scratch);
    scratch.rewind(samples_end);
    if (status == Status::kOk) status = to.focal.create(options.refinement.max_samples, scratch);
  }
  shareScratch(bytesOf(Stage::kSupport), 0);
  // The test of competing poses renders, when the samples are no longer needed.
  if (options.search.enabled && scratch.countsOnly())
    bytesOf(Stage::kSupport) = std::max(bytesOf(Stage::kSupport), bytesOf(Stage::kRender));
  return status;
}

Status PassMemory::Layout::layOutSearches(int longest_px) {
  const int side_px = TemplateSelector::kMaxSide_px;
  WhsSearch counted;
  Status status = Status::kOk;
  for (int worker = 0; worker < workers && status == Status::kOk; ++worker) {
    WhsSearch& of_worker = to.searches.empty() ? counted : nth(to.searches, worker);
    status = of_worker.create(side_px, longest_px, kernels, to.scratch_);
  }
  return status;
}

/// The next stage takes the same memory from byte `first` on.
void PassMemory::Layout::shareScratch(std::size_t& bytes, std::size_t first) {
  if (!to.scratch_.countsOnly()) return to.scratch_.rewind(first);
  bytes = to.scratch_.highWater();
  to.scratch_ = Arena();
  (void)to.scratch_.allocate<std::byte>(first);
}

}  // namespace boresight
