// SPDX-License-Identifier: Apache-2.0
// The run that Runner steps: one localizer, or several views. For runner.cpp only.
#pragma once

#include <cstddef>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/run/runner.h"

namespace boresight::sessions {

class SteppedRun {
 public:
  virtual ~SteppedRun() = default;

  /// See Runner::restart. std::logic_error for several views.
  virtual void restart(const LocalizationProblem& problem);
  /// One slice of the localizer, and the work around it.
  virtual StepReport step(const std::stop_token& stop) = 0;
  virtual int tasks() const = 0;
  virtual void runTask(int task, int worker) = 0;
  virtual int workers() const = 0;
  /// A view's test edges are complete.
  virtual void noteEdges() = 0;
  /// The search before the first iteration is complete.
  virtual void noteSearch() {}
  /// A stage or an iteration is complete: copies it with its `seconds` so far.
  virtual void noteIteration(const StepReport& report, const StageSeconds& seconds) = 0;
  /// How the last iteration ended for a view.
  virtual LocalizationStatus statusOf(std::size_t view) const = 0;
  /// Edge support was measured after the last iteration, and may have changed its status.
  void noteSupport(const StageSeconds& seconds);
  /// The run has ended.
  virtual void finish() = 0;

  std::vector<LocalizationTrace> traces;  ///< one per view
  JointResult joint;                      ///< of several views, at the end
};

std::unique_ptr<SteppedRun> stepOneView(const LocalizationProblem& problem, const RunPlan& plan,
                                        const RunSettings& settings);
std::unique_ptr<SteppedRun> stepSeveralViews(const ViewsProblem& problem,
                                             const LocalizerOptions& options,
                                             const std::vector<std::string>& case_ids,
                                             const RunSettings& settings);

/// Ends a run that cannot begin.
void refuse(LocalizationTrace& trace, Status fault);

}  // namespace boresight::sessions
