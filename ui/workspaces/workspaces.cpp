// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/workspaces.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/style/tokens.h"

namespace boresight::ui {
namespace {

constexpr int kStateVersion = 4;  // of another set of panels, a layout is not taken over

QString keyOf(Workspace workspace, bool narrow) {
  return QStringLiteral("workspaces/%1/%2")
      .arg(QString(QLatin1String(workspaceInfo(workspace).name)).toLower(),
           narrow ? QStringLiteral("narrow") : QStringLiteral("wide"));
}

}  // namespace

Workspaces::Workspaces(QMainWindow& body, std::vector<QDockWidget*> docks, QObject* parent)
    : QObject(parent), body_(body), docks_(std::move(docks)) {
  for (QDockWidget* each : docks_) {
    body_.addDockWidget(Qt::RightDockWidgetArea, each);
    each->hide();
    connect(each, &QDockWidget::visibilityChanged, this, [this, each](bool visible) {
      if (visible) keepOneDrawer(each);
    });
    connect(each->toggleViewAction(), &QAction::triggered, this, [this, each](bool shown) {
      if (shown) addAsTab(each);
    });
  }
}

QDockWidget* Workspaces::dock(const QString& name) const {
  const auto found = std::ranges::find_if(
      docks_, [&name](const QDockWidget* each) { return each->objectName() == name; });
  return found == docks_.end() ? nullptr : *found;
}

void Workspaces::show(Workspace workspace) {
  if (workspace == current_) return;
  if (shown_) state() = body_.saveState(kStateVersion);
  const QSize size = body_.window()->size();
  current_ = workspace;
  bringUp();
  keepSize(size);
  Q_EMIT changed(workspace);
}

void Workspaces::bringUp() {
  placing_ = true;
  const bool restored = !state().isEmpty() && body_.restoreState(state(), kStateVersion);
  placing_ = false;
  if (!restored) arrange();
}

/// Panels of two workspaces are there together for a moment, which can make the window larger than
/// the screen; layouts take some events until the window can be as small again.
void Workspaces::keepSize(const QSize& size, int tries) {
  if (!shown_ || tries == 0) return;
  QTimer::singleShot(0, this, [this, size, tries] {
    QWidget* window = body_.window();
    if (window->isMaximized() || window->isFullScreen()) return;
    window->resize(size);
    if (window->size() != size) keepSize(size, tries - 1);
  });
}

void Workspaces::reveal(const QString& name) {
  if (const auto home = homeOf(name)) show(*home);
  QDockWidget* found = dock(name);
  if (!found) return;
  found->show();
  addAsTab(found);
}

/// A panel that is added takes no room from those of the workspace: it is a tab of the last one at
/// the right.
void Workspaces::addAsTab(QDockWidget* added) {
  const std::vector<PlacedDock>& places = workspaceInfo(current_).wide;
  const auto of_workspace = std::ranges::find_if(places, [added](const PlacedDock& each) {
    return added->objectName() == QLatin1String(each.dock);
  });
  if (!narrow_ && of_workspace == places.end() && !added->isFloating() &&
      body_.dockWidgetArea(added) == Qt::RightDockWidgetArea)
    for (auto each = places.rbegin(); each != places.rend(); ++each) {
      QDockWidget* there = dock(*each);
      if (each->area != Qt::RightDockWidgetArea || !there || there->isHidden()) continue;
      body_.tabifyDockWidget(there, added);
      break;
    }
  added->raise();
}

void Workspaces::windowResized() {
  const bool narrow = body_.window()->width() < kWideWindow;
  const bool first = !std::exchange(shown_, true);
  if (!first && narrow == narrow_) return;
  if (!first) state() = body_.saveState(kStateVersion);
  narrow_ = narrow;
  bringUp();
  Q_EMIT changed(current_);
}

void Workspaces::arrange() {
  state().clear();
  const WorkspaceInfo& info = workspaceInfo(current_);
  const std::vector<PlacedDock>& places = narrow_ ? info.narrow : info.wide;
  placing_ = true;
  place(places);
  giveSizes(places);
  placing_ = false;
}

/// All are taken out first: what is left over from another workspace would share tabs.
void Workspaces::place(const std::vector<PlacedDock>& places) {
  // Tables of poses and options are long, the one of iterations is wide.
  body_.setCorner(Qt::BottomRightCorner, current_ == Workspace::kDiagnose
                                             ? Qt::RightDockWidgetArea
                                             : Qt::BottomDockWidgetArea);
  for (QDockWidget* each : docks_) {
    each->setFloating(false);
    body_.removeDockWidget(each);
  }
  for (const PlacedDock& each : places) {
    QDockWidget* placed = dock(each);
    QDockWidget* behind = each.behind ? dock(QLatin1String(each.behind)) : nullptr;
    if (!placed) continue;
    if (behind)
      body_.tabifyDockWidget(behind, placed);
    else
      body_.addDockWidget(each.area, placed);
    placed->show();
    if (behind) behind->raise();
  }
  // The others can be added; those of a narrow window's drawers share their place.
  for (QDockWidget* each : docks_)
    if (body_.dockWidgetArea(each) == Qt::NoDockWidgetArea) {
      const bool table = each->objectName() == QLatin1String("iterations") ||
                         each->objectName() == QLatin1String("annotation") ||
                         each->objectName() == QLatin1String("onboard");
      body_.addDockWidget(table                                          ? Qt::BottomDockWidgetArea
                          : each->objectName() == QLatin1String("cases") ? Qt::LeftDockWidgetArea
                                                                         : Qt::RightDockWidgetArea,
                          each);
      each->hide();
    }
}

void Workspaces::giveSizes(const std::vector<PlacedDock>& places) {
  body_.layout()->activate();  // as minimum sizes are now
  QList<QDockWidget*> sides;
  QList<QDockWidget*> stacked;
  QList<int> widths;
  QList<int> heights;
  int shares = 0;
  for (const PlacedDock& each : places)
    if (each.area == Qt::RightDockWidgetArea && !each.behind) shares += each.share;
  for (const PlacedDock& each : places) {
    QDockWidget* placed = dock(each);
    if (!placed || each.behind) continue;
    if (each.area == Qt::BottomDockWidgetArea) {
      body_.resizeDocks({placed}, {each.size}, Qt::Vertical);
      continue;
    }
    sides << placed;
    widths << each.size;
    if (each.area == Qt::RightDockWidgetArea) {
      stacked << placed;
      heights << body_.height() * each.share / std::max(1, shares);
    }
  }
  if (!sides.isEmpty()) body_.resizeDocks(sides, widths, Qt::Horizontal);
  if (stacked.size() > 1) body_.resizeDocks(stacked, heights, Qt::Vertical);
}

/// In a narrow window the image keeps its room: a drawer that opens closes the others.
void Workspaces::keepOneDrawer(QDockWidget* opened) {
  if (placing_ || !shown_ || !narrow_ || opened->isFloating()) return;
  const auto is_drawer = [&drawers = workspaceInfo(current_).drawers](const QDockWidget* each) {
    return std::ranges::any_of(
        drawers, [each](const char* name) { return each->objectName() == QLatin1String(name); });
  };
  if (current_ == Workspace::kAnnotate || !is_drawer(opened)) return;
  placing_ = true;
  for (QDockWidget* each : docks_)
    if (each != opened && is_drawer(each) && !each->isFloating()) each->hide();
  placing_ = false;
}

void Workspaces::toggleArea(Qt::DockWidgetArea area) {
  bool any_shown = false;
  for (QDockWidget* each : docks_)
    if (body_.dockWidgetArea(each) == area && !each->isFloating() && !each->isHidden()) {
      any_shown = true;
      each->hide();
    }
  if (any_shown) return;
  const WorkspaceInfo& info = workspaceInfo(current_);
  const auto& places = narrow_ && !info.narrow.empty() ? info.narrow : info.wide;
  for (const PlacedDock& each : places)
    if (each.area == area)
      if (QDockWidget* placed = dock(each)) placed->show();
  giveSizes(places);
}

QByteArray& Workspaces::state() { return states_[keyOf(current_, narrow_)]; }

void Workspaces::save(QSettings& settings) {
  state() = body_.saveState(kStateVersion);
  for (const auto& [key, kept] : states_)
    if (!kept.isEmpty()) settings.setValue(key, kept);
}

void Workspaces::restore(const QSettings& settings) {
  for (int i = 0; i < kWorkspaceCount; ++i)
    for (const bool narrow : {false, true}) {
      const QString key = keyOf(static_cast<Workspace>(i), narrow);
      states_[key] = settings.value(key).toByteArray();
    }
}

}  // namespace boresight::ui
