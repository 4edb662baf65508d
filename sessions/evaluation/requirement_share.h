// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/evaluation/pose_error.h"

namespace boresight::sessions {

/// The largest part of the requirement that the error takes up; above 1: beyond it.
double requirementShare(const PoseError& error, const Requirement& requirement);

}  // namespace boresight::sessions
