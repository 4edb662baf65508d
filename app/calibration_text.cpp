// SPDX-License-Identifier: Apache-2.0
#include "app/calibration_text.h"

#include <cmath>
#include <iostream>

#include "sessions/text/text_table.h"

namespace boresight::app {

std::string parameterText(double value) {
  return std::isfinite(value) ? sessions::numberText(std::round(value * 1e9) / 1e9)
                              : "not determined";
}

void printParameters(const std::vector<sessions::CalibrationParameter>& parameters,
                     const std::vector<sessions::Undetermined>& undetermined, double noise_factor,
                     const std::string& advice) {
  sessions::TextTable table({"parameter", "value", "1 sigma"});
  for (const auto& parameter : parameters)
    table.add({parameter.name, parameterText(parameter.value), parameterText(parameter.sigma)});
  std::cout << table.text() << "noise factor " << sessions::fixedText(noise_factor, 2)
            << " (1: residuals as the sigmas state)\n";
  for (const sessions::Undetermined& direction : undetermined)
    std::cout << "not determined: " << direction.text << "; " << advice << "\n";
}

}  // namespace boresight::app
