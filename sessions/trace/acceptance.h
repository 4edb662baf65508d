// SPDX-License-Identifier: Apache-2.0
// Texts on the acceptance of a run's pose.
#pragma once

#include <string>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Whether the run searched, and ended with or because of the evidence of a pose.
bool hasProbability(const LocalizationTrace& trace);

/// The competing pose with the smallest margin, or nullptr.
const CompetingPose* closestCompetingPose(const LocalizationTrace& trace);

/// Origin of a hypothesis, for the middle of a sentence: "candidate 2 of the search".
std::string originText(const PoseHypothesis& hypothesis);

/// A difference of evidence as a likelihood ratio: "12 times", "more than 1000 times".
std::string timesText(double nats);

/// Of a run that hasProbability(), for the middle of a sentence: "the probability that the pose is
/// right is 99.1 %, needed 50.0 %: edges show 91 % of the evidence ...".
std::string probabilityText(const LocalizationTrace& trace);

/// Sentences: the probability with its parts (without a search the edge support), the width of the
/// image's edges, the origin of the pose, and the competing poses. Empty for a run without a pose.
std::string acceptanceText(const LocalizationTrace& trace);

}  // namespace boresight::sessions
