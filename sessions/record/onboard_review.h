// SPDX-License-Identifier: Apache-2.0
// Data for the review of a case's onboard record.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/localizer/problem.h"
#include "sessions/record/compare_records.h"
#include "sessions/record/onboard_record.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// An onboard record and its replay. Immutable; shared by the views.
struct OnboardReview {
  OnboardRecord record;
  RecordedPlan plan;
  std::shared_ptr<const LocalizationTrace> replay;
};

/// Reads a record and replays it. InputError as readRecord, and when the bytes are not those of
/// `sha256`.
std::shared_ptr<const OnboardReview> reviewRecord(const std::filesystem::path& file,
                                                  const std::string& sha256,
                                                  const LocalizationProblem& ground,
                                                  const std::stop_token& stop = {});

/// Compares the onboard run with a ground run on the input `ground`.
RecordComparison compareWithGround(const OnboardReview& review, const LocalizationTrace& run,
                                   const LocalizationProblem& ground,
                                   const ComparisonLimits& limits = {});

/// Content of the record as pairs of label and value: how the run ended, iterations, pose, one
/// sigma, digest, and whether it is whole.
std::vector<std::pair<std::string, std::string>> recordSheet(const OnboardRecord& record);

/// "Agrees with the run on the ground bit for bit.", ...: one sentence.
std::string verdictText(const RecordComparison& comparison);
/// "At least 80 % of ...": the limits, for other pixels.
std::string limitsText(const ComparisonLimits& limits);

}  // namespace boresight::sessions
