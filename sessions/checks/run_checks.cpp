// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/checks.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/checks/generalized_eigen.h"
#include "sessions/decision/check.h"
#include "sessions/text/plain_text.h"
#include "sessions/trace/decisive_iterations.h"
#include "sessions/trace/match_details.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kConverged{"converged", "Converged"};
constexpr CheckName kCorrections{"corrections_shrink", "Corrections shrink"};
constexpr CheckName kCount{"inlier_count", "Inliers"};
constexpr CheckName kRatio{"inlier_ratio", "Inlier ratio of the matches"};
constexpr CheckName kSpread{"inlier_spread", "Spread of the inliers over the station"};
constexpr CheckName kDepth{"inlier_depth", "Spread of the inliers in depth"};
constexpr CheckName kBorder{"matches_at_border", "Matches on window borders"};
constexpr CheckName kMargin{"peak_margin", "Best against second-best position"};

/// Half the width of a pixel distinguishes a line of edges from a plane of them.
constexpr double kSpreadFloor_px = 1.0;
/// A station whose edges spread by a smaller share of their distance counts as flat.
constexpr double kLeastDepthShare = 0.01;

std::string count(double value) { return std::to_string(static_cast<long>(std::lround(value))); }

Check convergedCheck(const LocalizationTrace& run) {
  const RunHeadline headline = runHeadline(run);
  std::string found = headline.head + ". " + headline.sentence;
  if (run.converged()) {
    found = "The run converged after " + std::to_string(run.iterations.size()) + " iterations.";
    if (hasProbability(run)) found += " " + acceptanceText(run);
  }
  return statedCheck(kConverged, run.converged(), found,
                     "Check the failed iteration; start nearer, or ignore unreliable pixels.");
}

Check correctionsCheck(const LocalizationTrace& run, const CheckLimits& limits) {
  std::vector<std::shared_ptr<const IterationTrace>> iterations = decisiveIterations(run);
  if (!iterations.empty() && !cameToPose(*iterations.back()))
    return notAskedCheck(kCorrections, "The last iteration has no pose.");
  std::erase_if(iterations, [](const auto& item) { return !cameToPose(*item); });
  if (iterations.size() < 2)
    return notAskedCheck(kCorrections, "Fewer than two iterations led to the pose.");
  const double first_px = iterations.front()->correction_image_px;
  const double last_px = iterations.back()->correction_image_px;
  const std::string found = "The first iteration moved the station by " + sentenceNumber(first_px) +
                            " px in the image, the last one by " + sentenceNumber(last_px) + " px.";
  return measuredCheck(kCorrections, "%", 100.0 * last_px / std::max(first_px, 1.0),
                       limits.last_correction_percent, LimitSide::kAtMost, found,
                       "The pose has not settled: run more iterations, or check the last matches.");
}

void addCounts(const IterationTrace& iteration, const CheckLimits& limits,
               std::vector<Check>& checks) {
  const double inliers = iteration.pnp.inlier_count;
  const double matches = iteration.correspondence_count;
  const std::string found = "In the last matching iteration that led to the pose, " +
                            count(inliers) + " of " + count(matches) + " matches agree.";
  checks.push_back(
      measuredCheck(kCount, "", inliers, limits.inlier_count, LimitSide::kAtLeast, found,
                    "Few inliers may agree by chance: check unmatched templates and the mesh."));
  checks.push_back(measuredCheck(kRatio, "%", matches > 0.0 ? 100.0 * inliers / matches : 0.0,
                                 limits.inlier_ratio_percent, LimitSide::kAtLeast, found,
                                 "Many matches contradict the pose: check their positions; ignore "
                                 "pixels that are not of the station."));
}

struct InlierPlaces {
  std::vector<Eigen::Vector2d> inliers_px;
  std::vector<double> inlier_depths_m;
  std::vector<Eigen::Vector2d> edges_px;
  std::vector<double> edge_depths_m;
};

