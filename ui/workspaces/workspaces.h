// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include <QByteArray>
#include <QObject>
#include <QSize>

#include "ui/workspaces/workspace.h"

class QDockWidget;
class QMainWindow;
class QSettings;

namespace boresight::ui {

/// The current workspace and the layout of its panels: at first that of workspaceInfo(), then as
/// the operator left them. Panels that a workspace does not place can be added to it.
class Workspaces : public QObject {
  Q_OBJECT

 public:
  /// `body` holds the docks.
  Workspaces(QMainWindow& body, std::vector<QDockWidget*> docks, QObject* parent = nullptr);

  Workspace current() const { return current_; }
  void show(Workspace workspace);
  /// Brings a panel to the front, in the workspace of its task.
  void reveal(const QString& dock);
  /// Restores the default layout of the current workspace.
  void arrange();
  /// Call when the window's size has changed: wide and narrow windows have separate layouts.
  void windowResized();
  bool isNarrow() const { return narrow_; }
  /// Shows or hides all panels at the right or at the bottom.
  void toggleArea(Qt::DockWidgetArea area);
  QDockWidget* dock(const QString& name) const;

  void save(QSettings& settings);
  void restore(const QSettings& settings);

 Q_SIGNALS:
  void changed(boresight::ui::Workspace workspace);

 private:
  void place(const std::vector<PlacedDock>& places);
  void giveSizes(const std::vector<PlacedDock>& places);
  void addAsTab(QDockWidget* added);
  void keepOneDrawer(QDockWidget* opened);
  void bringUp();
  void keepSize(const QSize& size, int tries = 20);
  QByteArray& state();
  QDockWidget* dock(const PlacedDock& placed) const { return dock(QLatin1String(placed.dock)); }

  QMainWindow& body_;
  std::vector<QDockWidget*> docks_;
  Workspace current_ = Workspace::kStart;
  bool narrow_ = true;
  std::map<QString, QByteArray> states_;  ///< by the key in the settings; empty: default
  bool placing_ = false;
  bool shown_ = false;
};

}  // namespace boresight::ui
