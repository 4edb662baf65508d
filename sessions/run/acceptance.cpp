// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/acceptance.h"

#include <algorithm>
#include <cmath>

#include "sessions/run/alternatives.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

std::string percent(double share) { return fixedText(100.0 * share, 1) + " %"; }
std::string nats(double value, int decimals = 2) { return fixedText(value, decimals) + " nats"; }

std::string supportText(const LocalizationTrace& trace) {
  return "Edge support is " + percent(trace.support.share()) + ", needed " +
         percent(trace.lastOptions().support.min_support) + ".";
}

/// "The pose comes from candidate 1 of 3 of the search."
std::string candidateText(const LocalizationTrace& trace) {
  if (!trace.converged() || trace.candidates.empty()) return "";
  const std::string all = std::to_string(trace.candidates.size());
  for (const Alternative& alternative : alternativesOf(trace))
    if (alternative.kind == AlternativeKind::kCandidate && alternative.chosen)
      return " The pose comes from candidate " + std::to_string(alternative.number) + " of " + all +
             " of the search.";
  return " The pose comes from the seed; the search has " + all + " candidates.";
}

std::string competingText(const LocalizationTrace& trace) {
  const CompetingPose* closest = closestCompetingPose(trace);
  if (closest == nullptr) return "";
  const std::size_t count = trace.competing_poses.size();
  return (count == 1
              ? std::string(" One competing pose is similar; it has ")
              : " " + std::to_string(count) + " competing poses are similar; the closest has ") +
         nats(std::abs(closest->margin_nats), 1) +
         (closest->margin_nats < 0.0 ? " more evidence." : " less evidence.");
}

}  // namespace

bool hasProbability(const LocalizationTrace& trace) {
  if (trace.evidence.places == 0) return false;
  switch (trace.status) {
    case LocalizationStatus::kConverged:
    case LocalizationStatus::kNotSupported:
    case LocalizationStatus::kAmbiguous:
    case LocalizationStatus::kBlurred:
    case LocalizationStatus::kCameraMismatch:
      return true;
    default:  // the evidence is that of an earlier attempt's pose
      return false;
  }
}

const CompetingPose* closestCompetingPose(const LocalizationTrace& trace) {
  const auto& poses = trace.competing_poses;
  const auto closest = std::min_element(
      poses.begin(), poses.end(),
      [](const auto& item, const auto& other) { return item.margin_nats < other.margin_nats; });
  return closest == poses.end() ? nullptr : &*closest;
}

std::string probabilityText(const LocalizationTrace& trace) {
  return "the probability that the pose is right is " + percent(trace.probability) + ", needed " +
         percent(trace.lastOptions().support.min_probability) + ": evidence of its edges " +
         nats(trace.evidence.strongest_nats()) + ", of the weakest quadrant " +
         nats(trace.evidence.weakest_nats()) + ", edge support " + percent(trace.support.share());
}

std::string acceptanceText(const LocalizationTrace& trace) {
  std::string text;
  if (hasProbability(trace)) {
    text = probabilityText(trace) + ".";
    text.front() = 'T';
  } else if (trace.converged()) {
    text = supportText(trace);
  } else {
    return "";
  }
  if (trace.edge_width.widestDirection() >= 0)
    text += " The image's edges are " + fixedText(trace.edge_width.widest_px(), 1) +
            " px wide, at most " + fixedText(EdgeWidth::kWidest_px, 0) + " px are accepted.";
  return text + candidateText(trace) + competingText(trace);
}

}  // namespace boresight::sessions
