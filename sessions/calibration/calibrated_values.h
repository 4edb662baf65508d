// SPDX-License-Identifier: Apache-2.0
// Changes made by a calibration, for display.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "sessions/calibration/camera_calibration.h"

namespace boresight::sessions {

/// A parameter of a camera before and after its calibration.
struct CalibratedValue {
  std::string name;  ///< "focal length"
  std::string unit;  ///< "px", or empty
  double before = 0.0;
  double after = 0.0;
  double sigma = 0.0;  ///< one sigma of `after`; not finite: not determined

  bool isDetermined() const;
  /// The change divided by its sigma; 0 where it is not determined.
  double changeInSigmas() const;
};

/// The calibration's parameters in their order. `before`: the start camera.
std::vector<CalibratedValue> calibratedValues(const Camera& before,
                                              const CameraCalibration& calibration);

/// Whether a change is needed: "No change is needed: the largest, of the focal length, is 1.1
/// sigma."; empty when nothing is determined.
std::string changeText(std::span<const CalibratedValue> values);

/// A combination that is not determined, with the displayed names of the parameters.
std::string directionText(const Undetermined& direction);

}  // namespace boresight::sessions
