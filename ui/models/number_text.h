// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

namespace boresight::ui {

/// For table cells: so many decimals, always with a dot; nothing for NaN.
QString numberText(double value, int decimals);

/// A core or session text in UTF-8.
inline QString fromText(const std::string& text) { return QString::fromStdString(text); }

}  // namespace boresight::ui
