// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

#include "sessions/session/case_inputs.h"
#include "ui/window/window_parts.h"

class QMenu;
class QWidget;

namespace boresight::ui {

/// "camera"
QString inputName(sessions::InputKind kind);
/// Files of this kind, for a dialog.
QString inputFilter(sessions::InputKind kind);

/// Asks for another file of this kind; for a mesh also for its unit. Undo restores the former one.
void askForInput(WindowParts& parts, QWidget& window, const QString& case_id,
                 sessions::InputKind kind);
/// Asks for another unit of the mesh.
void askForMeshUnit(WindowParts& parts, QWidget& window, const QString& case_id);

/// Adds an entry for each input, and the mesh's unit.
void addChangeInput(QMenu& menu, WindowParts& parts, QWidget& window, const QString& case_id);

}  // namespace boresight::ui
