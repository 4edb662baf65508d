// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/base/image.h"
#include "sessions/annotation/landmarks.h"

namespace boresight::sessions {

/// The corner or the centre of an ellipse that the image shows where a landmark should be: the
/// likeliest within three sigma of the prediction, at least 2 and at most 8 px. Nothing where there
/// is none: the prediction itself is no measurement.
std::optional<Eigen::Vector2d> featureOf(const Proposal& proposal, const ImageView& image);

}  // namespace boresight::sessions
