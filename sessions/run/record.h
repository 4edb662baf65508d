// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include "core/base/kernels.h"
#include "core/record/record_writer.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

class MatchingMethod;  // sessions/run/matching_method.h

/// Copies what the core's record of an iteration holds, up to the stage that it reached: what lies
/// beyond still has the values of an earlier iteration and is left out.
IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level);

/// Whether a pose came out of an iteration that reached a stage.
bool hasPose(const Iteration& iteration, Stage reached);

RenderTrace recordRender(const EdgeRender& render);
EdgeMapTrace recordEdgeMap(const EdgeMap& edges);

/// All memory of the flight profile, in bytes: image, ignore mask, mesh and the localizer's block.
inline constexpr std::size_t kFlightMemoryBytes = 10'000'000;

/// Bytes of what a problem points to: image, ignore mask, mesh.
std::size_t inputBytes(const LocalizationProblem& problem);

/// How a run is carried out; what is computed does not depend on it.
struct RunSettings {
  RecordLevel level = RecordLevel::kFull;
  std::size_t memory_limit = 0;  ///< bytes, inputs and the localizer's block; 0: whatever it takes
  int threads = 1;               ///< 1 ... Localizer::kMaxWorkers
  /// What the inner loops use of the processor. Within a limit always the portable ones: wide
  /// registers need more memory, and the limit is that of a machine without them.
  Kernels kernels = bestKernels();
  /// Notes the run as the flight side would, if given: from its first block to its last.
  RecordWriter* onboard_record = nullptr;
  /// Matches in place of WHS, if given; then also what is computed is the method's.
  MatchingMethod* method = nullptr;
};

/// Runs a whole localization with memory of its own: a loop around Localizer::step(). What is
/// recorded does not change what is computed. A stop is noticed between two steps and leaves the
/// status at kRunning. A problem that cannot run at all, or not within the limit (kArenaTooSmall),
/// is a trace with kFault and without iterations. With a limit the localizer gets all that the
/// inputs leave of it. Throws std::bad_alloc when there is no memory for the arena,
/// and MethodError when the method, if any, cannot go on.
LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                           const RunSettings& settings, const std::stop_token& stop = {});
inline LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                                  RecordLevel level, const std::stop_token& stop = {}) {
  return localize(problem, plan, RunSettings{.level = level}, stop);
}

}  // namespace boresight::sessions
