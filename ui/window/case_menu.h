// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QMenu>
#include <QString>

#include "ui/window/window_parts.h"

namespace boresight::ui {

class Workspaces;

/// The context menu of a case of the session, to be shown by the caller.
std::unique_ptr<QMenu> caseMenu(const QString& id, WindowParts& parts, Workspaces& workspaces,
                                QWidget& window);

}  // namespace boresight::ui
