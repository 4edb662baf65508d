// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/localizer/problem.h"
#include "core/record/record_writer.h"

namespace boresight::sessions {

/// The hashes by which an onboard record knows what a run was given, as core/record/FORMAT.md says;
/// `problem` without the colour that the run does not use (withoutUnusedColor).
RecordInputs recordInputs(const LocalizationProblem& problem);

}  // namespace boresight::sessions
