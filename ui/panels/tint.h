// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>
#include <QPalette>

namespace boresight::ui {

/// The palette with a ground that leans towards a colour and leaves the text readable.
QPalette tinted(const QPalette& base, const QColor& towards);

}  // namespace boresight::ui
