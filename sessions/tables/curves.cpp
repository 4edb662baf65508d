// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace boresight::sessions {

CurvePoints shareBelow(std::vector<double> values, std::size_t of) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  std::sort(values.begin(), values.end());
  CurvePoints points;
  const auto percent = [of](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(of, 1));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!points.empty()) points.push_back({values[i], percent(i)});
    points.push_back({values[i], percent(i + 1)});
  }
  return points;
}

CurvePoints successAgainstTolerance(std::span<const RunResult* const> runs,
                                    std::span<const double> factors) {
  CurvePoints points;
  for (const double factor : factors) {
    int judged = 0;
    int within = 0;
    for (const RunResult* run : runs) {
      if (!run->success || !run->error || !run->requirement) continue;
      ++judged;
      within += run->completed && meetsRequirement(*run->error, *run->requirement, factor) ? 1 : 0;
    }
    if (judged > 0) points.push_back({factor, 100.0 * within / judged});
  }
  return points;
}

std::optional<double> seedMeasure(const RunResult& run, SeedMeasure measure) {
  if (!run.seed_error) return std::nullopt;
  if (measure == SeedMeasure::kAngle_mrad) return run.seed_error->geodesic_mrad;
  return std::hypot(run.seed_error->normal_mm, run.seed_error->lateral_mm);
}

CurvePoints successAgainstSeed(std::span<const RunResult* const> runs, SeedMeasure measure,
                               int bins) {
  std::vector<std::pair<double, bool>> seeds;
  for (const RunResult* run : runs)
    if (const auto far = seedMeasure(*run, measure); far && run->success)
      seeds.emplace_back(*far, *run->success);
  std::sort(seeds.begin(), seeds.end());
  CurvePoints points;
  const std::size_t groups = std::min(static_cast<std::size_t>(std::max(bins, 1)), seeds.size());
  for (std::size_t group = 0; group < groups; ++group) {
    const std::size_t begin = group * seeds.size() / groups;
    const std::size_t end = (group + 1) * seeds.size() / groups;
    double sum = 0.0;
    int successful = 0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += seeds[i].first;
      successful += seeds[i].second ? 1 : 0;
    }
    const auto count = static_cast<double>(end - begin);
    points.push_back({sum / count, 100.0 * successful / count});
  }
  return points;
}

CurvePoints timeAgainstError(std::span<const RunResult* const> runs) {
  CurvePoints points;
  for (const RunResult* run : runs)
    if (run->completed && run->error)
      points.push_back({run->seconds.total(), run->error->lateral_mm});
  return points;
}

std::vector<double> geometricSteps(double low, double high, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i)
    steps.push_back(low * std::pow(high / low, count > 1 ? i / (count - 1.0) : 0.0));
  return steps;
}

}  // namespace boresight::sessions
