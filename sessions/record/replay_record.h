// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include "core/localizer/problem.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// An onboard run as every view shows a run that was made here. Poses, counts, templates, where
/// they were found, inliers, support and end are the record's. What a record leaves out is made by
/// the core from what the ground has, with the record's options and at the record's poses: the
/// image's edges, renders, the templates' points, search windows; residuals are those of the
/// recorded poses. Edge places of refinements, covariances but the last, and what matching scores
/// are made of are not known and stay empty (`recorded_scores` has the scores).
///
/// `ground` is what a run on the ground would be given. Where that is not what the run was given on
/// board, or the record is cut or of another program, `remarks` says so. With the same inputs the
/// replay is the ground's run in all that both have. A stop leaves the iterations done so far.
LocalizationTrace replayRecord(const OnboardRecord& record, const LocalizationProblem& ground,
                               const std::stop_token& stop = {});

}  // namespace boresight::sessions
