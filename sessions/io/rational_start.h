// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/camera.h"

namespace boresight::sessions {

/// A Brown-Conrady camera with all six radial coefficients that distorts radially as a
/// Kannala-Brandt camera does, up to an angle off the axis (rad, less than 90 deg): a start for
/// fits of wide fields, where from no distortion at all the zeros of numerator and denominator soon
/// meet within the image. fx fy cx cy and the size are kept; not prepared. (Linear least squares,
/// weighted with the denominator of the round before: Sanathanan and Koerner, "Transfer function
/// synthesis as a ratio of two complex polynomials", 1963.)
Camera rationalStart(const Camera& kannala_brandt, double widest_rad);

}  // namespace boresight::sessions
