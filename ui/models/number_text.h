// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

namespace boresight::ui {

/// For table cells: so many decimals, always with a dot; nothing for NaN.
QString numberText(double value, int decimals);

/// 1, 2 or 5 times a power of ten, not below the value by more than rounding: where a scale or an
/// axis ends. 1 for what is not above zero.
double roundedUp(double value);

/// A core or session text in UTF-8.
inline QString fromText(const std::string& text) { return QString::fromStdString(text); }

}  // namespace boresight::ui
