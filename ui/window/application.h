// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

class QApplication;

namespace boresight::ui {

/// Before the QApplication is made: the platform (offscreen where no display is wanted; VTK here is
/// X11, so xcb also under Wayland), scaling, and the surface that VTK draws on. What the
/// environment says (QT_QPA_PLATFORM) holds.
void prepareApplication(bool without_display);

/// Name, organisation and style, which also say where settings are kept.
void nameApplication(QApplication& application);

void useDarkColors(QApplication& application);

/// Tests the installed program on the example that ships, without a display: one line per test,
/// then "N passed, N failed". Returns how many failed.
int runSelfTest(std::ostream& output);

}  // namespace boresight::ui
