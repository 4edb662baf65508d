// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/drawer_bar.h"

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {

DrawerBar::DrawerBar(Workspaces& workspaces, QWidget* parent)
    : QFrame(parent), workspaces_(workspaces), row_(withoutMargins(new QHBoxLayout(this))) {
  setObjectName(QStringLiteral("drawerBar"));
  setFixedHeight(kDrawerHandleHeight);
  connect(&workspaces_, &Workspaces::changed, this, &DrawerBar::showWorkspace);
  showWorkspace();
}

void DrawerBar::showWorkspace() {
  clearLayout(*row_);
  const WorkspaceInfo& info = workspaceInfo(workspaces_.current());
  const bool useful = workspaces_.isNarrow() && info.handles;
  setVisible(useful);
  if (!useful) return;
  for (const char* name : info.drawers) {
    QDockWidget* dock = workspaces_.dock(QLatin1String(name));
    if (!dock) continue;
    auto* button = new QToolButton;
    button->setDefaultAction(dock->toggleViewAction());
    button->setToolButtonStyle(Qt::ToolButtonTextOnly);
    button->setFixedHeight(kDrawerHandleHeight - 1);  // below the line of the bar
    row_->addWidget(button);
  }
  row_->addStretch(1);
}

}  // namespace boresight::ui
