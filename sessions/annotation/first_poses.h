// SPDX-License-Identifier: Apache-2.0
// Poses from which least squares over annotated points may begin.
#pragma once

#include <vector>

#include "core/geometry/pose.h"
#include "sessions/annotation/annotations.h"

namespace boresight::sessions {

/// Different poses, camera from station, that agree best with the enabled points of a view, the
/// best first, at most twelve: all solutions of many triples of points, by P3P and, for objects
/// that are small or far, by scaled orthography (Alter, "3-D Pose from 3 Points Using Weak
/// Perspective", PAMI 1994). Points far off count little, so that some may be wrong. Deterministic.
/// None with fewer than four points.
std::vector<Pose> firstPoses(const AnnotatedView& view);

}  // namespace boresight::sessions
