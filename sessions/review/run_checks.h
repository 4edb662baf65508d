// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "sessions/review/review_subject.h"
#include "sessions/run/trace.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// What a run says of itself: that it converged, that its corrections shrink, and its last
/// matching iteration's inliers, their spread, window borders and margins. Always the same checks
/// in the same order; not applicable to a pose from marks.
void addRunChecks(const ReviewSubject& subject, const CheckLimits& limits,
                  std::vector<Check>& checks);

/// Whether the run on the ground is the one that ran onboard, where the case has its record.
void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks);

/// Inliers of the last matching iteration; 0 when there was none.
std::int32_t lastInliers(const LocalizationTrace& run);

/// Index of the iteration to look at first: the last one that failed when the run did not converge,
/// else the last one; -1 when there is none.
int iterationToOpen(const LocalizationTrace& run);

/// How widely points spread compared with others, in the direction in which they do least: the
/// smallest ratio of both standard deviations over all directions (a generalized eigenvalue). 1
/// when both spread alike, near 0 when the points lie on a line across which the others spread.
/// Both deviations are increased by `floor_px` (squares add), so that others on a line ask for no
/// spread across it. Nothing when there are fewer than two points of either.
std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px);

/// Standard deviation; 0 for fewer than two values.
double deviationOf(std::span<const double> values);

/// The value in the middle, the lower of two; values must not be empty.
double medianOf(std::span<const double> values);

}  // namespace boresight::sessions
