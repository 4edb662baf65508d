// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/calibrated_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// A smaller change is within the scatter of the observations.
constexpr double kLeastChange_sigmas = 3.0;

/// A parameter that moves one member of the camera; all others are coefficients of the distortion.
struct NamedParameter {
  std::string_view parameter;
  const char* name;
  double Camera::*member;
  bool relative;  ///< its sigma is a share of the member
};
constexpr std::array<NamedParameter, 3> kNamedParameters = {
    {{"focal_relative", "focal length", &Camera::fx, true},
     {"centre_x_px", "principal point x", &Camera::cx, false},
     {"centre_y_px", "principal point y", &Camera::cy, false}}};

}  // namespace

bool CalibratedValue::isDetermined() const { return std::isfinite(sigma) && sigma > 0.0; }

double CalibratedValue::changeInSigmas() const {
  return isDetermined() ? (after - before) / sigma : 0.0;
}

std::vector<CalibratedValue> calibratedValues(const Camera& before,
                                              const CameraCalibration& calibration) {
  const Camera& after = calibration.camera;
  std::vector<CalibratedValue> values;
  std::size_t coefficient = 0;
  for (const CalibrationParameter& parameter : calibration.parameters) {
    const auto named =
        std::ranges::find(kNamedParameters, parameter.name, &NamedParameter::parameter);
    if (named == kNamedParameters.end()) {
      values.push_back({"distortion " + parameter.name, "", before.distortion[coefficient],
                        after.distortion[coefficient], parameter.sigma});
      ++coefficient;
      continue;
    }
    const double before_px = before.*named->member;
    const double sigma_px = parameter.sigma * (named->relative ? before_px : 1.0);
    values.push_back({named->name, "px", before_px, after.*named->member, sigma_px});
  }
  return values;
}

std::string changeText(std::span<const CalibratedValue> values) {
  const auto size = [](const CalibratedValue& value) { return std::abs(value.changeInSigmas()); };
  if (std::ranges::none_of(values, &CalibratedValue::isDetermined)) return "";
  const auto largest = std::ranges::max_element(values, {}, size);
  const double change = size(*largest);
  const std::string sigmas = fixedText(change, 1) + " sigma";
  if (change < kLeastChange_sigmas)
    return "No change is needed: the largest, of the " + largest->name + ", is " + sigmas + ".";
  return "The " + largest->name + " changes by " + sigmas +
         ": use the calibrated camera if the observations are right.";
}

std::string directionText(const Undetermined& direction) {
  std::string text = direction.text;
  for (const NamedParameter& named : kNamedParameters)
    for (std::size_t at = 0; (at = text.find(named.parameter, at)) != std::string::npos;) {
      text.replace(at, named.parameter.size(), named.name);
      at += std::string_view(named.name).size();
    }
  return text;
}

}  // namespace boresight::sessions
