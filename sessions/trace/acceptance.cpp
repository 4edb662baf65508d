// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/acceptance.h"

#include <algorithm>
#include <cmath>

#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

std::string supportText(const LocalizationTrace& trace) {
  return "Edge support is " + percentText(trace.support.share(), 1) + ", needed " +
         percentText(trace.lastOptions().support.min_support, 1) + ".";
}

/// "The pose has the most evidence of 3 compared poses; it comes from candidate 1 of the search."
std::string comparisonText(const LocalizationTrace& trace) {
  if (trace.best_hypothesis < 0) return "";
  const std::size_t count = trace.hypotheses.size();
  const PoseHypothesis& best = trace.hypotheses[static_cast<std::size_t>(trace.best_hypothesis)];
  return (count == 1
              ? std::string(" It is the only pose found")
              : " It has the most evidence of " + std::to_string(count) + " compared poses") +
         " and comes from " + originText(best) + "." +
         (trace.competitor < 0
              ? ""
              : " The next best pose is lower by a score of " + fixedText(trace.gap, 2) + ".");
}

std::string competingText(const LocalizationTrace& trace) {
  const CompetingPose* closest = closestCompetingPose(trace);
  if (closest == nullptr) return "";
  const std::size_t count = trace.competing_poses.size();
  return (count == 1
              ? std::string(" One competing pose is similar; it is ")
              : " " + std::to_string(count) + " competing poses are similar; the closest is ") +
         timesText(std::abs(closest->margin_nats)) +
         (closest->margin_nats < 0.0 ? " more likely" : " less likely") +
         (closest->mirrored ? " and shows the mesh mirrored." : ".");
}

}  // namespace

bool hasProbability(const LocalizationTrace& trace) {
  if (trace.evidence.finest().places == 0) return false;
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

std::string timesText(double nats) {
  constexpr double kMostTimes = 1000.0;
  const double times = std::exp(nats);
  if (times > kMostTimes) return "more than 1000 times";
  return fixedText(times, times < 10.0 ? 1 : 0) + " times";
}

std::string originText(const PoseHypothesis& hypothesis) {
  switch (hypothesis.origin) {
    case HypothesisOrigin::kCandidate:
      return "candidate " + std::to_string(hypothesis.number + 1) + " of the search";
    case HypothesisOrigin::kTemplates:
      return "templates around the first candidate";
    case HypothesisOrigin::kSeed:
      return "templates around the seed";
    case HypothesisOrigin::kRestart:
      break;
  }
  return "restart " + std::to_string(hypothesis.number + 1) + " of the best pose";
}

std::string probabilityText(const LocalizationTrace& trace) {
  const PoseEvidence& evidence = trace.evidence;
  return "the probability that the pose is right is " + probabilityPercent(trace.probability) +
         ", needed " + percentText(trace.lastOptions().support.min_probability, 1) +
         ": edges show " +
         fixedText(100.0 * std::clamp(evidence.finest().shareOfExpected(), 0.0, 1.0), 0) +
         " % of the evidence that a right pose would have, inside and outside differ along " +
         fixedText(100.0 * evidence.region.separatedShare(), 0) +
         " % of the outline, edge support is " + percentText(trace.support.share(), 1);
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
  return text + comparisonText(trace) + competingText(trace);
}

}  // namespace boresight::sessions
