// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/schedule.h"

#include <algorithm>

#include "core/edges/edge_map.h"

namespace boresight {

namespace {

/// The finest level from `level` on whose longer image side is at most `size_px`.
int levelOfSize(int longer, int size_px, int level) {
  while (level < kPyramidLevels - 1 && (longer >> level) > size_px) ++level;
  return level;
}

}  // namespace

RunLevels levelsOf(const ProblemSize& size, const LocalizerOptions& options) {
  const int longer = std::max(size.width, size.height);
  const int finest = longer > options.loop.halved_size_px ? 1 : 0;
  RunLevels levels;
  levels.coarse = levelOfSize(longer, options.loop.coarse_size_px, finest);
  levels.fine = std::max(0, levels.coarse - 1);
  return levels;
}

bool comparesHypotheses(const LocalizerOptions& options) {
  return options.loop.max_rolled_hypotheses > 1;
}

bool isRefinement(const LocalizerOptions& options, int iteration) {
  return options.refinement.enabled && iteration >= options.loop.match_iterations;
}

double shrinkAt(double factor, const LoopOptions& loop, int iteration) {
  double product = 1.0;
  for (int i = 0; i < std::min(iteration, loop.shrink_iterations); ++i) product *= factor;
  return product;
}

double thresholdAt(const LocalizerOptions& options, int iteration, int level) {
  if (!isRefinement(options, iteration)) {
    return shrinkAt(options.loop.threshold_shrink, options.loop, iteration) *
           options.loop.inlier_threshold_px;
  }
  const bool first = iteration == options.loop.match_iterations;
  const double radius_px = first ? kFirstRadius_px : kLastRadius_px;
  return radius_px * levelScale(level);
}

SeedUncertainty uncertaintyAt(const Seed& seed, const LoopOptions& loop, int iteration,
                              const Pose& camera_from_station) {
  SeedUncertainty shrunk =
      scaled(seed.uncertainty, shrinkAt(loop.uncertainty_shrink, loop, iteration));
  // The pivot belongs to the scene and moves with the hypothesis, unless it is the camera's centre.
  const Eigen::Vector3d& pivot_in_camera_m = seed.uncertainty.pivot_in_camera_m;
  if (pivot_in_camera_m.squaredNorm() > 0.0) {
    shrunk.pivot_in_camera_m =
        camera_from_station * (seed.camera_from_station.inverse() * pivot_in_camera_m);
  }
  return shrunk;
}

int rolledHypotheses(const LocalizerOptions& options, const SeedUncertainty& uncertainty) {
  constexpr double half_rad = 0.5 * kRollSpacing_rad;
  const double uncovered_rad = uncertainty.rotation_rad.z() - half_rad;
  int count = 1;
  while (count + 2 <= options.loop.max_rolled_hypotheses && (count - 1) * half_rad < uncovered_rad)
    count += 2;
  return count;
}

double rollOf(int hypothesis) {
  if (hypothesis == 0) return 0.0;
  const int step = (hypothesis + 1) / 2;
  return (hypothesis % 2 == 1 ? 1.0 : -1.0) * step * kRollSpacing_rad;
}

double templateFactor(int attempt) {
  constexpr double kFactors[3] = {1.0, 2.0, 0.5};
  return kFactors[std::clamp(attempt, 0, 2)];
}

int iterationsNeeded(const LocalizerOptions& options) {
  const int converged = options.loop.converged_iterations;
  if (!options.refinement.enabled) return converged;
  return std::max(options.loop.match_iterations + kMinRefinements, converged);
}

}  // namespace boresight
