// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

class QHBoxLayout;

namespace boresight::ui {

class Workspaces;

/// Bar below the canvas of a narrow window: a button for each panel of the workspace that opens as
/// a drawer.
class DrawerBar : public QFrame {
  Q_OBJECT

 public:
  explicit DrawerBar(Workspaces& workspaces, QWidget* parent = nullptr);

  void showWorkspace();

 private:
  Workspaces& workspaces_;
  QHBoxLayout* row_ = nullptr;
};

}  // namespace boresight::ui
