// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sessions/run/trace.h"
#include "sessions/run/view_outcome.h"

namespace boresight::sessions {

/// A run as far as it has come, cheap to copy: what is whole is shared and never changes.
/// LocalizationTrace is the same as one value, for files and for runs that nobody watches.
struct RunSnapshot {
  std::string version;
  LocalizerOptions options;  ///< that it started with
  std::vector<OptionChange> changes;
  Camera camera;
  Pose camera_from_station_seed;
  SeedUncertainty uncertainty;

  std::shared_ptr<const EdgeMapTrace> edges;  ///< nullptr until the test edges are there
  /// In order; the last one may be under way (`IterationTrace::reached` tells how far it is).
  std::vector<std::shared_ptr<const IterationTrace>> iterations;
  bool last_under_way = false;
  bool finished = false;
  Stage stage = Stage::kEdges;  ///< the last one that was worked on
  std::int32_t attempts = 1;
  std::vector<Rival> rivals;
  EdgeSupport support;
  PartialSupport partial;  ///< of the same pose; zero in old traces and replayed runs
  LocalizationStatus status = LocalizationStatus::kRunning;
  Status fault = Status::kOk;
  Pose camera_from_station;
  Matrix6d covariance = Matrix6d::Zero();
  std::string digest;  ///< empty until the run has finished
  StageSeconds seconds;
  std::uint64_t arena_bytes = 0;
  MemoryTrace memory;
  /// Shown from an onboard record (sessions/record/replay_record.h): a run that was not made here.
  bool replayed = false;
  /// Of a replayed run, sentences: what is not known, and what on the ground is not as on board.
  std::vector<std::string> remarks;
  /// Of one of several views that were solved as one: all of them, the first one led. Not in files
  /// of traces: the session's record of the run names them.
  std::vector<ViewOutcome> views;
  std::size_t own_view = 0;  ///< which of them this is

  bool converged() const { return status == LocalizationStatus::kConverged; }
  RunPlan plan() const { return {options, changes}; }
  const LocalizerOptions& lastOptions() const {
    return changes.empty() ? options : changes.back().options;
  }
};

/// Of a run that was read from a file.
RunSnapshot snapshotOf(LocalizationTrace&& trace);
/// For files; copies every iteration.
LocalizationTrace traceOf(const RunSnapshot& snapshot);

}  // namespace boresight::sessions
