// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>

#include "ui/style/tokens.h"

class QApplication;

namespace boresight::ui {

enum class ThemeName { kLight, kDark };

/// Colours of the theme that is in use; the light one before any was applied.
const Theme& theme();
ThemeName themeName();

/// Gives the program palette, style sheet and type of a theme. Widgets follow at once.
void applyTheme(QApplication& application, ThemeName name);

/// The theme that was chosen last, on this machine; the desktop's where none was.
ThemeName rememberedTheme();
void rememberTheme(ThemeName name);

}  // namespace boresight::ui
