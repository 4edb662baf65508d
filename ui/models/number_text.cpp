// SPDX-License-Identifier: Apache-2.0
#include "ui/models/number_text.h"

#include <cmath>

namespace boresight::ui {

QString numberText(double value, int decimals) {
  if (std::isnan(value)) return QString();
  return QString::number(value, 'f', decimals);  // never the locale's comma
}

}  // namespace boresight::ui
