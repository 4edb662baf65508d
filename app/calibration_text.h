// SPDX-License-Identifier: Apache-2.0
// Printed estimates of `whs calibrate` and `whs hand-eye`.
#pragma once

#include <string>
#include <vector>

#include "sessions/calibration/information.h"

namespace boresight::app {

/// At most nine decimals; "not determined" for values that are not finite.
std::string parameterText(double value);

/// Prints the parameters with their sigmas, the noise factor, and each direction that the
/// observations do not determine, with `advice` on observations to add.
void printParameters(const std::vector<sessions::CalibrationParameter>& parameters,
                     const std::vector<sessions::Undetermined>& undetermined, double noise_factor,
                     const std::string& advice);

}  // namespace boresight::app
