// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/accept/region_evidence.h"
#include "core/base/arena.h"
#include "core/base/kernels.h"
#include "core/base/nth.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/problem.h"
#include "core/localizer/stage.h"
#include "core/localizer/task_list.h"
#include "core/localizer/workspace.h"
#include "core/match/whs.h"
#include "core/pnp/pnp_ransac.h"
#include "core/refine/edge_refinement.h"
#include "core/refine/focal_fit.h"
#include "core/render/edge_render.h"
#include "core/search/competing_poses.h"
#include "core/search/pose_evidence_meter.h"
#include "core/search/pose_search.h"
#include "core/templates/template_selection.h"

namespace boresight {

/// Bytes of a localizer's block: memory that lives throughout, additional memory of construction
/// (returned before the first step), and additional memory of each stage, renders included; the
/// stages share one place.
struct MemoryUse {
  std::size_t kept = 0;          ///< bytes that live throughout
  std::size_t construction = 0;  ///< additional bytes during construction
  /// Additional bytes of each stage.
  std::array<std::size_t, static_cast<std::size_t>(Stage::kFinished)> stage{};

  /// High-water mark of a stage.
  std::size_t of(Stage at) const { return at < Stage::kFinished ? kept + nth(stage, at) : kept; }
  /// High-water mark of the whole run: the size of the block.
  std::size_t total() const;
};

/// The memory of a localization, laid out once in one block: first the memory kept for the whole
/// run (mesh adjacency, ray grids, edge maps of the matched levels, records), then the
/// renders, then scratch that the stages use in turn. Construction and the detection of the image's
/// edges come before the first render and also use the memory of the renders. The search before the
/// first iteration and that of competing poses after the last one work in the memory of the
/// renders. Edge maps of other levels last until the first render; the samples of a refinement last
/// until the next render.
///
/// The stages keep pointers into this object: it must not move.
class PassMemory {
 public:
  /// Largest number of workers.
  static constexpr int kMaxWorkers = 256;

  PassMemory() = default;
  PassMemory(const PassMemory&) = delete;
  PassMemory& operator=(const PassMemory&) = delete;

  /// Counts the bytes that create() needs. kInvalidOption for options out of range and for kernels
  /// that are not available.
  static Status measure(const ProblemSize& size, const LocalizerOptions& options, int workers,
                        Kernels kernels, MemoryUse& use);
  /// Lays everything out in `block` (aligned to Arena::kAlignment); `edges` is filled by the
  /// detector. Data of the problem must outlive this. kArenaTooSmall, and errors of measure().
  Status create(const LocalizationProblem& problem, const LocalizerOptions& options, int workers,
                Kernels kernels, std::span<std::byte> block, EdgeMap& edges);

  /// Bytes by purpose.
  const MemoryUse& use() const { return use_; }
  /// The front of the block: adjacency and ray grids, which do not change after construction.
  std::span<const std::byte> tables() const { return tables_; }
  /// Largest number of bytes in use at a time.
  std::size_t highWaterBytes() const { return kept_.highWater() + scratch_.highWater(); }

  EdgeDetector detector;                     ///< of the image
  PoseSearch search;                         ///< with search.enabled
  EdgeRenderer renderer;                     ///< of the mesh
  TemplateSelector selector;                 ///< of templates
  std::span<WhsSearch> searches;             ///< one per worker
  PnpRansac ransac;                          ///< of poses from matches
  EdgeRefinement refinement;                 ///< of poses on edges
  PoseEvidenceMeter evidence;                ///< of a refined pose, with search.enabled
  RegionEvidenceMeter region;                ///< of a refined pose, with search.enabled
  FocalFitter focal;                         ///< of the final pose, with search.enabled
  CompetingPoseTest competing;               ///< of the final pose, with search.enabled
  TaskList tasks;                            ///< of the stage under way
  std::array<RayGrid, kPyramidLevels> rays;  ///< of the levels that are rendered
  std::array<Iteration, 2> records;          ///< the current hypothesis and the best one so far
  std::array<EdgeRender, 2> coarse_render;   ///< of the first iteration, one per record
  EdgeRender fine_render;  ///< of later iterations; shares the memory of coarse_render

 private:
  struct Layout;

  MeshAdjacency adjacency_;
  std::size_t table_bytes_ = 0;  ///< of the front of the block
  std::span<const std::byte> tables_;
  Arena kept_;
  Arena scratch_;  ///< of construction and of the stages, one after the other
  MemoryUse use_;
};

/// Memory of a localizer for a problem of this size; see PassMemory::measure.
inline Status requiredMemory(const ProblemSize& size, const LocalizerOptions& options, int workers,
                             MemoryUse& use, Kernels kernels = Kernels::kPortable) {
  return PassMemory::measure(size, options, workers, kernels, use);
}
/// MemoryUse::total(): bytes of a block aligned to Arena::kAlignment (a block aligned to less loses
/// its first bytes).
inline Status requiredBytes(const ProblemSize& size, const LocalizerOptions& options, int workers,
                            std::size_t& bytes, Kernels kernels = Kernels::kPortable) {
  MemoryUse use;
  const Status status = requiredMemory(size, options, workers, use, kernels);
  bytes = use.total();
  return status;
}
/// The same for one worker.
inline Status requiredBytes(const ProblemSize& size, const LocalizerOptions& options,
                            std::size_t& bytes) {
  return requiredBytes(size, options, 1, bytes);
}

}  // namespace boresight
