// SPDX-License-Identifier: Apache-2.0
// Text and tables of a run, and all sentences about how it ended.
#pragma once

#include <string>
#include <vector>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// One line per iteration: kind, level, templates, matches, inliers, threshold, correction, rms.
std::string iterationTable(const LocalizationTrace& trace);

/// Name of an iteration: its attempt and its number in it, "2.3"; "seed" below 0 and beyond the
/// end.
std::string iterationName(const LocalizationTrace& trace, int iteration);

/// The pose as rotation vector (deg), quaternion (wxyz, w >= 0) and matrix, with its centre in m. A
/// covariance that is not zero adds one sigma per axis, at the camera, the rig's origin (a `name`
/// that begins with "rig"), or `place`. `name` heads it.
std::string poseText(const Pose& pose, const Matrix6d& covariance,
                     const std::string& name = "camera_from_station",
                     const std::string& place = "");

/// High-water mark of memory by stage, compared with the limit if there is one.
std::string memoryTable(const LocalizationTrace& trace);

/// Whether the run searched, and ended with or because of the evidence of a pose.
bool hasProbability(const LocalizationTrace& trace);

/// The competing pose whose margin is smallest compared with what is required of it, or nullptr.
const CompetingPose* closestCompetingPose(const LocalizationTrace& trace);

/// Whether the seed's uncertainty covers a turn by any angle about the view axis.
bool searchedEveryTurn(const LocalizationTrace& trace);

/// Origin of a hypothesis, for the middle of a sentence: "candidate 2 of the search".
std::string originText(const PoseHypothesis& hypothesis);

/// A difference of evidence as a likelihood ratio: "12 times", "more than 1000 times".
std::string timesText(double nats);

/// Sentences: the probability with its parts (without a search the edge support), the width of the
/// image's edges, the origin of the pose, and the competing poses. Empty for a run without a pose.
std::string acceptanceText(const LocalizationTrace& trace);

/// One sentence on the doubtfulPose() of a run: its probability, and what to do. Empty without one.
std::string doubtfulPoseText(const LocalizationTrace& trace);

/// Why a run failed: the values measured and needed, and what to try. One sentence or two; empty
/// for a run that converged.
std::string explanation(const LocalizationTrace& trace);

/// How a run ended, for one line: a word or two, and a sentence with the values measured and
/// needed.
struct RunHeadline {
  std::string head;
  std::string sentence;
};
RunHeadline runHeadline(const LocalizationTrace& trace);

/// Status of a run for a line that is always in view: how it ended with the evidence for the pose,
/// why it failed (explanation()), or its current stage. Whole sentences; the first one states that
/// a run is replayed.
std::string runStatusText(const LocalizationTrace& trace);

/// "together with bc-2 and bc-3 (left out: ...)": the views of a run but this one. Statuses are
/// omitted when the run did not converge, or has not ended.
std::string togetherText(const std::vector<ViewOutcome>& views, const std::string& own_case);

}  // namespace boresight::sessions
