// SPDX-License-Identifier: Apache-2.0
#pragma once

class QApplication;

namespace boresight::ui {

/// Before the QApplication is made: the platform (offscreen where no display is wanted; VTK here is
/// X11, so xcb also under Wayland), scaling, and the surface that VTK draws on. What the
/// environment says (QT_QPA_PLATFORM) holds.
void prepareApplication(bool without_display);

/// Name, organisation and style, which also say where settings are kept.
void nameApplication(QApplication& application);

void useDarkColors(QApplication& application);

}  // namespace boresight::ui
