// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"

// Parameters of an iteration from the options. Iterations are counted from 0 within an attempt,
// hypotheses within an iteration.
namespace boresight {

/// Roll between two renders, 4.4 deg: templates still match an image turned by half of it.
inline constexpr double kRollSpacing_rad = 0.0767944870878;
/// Standard deviation of a correct match, in pixels of its level: matching counts whole pixels.
inline constexpr double kMatchSigma_px = 1.0;
/// Search radius of the first refinement, in pixels of its level: covers the error after matching.
inline constexpr double kFirstRadius_px = 3.0;
/// Search radius of later refinements: covers the error after the first one, and few other edges.
inline constexpr double kLastRadius_px = 0.7;
/// Least number of refinements of a run: the wide search of the first one may find wrong edges.
inline constexpr int kMinRefinements = 2;

/// Pyramid levels of a run.
struct RunLevels {
  int fine = 0;    ///< of later iterations and refinements: one finer than `coarse`
  int coarse = 0;  ///< of the first iteration
};
RunLevels levelsOf(const ProblemSize& size, const LocalizerOptions& options);

/// Whether the best of several hypotheses is kept while another one is tried.
bool comparesHypotheses(const LocalizerOptions& options);

/// Whether the iteration refines on the image's own edges instead of matching templates.
bool isRefinement(const LocalizerOptions& options, int iteration);

/// `factor` to the power of the number of shrinking iterations so far.
double shrinkAt(double factor, const LoopOptions& loop, int iteration);

/// Inlier threshold of a matching iteration, or search radius of a refinement on this level; in
/// pixels of the image itself.
double thresholdAt(const LocalizerOptions& options, int iteration, int level);

/// Uncertainty of the pose in this iteration, about a pivot that moves with the hypothesis.
SeedUncertainty uncertaintyAt(const Seed& seed, const LoopOptions& loop, int iteration,
                              const Pose& camera_from_station);

/// Number of renders that the first iteration compares, rolled about the view axis. Each covers
/// half a spacing to either side; together they cover the seed's uncertainty.
int rolledHypotheses(const LocalizerOptions& options, const SeedUncertainty& uncertainty);
/// Roll of a hypothesis: 0, +s, -s, +2s, -2s, ...
double rollOf(int hypothesis);

/// Factor on the template size of an attempt (from 0): another size may succeed where one failed.
double templateFactor(int attempt);

/// Least number of iterations before a small correction may end the run.
int iterationsNeeded(const LocalizerOptions& options);

}  // namespace boresight
