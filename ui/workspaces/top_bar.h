// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui/workspaces/workspace.h"

class QHBoxLayout;
class QMenuBar;
class QTabBar;

namespace boresight::ui {

/// One row: the menus, the workspaces as tabs, and tools at the right.
class TopBar : public QWidget {
  Q_OBJECT

 public:
  explicit TopBar(QMenuBar& menus, QWidget* parent = nullptr);

  void setCurrent(Workspace workspace);
  /// Adds a tool at the right end.
  void addTool(QWidget* tool);

 Q_SIGNALS:
  void workspaceRequested(boresight::ui::Workspace workspace);

 private:
  QTabBar* tabs_ = nullptr;
  QHBoxLayout* tools_ = nullptr;
};

}  // namespace boresight::ui
