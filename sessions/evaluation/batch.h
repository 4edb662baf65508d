// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/baselines/methods.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/run/runner.h"

namespace boresight::sessions {

/// Normal of the plane in which a mesh is mirrored, through the middle of its matched parts.
enum class MirrorAxis { kX = 0, kY = 1, kZ = 2 };

struct BatchOptions {
  /// Filters: a case is run if it matches every filter that is not empty, by any of its values.
  std::vector<std::string> cases;
  std::vector<std::string> tags;
  std::vector<std::string> stations;
  /// Of these, every `shards`-th case from the `shard`-th on (1 ... shards): each case, with all
  /// its seeds, is in exactly one shard.
  int shard = 1;
  int shards = 1;

  LocalizerOptions localizer;  ///< a feature size of 0 is replaced by the station's, if it has one
  std::string method = "whs";
  MethodSetup method_setup;  ///< of methods other than WHS
  Kernels kernels = bestKernels();
  int jobs = 1;
  int threads = 0;               ///< of each run; 0: its share of the cores
  std::size_t memory_limit = 0;  ///< of each run, see RunSettings
  int reseeds = 0;               ///< further seeds per case; needs truth
  double reseed_scale = 1.0;     ///< factor on the drawn offsets; the declared uncertainty is
                                 ///< unchanged
  bool keep_matches = false;     ///< steps of a result hold the match details of every template
  /// Deliberately wrong meshes: another station's, or mirrored.
  std::string mesh_of;
  std::optional<MirrorAxis> mirror;

  bool wrongMesh() const { return !mesh_of.empty() || mirror.has_value(); }
};

/// A run to be done.
struct PlannedRun {
  const Case* input = nullptr;     ///< of the dataset
  std::int64_t dataset_index = 0;  ///< of the case in the dataset
  int reseed = 0;
};

/// The runs of the options, in the order of the dataset, then of seeds. InputError when a filter or
/// `mesh_of` is not in the dataset, or no case meets all filters. A shard may be empty.
std::vector<PlannedRun> planBatch(const Dataset& dataset, const BatchOptions& options);

/// Called for each finished run, by one thread at a time, in the order of finishing.
using BatchProgress = std::function<void(std::size_t done, std::size_t total, const RunResult&)>;

/// Runs a plan on `jobs` threads and keeps no results; an exception of `progress` ends it. An image
/// is read when the first run of its case begins, and dropped after the last: at most `jobs` images
/// are held. A case with invalid files gives a result with status "input_error", and the others
/// continue. After a stop, unfinished runs are not reported.
void runPlanned(const Dataset& dataset, const BatchOptions& options,
                const std::vector<PlannedRun>& plan, const BatchProgress& progress,
                const std::stop_token& stop = {});

/// "12 s", "4 min", "2 h 05 min", "3 days 4 h"; "?" when unknown.
std::string durationText(double seconds);

/// Progress of a batch: "12 of 40 runs, 11 completed, 720 an hour, 2 min left". Rate and time left
/// are left out before the first run.
std::string batchProgressText(std::size_t done, std::size_t total, std::size_t completed,
                              double seconds_since_began);

/// The scene mirrored about the middle of its matched parts, faces turned so that they still look
/// outwards.
SceneMesh mirrored(SceneMesh scene, MirrorAxis axis);

}  // namespace boresight::sessions