InlierPlaces inlierPlaces(const IterationTrace& iteration) {
  InlierPlaces places;
  for (const MatchDetails& match : matchDetails(iteration)) {
    if (!match.inlier) continue;
    places.inliers_px.push_back(match.found_px);
    places.inlier_depths_m.push_back(match.depth_m);
  }
  for (const EdgePixel& pixel : iteration.render.pixels) {
    places.edges_px.push_back(atFullResolution({pixel.x, pixel.y}, iteration.level));
    places.edge_depths_m.push_back(static_cast<double>(pixel.depth_m));
  }
  return places;
}

Check spreadCheck(const InlierPlaces& places, const CheckLimits& limits) {
  const auto spread = leastSpread(places.inliers_px, places.edges_px, kSpreadFloor_px);
  if (!spread) return notAskedCheck(kSpread, "The run has no stored inlier positions.");
  const std::string percent = count(100.0 * *spread);
  return measuredCheck(
      kSpread, "%", 100.0 * *spread, limits.inlier_spread_percent, LimitSide::kAtLeast,
      "In their narrowest direction the inliers spread " + percent +
          " % as wide as the station's edges.",
      "One part of the station determines the pose: check for occlusion, or for another station.");
}

Check depthCheck(const InlierPlaces& places, const CheckLimits& limits) {
  const auto& depths = places.edge_depths_m;
  if (depths.size() < 2 || places.inliers_px.size() < 2)
    return notAskedCheck(kDepth, "The run has no stored inlier positions.");
  const double edges_m = deviationOf(depths);
  if (edges_m < kLeastDepthShare * medianOf(depths))
    return notAskedCheck(kDepth, "The station's edges lie at nearly the same distance.");
  const double inliers_m = deviationOf(places.inlier_depths_m);
  return measuredCheck(kDepth, "%", 100.0 * inliers_m / edges_m, limits.inlier_depth_percent,
                       LimitSide::kAtLeast,
                       "Along the view axis the inliers spread by " +
                           sentenceNumber(1e3 * inliers_m) + " mm, the station's edges by " +
                           sentenceNumber(1e3 * edges_m) + " mm (standard deviations).",
                       "Inliers at one depth constrain distance and tilt weakly: check nearer and "
                       "farther templates.");
}

Check borderCheck(const IterationTrace& iteration, const CheckLimits& limits) {
  double searched = 0.0;
  double at_border = 0.0;
  for (const Match& match : iteration.matches) {
    searched += match.searched ? 1.0 : 0.0;
    at_border += match.searched && match.at_border ? 1.0 : 0.0;
  }
  if (searched == 0.0) return notAskedCheck(kBorder, "The run has no stored template positions.");
  return measuredCheck(
      kBorder, "%", 100.0 * at_border / searched, limits.border_percent, LimitSide::kAtMost,
      count(at_border) + " of " + count(searched) +
          " templates were found on the border of their search window.",
      "The station may lie outside the windows: start nearer, or declare a larger uncertainty.");
}

Check marginCheck(const IterationTrace& iteration, const CheckLimits& limits) {
  std::vector<double> margins;
  for (const MatchDetails& match : matchDetails(iteration))
    if (match.inlier && std::isfinite(match.margin)) margins.push_back(100.0 * match.margin);
  if (margins.empty()) return notAskedCheck(kMargin, "No inlier has a second-best position.");
  const double median = medianOf(margins);
  return measuredCheck(
      kMargin, "%", median, limits.peak_margin_percent, LimitSide::kAtLeast,
      "Half of the inliers score at least " + sentenceNumber(median) +
          " % above their second-best position.",
      "Template positions are ambiguous: check the score maps for a repeating pattern.");
}

void addMatchingChecks(const LocalizationTrace& run, const CheckLimits& limits,
                       std::vector<Check>& checks) {
  const std::shared_ptr<const IterationTrace> iteration = lastMatching(run);
  if (iteration == nullptr)
    return addNotAsked({kCount, kRatio, kSpread, kDepth, kBorder, kMargin},
                       "No matching iteration led to the pose.", checks);
  addCounts(*iteration, limits, checks);
  const InlierPlaces places = inlierPlaces(*iteration);
  checks.push_back(spreadCheck(places, limits));
  checks.push_back(depthCheck(places, limits));
  checks.push_back(borderCheck(*iteration, limits));
  checks.push_back(marginCheck(*iteration, limits));
}

