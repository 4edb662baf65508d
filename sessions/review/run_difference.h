// SPDX-License-Identifier: Apache-2.0
// What changed between two runs of a case, and whether it is for the better.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/decision/check.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/record/compare_records.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// What there is to say of one of the two runs.
struct RunSide {
  std::string digest;
  std::string time;    ///< UTC, when it ended
  std::string status;  ///< as localizationStatusText says
  bool converged = false;
  int iterations = 0;
  std::int32_t inliers = 0;  ///< of the last matching iteration
  int checks_passed = 0;
  int checks_failed = 0;
  /// Against the truth; nothing where that is not known or the run did not converge.
  std::optional<PoseError> error;
  /// The largest part of the requirement that the error takes up; above 1: beyond it. Nothing, too,
  /// where the truth's own sigma exceeds the requirement: such a truth does not judge.
  std::optional<double> error_share;
};

/// A check of which both runs have another state; nothing where only one of them has it.
struct CheckChange {
  std::string title;
  CheckState before = CheckState::kNotApplicable;
  CheckState after = CheckState::kNotApplicable;
};

/// An option that both runs started with another value of.
struct OptionChangeText {
  std::string name;
  std::string before;  ///< with its unit
  std::string after;
};

enum class RunChange { kBetter, kWorse, kSame };
/// "better", "worse", "same".
const char* runChangeText(RunChange change);

struct RunDifference {
  std::string case_id;
  RunSide before;
  RunSide after;
  bool inputs_differ = false;  ///< the runs were given other inputs
  std::vector<OptionChangeText> options;
  std::vector<CheckChange> checks;
  RecordComparison comparison;  ///< where they differ first, and how far the final poses are apart
  RunChange change = RunChange::kSame;
  std::string why;  ///< a clause: by what it is better, worse or the same
};

/// The two last runs of a case, the earlier one first; nothing when there are fewer.
struct RunPair {
  const RunRecord* before = nullptr;  ///< both point into the session
  const RunRecord* after = nullptr;
};
std::optional<RunPair> lastTwoRuns(const Session& session, const std::string& case_id);

/// Compares two runs of one case. The checks of both are made with the inputs and limits as they
/// are now. Where the truth is known it judges: a right pose (within the requirement) is better
/// than a run that failed, and that is better than a wrong pose; of two wrong ones the nearer by a
/// tenth of the requirement. Else the checks judge: all passed, then fewer failed ones, then a run
/// that failed. InputError when a trace cannot be read; std::invalid_argument when the runs are not
/// of one case of the session.
RunDifference compareRuns(const Session& session, const std::string& before_digest,
                          const std::string& after_digest,
                          std::shared_ptr<const LoadedCase> loaded);

/// Better, worse or same, and why, by the rules above.
void judgeChange(RunDifference& difference);

/// One line of a table: what it is of, before, after.
struct DifferenceLine {
  std::string label;
  std::string before;
  std::string after;
};
/// How the runs ended, inliers, error, checks and options that changed: what is the same in both is
/// left out but for the first three.
std::vector<DifferenceLine> differenceLines(const RunDifference& difference);
/// "better: 2 checks failed before, none now", and the first difference: one or two sentences.
std::string changeText(const RunDifference& difference);
/// The whole report as text.
std::string differenceText(const RunDifference& difference);

}  // namespace boresight::sessions
