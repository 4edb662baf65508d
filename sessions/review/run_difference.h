// SPDX-License-Identifier: Apache-2.0
// Differences between two runs of a case, and whether the later one is better.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/decision/check.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/record/compare_records.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Figures of one of the two runs.
struct RunSide {
  std::string digest;
  std::string time;    ///< UTC, when it ended
  std::string status;  ///< localizationStatusText()
  bool converged = false;
  bool wrong_mesh = false;  ///< a negative test: a pose found with it is wrong
  int iterations = 0;
  std::optional<std::int32_t> inliers;  ///< lastInliers()
  int checks_passed = 0;
  int checks_failed = 0;
  /// Against the truth; empty when that is not known or the run did not converge.
  std::optional<PoseError> error;
  /// requirementShare() of the error. Also empty when the truth's own sigma exceeds the
  /// requirement: such a truth is not used.
  std::optional<double> error_share;
};

/// A check with different states in the runs; checks of only one run are not listed.
struct CheckChange {
  std::string title;
  CheckState before = CheckState::kNotApplicable;
  CheckState after = CheckState::kNotApplicable;
};

/// An option with which the runs started at different values.
struct OptionChangeText {
  std::string name;
  std::string before;  ///< with its unit
  std::string after;
};

/// Of the options in force at the end of two runs, in their order.
std::vector<OptionChangeText> optionChanges(const LocalizerOptions& before,
                                            const LocalizerOptions& after);

/// Distance between two poses of a case.
struct PoseDistance {
  double translation_mm = 0.0;          ///< at the end effector, else at the camera
  double rotation_deg = 0.0;            ///< whole angle
  std::optional<double> projection_px;  ///< as PoseError's, over the vertices that runs match
};
PoseDistance poseDistance(const LoadedCase& loaded, const Pose& camera_from_station,
                          const Pose& other_camera_from_station);
/// "0.12 mm, 0.034 deg, 0.8 px".
std::string poseDistanceText(const PoseDistance& distance);

/// A run of a list, next to the run before it.
struct RunListLine {
  std::string changed;  ///< "inputs, pnp.min_inliers 12 -> 100"; empty: no change, or the first run
  std::optional<PoseDistance> moved;  ///< empty unless both runs converged
};
/// In the order of the runs of one case. Lines of a trace that cannot be read are empty.
std::vector<RunListLine> runListLines(std::span<const RunRecord> runs, const LoadedCase& loaded,
                                      const std::stop_token& stop = {});

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
  RecordComparison comparison;  ///< first difference, and distance of the final poses
  RunChange change = RunChange::kSame;
  std::string why;  ///< a clause: the reason for `change`
};

/// The two last runs of a case, the earlier one first; empty when there are fewer.
struct RunPair {
  const RunRecord* before = nullptr;  ///< both point into the session
  const RunRecord* after = nullptr;
};
std::optional<RunPair> lastTwoRuns(const Session& session, const std::string& case_id);

/// Compares two runs of one case. Both are checked with the current inputs and limits. With a known
/// truth, a correct pose (within the requirement) is better than a failed run, which is better than
/// a wrong pose; of two wrong poses the nearer one is better, if nearer by a tenth of the
/// requirement. Otherwise the checks decide, from best to worst: all passed, fewer failed, a failed
/// run. InputError when a trace cannot be read; std::invalid_argument when the runs are not of one
/// case of the session.
RunDifference compareRuns(const Session& session, const std::string& before_digest,
                          const std::string& after_digest,
                          std::shared_ptr<const LoadedCase> loaded);

/// Sets `change` and `why` by the rules above.
void judgeChange(RunDifference& difference);

/// One line of a table: label and both values.
struct DifferenceLine {
  std::string label;
  std::string before;
  std::string after;
};
/// How the runs ended, inliers, error, checks and options that changed: equal values are left out
/// except for the first three.
std::vector<DifferenceLine> differenceLines(const RunDifference& difference);
/// "better: 2 checks failed before, none now", and the first difference: one or two sentences.
std::string changeText(const RunDifference& difference);
/// The whole report as text.
std::string differenceText(const RunDifference& difference);

}  // namespace boresight::sessions
