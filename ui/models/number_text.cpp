// SPDX-License-Identifier: Apache-2.0
#include "ui/models/number_text.h"

#include <cmath>

namespace boresight::ui {

QString numberText(double value, int decimals) {
  if (std::isnan(value)) return QString();
  return QString::number(value, 'f', decimals);  // never the locale's comma
}

double roundedUp(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (value <= factor * power * (1.0 + 1e-9)) return factor * power;
  return 10.0 * power;
}

}  // namespace boresight::ui
