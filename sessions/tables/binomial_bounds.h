// SPDX-License-Identifier: Apache-2.0
// Confidence bounds of a share from counts of runs (Clopper and Pearson 1934).
#pragma once

#include <cstdint>

namespace boresight::sessions {

/// Confidence of every bound in tables, one-sided.
inline constexpr double kConfidence = 0.95;

/// Largest share that `count` of `runs` leaves possible at this confidence: the exact upper bound.
/// 1 when all of them count or there is no run. Needs 0 <= count <= runs, 0 < confidence < 1.
double upperBound(std::int64_t count, std::int64_t runs, double confidence = kConfidence);

/// Smallest such share. 0 when none of them counts or there is no run.
double lowerBound(std::int64_t count, std::int64_t runs, double confidence = kConfidence);

/// Fewest runs, of which at most `failures` fail, whose lower bound of success reaches `success`
/// (share, below 1). Independent runs are assumed.
std::int64_t runsNeeded(double success, std::int64_t failures, double confidence = kConfidence);

}  // namespace boresight::sessions
