// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QColor>

#include "ui/style/tokens.h"

class QApplication;

namespace boresight::ui {

enum class ThemeName { kLight, kDark };

/// Colours of the theme in use; the light theme before any was applied.
const Theme& theme();
ThemeName themeName();

/// Applies palette, style sheet and fonts of a theme to the program. Widgets change at once.
void applyTheme(QApplication& application, ThemeName name);

/// The theme chosen last, from the program's settings; the desktop's when none was chosen.
ThemeName rememberedTheme();
void rememberTheme(ThemeName name);

}  // namespace boresight::ui
