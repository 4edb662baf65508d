// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/calibrated_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// A smaller change is within the scatter of the observations.
constexpr double kLeastChange_sigmas = 3.0;

constexpr std::array<std::pair<const char*, const char*>, 3> kParameterNames = {
    {{"focal_relative", "focal length"},
     {"centre_x_px", "principal point x"},
     {"centre_y_px", "principal point y"}}};

std::string nameOf(const std::string& parameter) {
  for (const auto& [known, name] : kParameterNames)
    if (parameter == known) return name;
  return "distortion " + parameter;
}

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
    const std::string name = nameOf(parameter.name);
    if (parameter.name == "focal_relative") {
      values.push_back({name, "px", before.fx, after.fx, parameter.sigma * before.fx});
    } else if (parameter.name == "centre_x_px") {
      values.push_back({name, "px", before.cx, after.cx, parameter.sigma});
    } else if (parameter.name == "centre_y_px") {
      values.push_back({name, "px", before.cy, after.cy, parameter.sigma});
    } else {
      values.push_back({name, "", before.distortion[coefficient], after.distortion[coefficient],
                        parameter.sigma});
      ++coefficient;
    }
  }
  return values;
}

std::string changeText(std::span<const CalibratedValue> values) {
  const auto largest = std::max_element(
      values.begin(), values.end(), [](const CalibratedValue& a, const CalibratedValue& b) {
        return std::abs(a.changeInSigmas()) < std::abs(b.changeInSigmas());
      });
  if (largest == values.end() ||
      std::none_of(values.begin(), values.end(),
                   [](const CalibratedValue& value) { return value.isDetermined(); }))
    return "";
  const double change = std::abs(largest->changeInSigmas());
  const std::string sigmas = fixedText(change, 1) + " sigma";
  if (change < kLeastChange_sigmas)
    return "No change is needed: the largest, of the " + largest->name + ", is " + sigmas + ".";
  return "The " + largest->name + " changes by " + sigmas +
         ": use the calibrated camera if the observations are right.";
}

std::string directionText(const Undetermined& direction) {
  std::string text = direction.text;
  for (const auto& [parameter, name] : kParameterNames)
    for (std::size_t at = 0; (at = text.find(parameter, at)) != std::string::npos;) {
      text.replace(at, std::string(parameter).size(), name);
      at += std::string(name).size();
    }
  return text;
}

}  // namespace boresight::sessions
