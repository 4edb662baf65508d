// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/session/check_limits.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The limits of another preset; what was changed of the former ones is dropped.
/// std::invalid_argument when there is no such preset.
ReviewSettings withPreset(const ReviewSettings& settings, const std::string& preset);

/// A case's own requirement, else the preset's. InputError when there is no such preset.
Requirement requirementOf(const Session& session, const SessionCase& one);

/// These limits, kept as what differs from the preset. std::invalid_argument when there is none.
ReviewSettings withLimits(const ReviewSettings& settings, const CheckLimits& limits);

}  // namespace boresight::sessions
