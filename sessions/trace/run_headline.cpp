// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_headline.h"

#include <algorithm>
#include <cctype>

#include "core/base/math.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/acceptance.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

std::string countText(std::size_t count, const char* item) {
  return std::to_string(count) + " " + item + (count == 1 ? "" : "s");
}

std::string acceptedText(const LocalizationTrace& trace) {
  const auto& limits = trace.lastOptions().support;
  if (hasProbability(trace))
    return " Probability of the pose " + probabilityPercent(trace.probability) + " (" +
           percentText(limits.min_probability, 1) + " needed).";
  if (!limits.gate) return "";
  return " " + percentText(trace.support.share(), 1) + " of the edges agree (" +
         percentText(limits.min_support, 1) + " needed).";
}

std::string convergedSentence(const LocalizationTrace& trace) {
  std::string text = "in " + countText(trace.iterations.size(), "iteration");
  if (trace.attempts > 1)
    text += " and " + countText(static_cast<std::size_t>(trace.attempts), "attempt");
  if (!trace.replayed) text += ", " + fixedText(trace.seconds.total(), 2) + " s";
  return text + "." + acceptedText(trace);
}

/// What the operator may doubt of the seed: not a turn that was searched.
std::string seedDoubt(const LocalizationTrace& trace) {
  return searchedEveryTurn(trace)
             ? "Every turn about the view axis was searched: the seed may be tilted or far off."
             : "The seed may be turned or far off.";
}

std::string notSupportedSentence(const LocalizationTrace& trace) {
  const auto& limits = trace.lastOptions().support;
  if (hasProbability(trace))
    return "Probability of the pose " + probabilityPercent(trace.probability) + ", " +
           percentText(limits.min_probability, 1) + " needed. " + seedDoubt(trace);
  const EdgeSupport& support = trace.support;
  const bool chance = support.coverage() <= 1.5 * support.chanceCoverage();
  return std::string(chance ? "The edges fit no better than chance: " : "Too few edges fit: ") +
         percentText(support.share(), 1) + " agree, " + percentText(limits.min_support, 1) +
         " needed. " + seedDoubt(trace);
}

std::string noPoseSentence(const LocalizationTrace& trace) {
  if (trace.status == LocalizationStatus::kPnpFailed && !trace.iterations.empty()) {
    const IterationTrace& last = *trace.iterations.back();
    if (last.kind == IterationKind::kMatch)
      return "Only " + std::to_string(last.pnp.inlier_count) + " of " +
             std::to_string(last.correspondence_count) + " matches agree, " +
             std::to_string(trace.lastOptions().pnp.min_inliers) + " needed.";
  }
  std::string text = explanation(trace);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

/// Whether a pose was found but rejected, in contrast to a run without a pose.
bool wasRefused(const LocalizationTrace& trace) {
  switch (trace.status) {
    case LocalizationStatus::kNotSupported:
    case LocalizationStatus::kAmbiguous:
    case LocalizationStatus::kBlurred:
    case LocalizationStatus::kCameraMismatch:
      return true;
    default:
      return false;
  }
}

}  // namespace

RunHeadline runHeadline(const LocalizationTrace& trace) {
  if (trace.converged()) return {"Converged", convergedSentence(trace)};
  if (trace.status == LocalizationStatus::kNotSupported)
    return {"Rejected", notSupportedSentence(trace)};
  return {wasRefused(trace) ? "Rejected" : "No pose found", noPoseSentence(trace)};
}

bool searchedEveryTurn(const LocalizationTrace& trace) {
  constexpr double kNearlyHalfTurn_rad = 179.0 * kDegree_rad;
  return trace.uncertainty.rotation_rad.z() >= kNearlyHalfTurn_rad;
}

std::string iterationName(const LocalizationTrace& trace, int iteration) {
  const auto& all = trace.iterations;
  if (iteration < 0 || iteration >= static_cast<int>(all.size())) return "seed";
  const auto end = all.begin() + iteration + 1;
  const int attempt = (*(end - 1))->attempt;
  const auto number = std::count_if(
      all.begin(), end, [attempt](const auto& each) { return each->attempt == attempt; });
  return std::to_string(attempt + 1) + "." + std::to_string(number);
}

}  // namespace boresight::sessions
