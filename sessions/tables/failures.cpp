// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/failures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "sessions/evaluation/requirement_share.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr double kMradPerDegree = 1e3 * std::numbers::pi / 180.0;
/// A part of the seed's error below which a pose counts as near.
constexpr double kNear = 0.1;

double distanceMm(const PoseError& error) { return std::hypot(error.normal_mm, error.lateral_mm); }
double angleDeg(const PoseError& error) { return error.geodesic_mrad / kMradPerDegree; }

std::string text(const PoseError& error) {
  return fixedText(distanceMm(error), 2) + " mm, " + fixedText(angleDeg(error), 2) + " deg";
}

/// What is left of the seed's error, the larger of distance and angle.
double partLeft(const PoseError& error, const PoseError& seed) {
  const auto part = [](double now, double before) { return now / std::max(before, 1e-9); };
  return std::max(part(distanceMm(error), distanceMm(seed)), part(angleDeg(error), angleDeg(seed)));
}

std::string agreement(const RunStep& step) {
  if (step.kind != "match") return "";
  return " (" + std::to_string(step.support) + " of " + std::to_string(step.matches) +
         " matches agree)";
}

/// "at the seed 31.20 mm, 4.12 deg; ..."
std::string wayText(const RunResult& run) {
  std::string way = "Off by " + text(*run.seed_error) + " at the seed";
  const RunStep* least = nearestStep(run);
  if (!run.steps.empty() && run.steps.front().error)
    way += "; " + text(*run.steps.front().error) + " after the first iteration" +
           agreement(run.steps.front());
  if (least != nullptr && least != &run.steps.front() &&
      partLeft(*least->error, *run.seed_error) < 1.0)
    way +=
        "; nearest " + text(*least->error) + " after iteration " + std::to_string(least->index + 1);
  if (run.completed && run.error) way += "; " + text(*run.error) + " at the end";
  return way + ".";
}

std::string endText(const RunResult& run) {
  if (!run.message.empty()) return run.status + ": " + run.message;
  if (run.completed && run.error && run.requirement)
    return run.status + ", " + fixedText(requirementShare(*run.error, *run.requirement), 1) +
           " times beyond what is required";
  return run.status;
}

std::string verdictText(Astray astray) {
  switch (astray) {
    case Astray::kLedAway:
      return "No iteration was nearer to the truth than the seed: its matches led away.";
    case Astray::kPartOfWay:
      return "It went a part of the way, and never came near.";
    case Astray::kCameNear:
      return "It was near the truth, and did not end there or was refused there.";
    case Astray::kNotBegun:
    case Astray::kUnknown:
    case Astray::kBeyondNeed:
      break;
  }
  return "";
}

std::string withFullStop(std::string sentence) {
  if (!sentence.empty() && sentence.back() != '.') sentence += '.';
  return sentence;
}

/// Of a method that was deliberately given another mesh.
std::string meshNote(const MethodFacts& method) {
  if (!method.mesh_of.empty()) return "WRONG mesh of " + method.mesh_of;
  return method.mirror.empty() ? "" : "WRONG mesh mirrored across " + method.mirror;
}

std::vector<Failure> failuresOfFile(const std::filesystem::path& file,
                                    const ResultsFilter& filter) {
  const ResultsFacts facts = readResultsFacts(file);
  std::map<std::string, std::string> notes;
  for (const MethodFacts& method : facts.methods) notes[method.method] = meshNote(method);
  std::vector<Failure> failures;
  forEachRun(file, [&](const RunResult& run) {
    const bool failed = !run.completed || run.success == false || run.false_positive;
    if (failed && filter.takes(run))
      failures.push_back({run, facts.dataset.dataset, notes[run.method]});
  });
  for (Failure& failure : failures) failure.run.steps = readSteps(file, failure.run);
  return failures;
}

}  // namespace

const RunStep* nearestStep(const RunResult& run) {
  const RunStep* best = nullptr;
  for (const RunStep& step : run.steps) {
    if (!step.error || !run.seed_error) continue;
    if (best == nullptr ||
        partLeft(*step.error, *run.seed_error) < partLeft(*best->error, *run.seed_error))
      best = &step;
  }
  return best;
}

Astray whereAstray(const RunResult& run) {
  if (run.inputFailed() || run.status == "bad_seed") return Astray::kNotBegun;
  if (run.completed) return run.success ? Astray::kBeyondNeed : Astray::kUnknown;
  const RunStep* least = nearestStep(run);
  if (least == nullptr) return Astray::kUnknown;
  const double left = partLeft(*least->error, *run.seed_error);
  if (left < kNear) return Astray::kCameNear;
  return left < 1.0 ? Astray::kPartOfWay : Astray::kLedAway;
}

std::string failureStory(const RunResult& run) {
  std::string story = withFullStop(endText(run));
  if (run.seed_error && !run.steps.empty()) story += " " + wayText(run);
  if (const std::string verdict = verdictText(whereAstray(run)); !verdict.empty())
    story += " " + verdict;
  return story;
}

std::vector<Failure> failuresOf(const std::vector<std::filesystem::path>& files,
                                const ResultsFilter& filter) {
  std::vector<Failure> failures;
  for (const std::filesystem::path& file : files) {
    std::vector<Failure> found = failuresOfFile(file, filter);
    std::move(found.begin(), found.end(), std::back_inserter(failures));
  }
  return failures;
}

}  // namespace boresight::sessions