constexpr CheckName kOnboard{"agreement_onboard", "Agreement with the onboard record"};

/// The first difference and those beyond limits, a sentence each.
std::string differenceText(const RecordComparison& compared) {
  std::string text;
  if (compared.first) text += " " + asSentence(compared.first->text);
  for (const std::string& beyond : compared.beyond) text += " " + asSentence(beyond);
  return text;
}

Eigen::Matrix2d scatterOf(std::span<const Eigen::Vector2d> points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const Eigen::Map<const Eigen::Matrix2Xd> all(points.front().data(), 2, count);
  const Eigen::Matrix2Xd about_mean = all.colwise() - all.rowwise().mean();
  return about_mean * about_mean.transpose() / static_cast<double>(count);
}

}  // namespace

void addRunChecks(const ReviewSubject& subject, const CheckLimits& limits,
                  std::vector<Check>& checks) {
  if (!subject.run)
    return addNotAsked(
        {kConverged, kCorrections, kCount, kRatio, kSpread, kDepth, kBorder, kMargin},
        "The pose comes from annotations, not from a run.", checks);
  checks.push_back(convergedCheck(*subject.run));
  checks.push_back(correctionsCheck(*subject.run, limits));
  addMatchingChecks(*subject.run, limits, checks);
}

void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks) {
  if (!subject.onboard) {
    checks.push_back(notAskedCheck(kOnboard, "The case has no onboard record, or was not run."));
    return;
  }
  if (subject.onboard->verdict != RunVerdict::kDifferent && !subject.onboard->showsAgreement()) {
    std::string why = "The onboard record does not show whether the runs agree.";
    for (const std::string& missing : subject.onboard->missing) why += " " + asSentence(missing);
    checks.push_back(notAskedCheck(kOnboard, why));
    return;
  }
  const std::string difference = differenceText(*subject.onboard);
  const auto add = [&checks](bool passed, const std::string& found, const char* remedy) {
    checks.push_back(statedCheck(kOnboard, passed, found, remedy));
  };
  switch (subject.onboard->verdict) {
    case RunVerdict::kEqual:
      return add(true, "The run equals the onboard run to the bit.", "");
    case RunVerdict::kWithinLimits:
      return add(true, "The run agrees with the onboard run within limits." + difference, "");
    case RunVerdict::kUndecided:
    case RunVerdict::kDifferent:
      return add(false, "The run differs from the onboard run." + difference,
                 "Compare both runs: the checked run is not the onboard run.");
  }
}

std::optional<std::int32_t> lastInliers(const LocalizationTrace& run) {
  const std::shared_ptr<const IterationTrace> iteration = lastMatching(run);
  if (iteration == nullptr) return std::nullopt;
  return iteration->pnp.inlier_count;
}

int iterationToOpen(const LocalizationTrace& run) {
  const int last = static_cast<int>(run.iterations.size()) - 1;
  if (run.converged()) return last;
  for (int i = last; i >= 0; --i)
    if (!cameToPose(*run.iterations[static_cast<std::size_t>(i)])) return i;
  return last;
}

std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px) {
  if (points_px.size() < 2 || others_px.size() < 2) return {};
  const Eigen::Matrix2d floor = floor_px * floor_px * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d points = scatterOf(points_px) + floor;
  const Eigen::Matrix2d others = scatterOf(others_px) + floor;
  const auto eigen = generalizedEigen<2>(points, others);
  if (!eigen) return {};
  return std::sqrt(std::max(0.0, eigen->values[0]));
}

double deviationOf(std::span<const double> values) {
  if (values.size() < 2) return 0.0;
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  return std::sqrt((all - all.mean()).square().mean());
}

double medianOf(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace boresight::sessions
