// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "core/views/views_localizer.h"
#include "sessions/run/run_snapshot.h"
#include "sessions/run/stepped_run.h"

namespace boresight::sessions {

/// As SteppedRun, for several views that are solved as one (core/views): it halts where its caller
/// wants to look, and keeps a record of every view, as if each were a run of its own. Iterations
/// are those of the first view's loop; in one that a view had no part in, its record holds the pose
/// of the others in its camera and nothing else. Times are of all views together.
class SteppedViews {
 public:
  /// Takes memory for the whole run; what `problem` points to must outlive the object. `case_ids`
  /// name the views in their order. What cannot run is a set of snapshots with kFault that is
  /// finished. Throws std::bad_alloc.
  SteppedViews(const ViewsProblem& problem, const LocalizerOptions& options,
               const std::vector<std::string>& case_ids);

  SteppedViews(const SteppedViews&) = delete;
  SteppedViews& operator=(const SteppedViews&) = delete;

  /// Works on; nothing when it has finished. A stage is many of many views: to halt after one is to
  /// halt after an iteration.
  void advance(StepUntil until, const std::stop_token& stop = {});

  bool finished() const { return snapshots_.front().finished; }
  /// Iterations that are complete.
  std::size_t complete() const { return snapshots_.front().iterations.size(); }
  /// Everything up to now, one per view in their order. A digest is that of all views together and
  /// the view's number.
  const std::vector<RunSnapshot>& snapshots() const { return snapshots_; }

 private:
  using Clock = std::chrono::steady_clock;

  void begin(const LocalizerOptions& options, const std::vector<std::string>& case_ids);
  void refuse(Status status);
  void describeViews();
  void note(const StepReport& report, double seconds);
  void noteEdges();
  void noteIteration(Stage reached);
  IterationTrace traceOf(std::size_t view, Stage reached) const;
  IterationTrace leftOut(std::size_t view) const;
  LocalizationStatus statusOf(std::size_t view) const;
  void judgeIteration();
  void finish();
  void finish(std::size_t view);

  ViewsProblem problem_;
  std::vector<RunSnapshot> snapshots_;
  std::vector<Pose> camera_from_first_;
  std::unique_ptr<std::byte[]> memory_;
  std::unique_ptr<ViewsLocalizer> localizer_;
  std::size_t next_edges_ = 0;  ///< the view whose test edges come next
  StageSeconds iteration_seconds_;
};

}  // namespace boresight::sessions
