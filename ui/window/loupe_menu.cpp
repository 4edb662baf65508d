// SPDX-License-Identifier: Apache-2.0
#include "ui/window/loupe_menu.h"

#include <QAction>
#include <QActionGroup>
#include <QCoreApplication>
#include <QMenu>

#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/mark_tool.h"

namespace boresight::ui {
namespace {

QString tr(const char* text) { return QCoreApplication::translate("LoupeMenu", text); }

QAction* add(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip) {
  QAction* made = menu.addAction(text);
  made->setShortcut(keys);
  made->setToolTip(
      keys.isEmpty() ? tip
                     : QStringLiteral("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
  made->setStatusTip(tip);
  return made;
}

void addSwitches(QMenu& menu, ImageAnnotation& annotation) {
  MarkTool& tool = annotation.tool();
  Loupe& loupe = annotation.loupe();
  QAction* snap = add(menu, tr("&Snap"), Qt::Key_Q,
                      tr("Snap to corners, edges, ellipses and what the mesh has; Alt held refuses "
                         "once, Tab goes on to another"));
  QAction* shown = add(menu, tr("L&oupe"), Qt::Key_L,
                       tr("Magnify the image under the pointer, or the mark that is moved"));
  snap->setCheckable(true);
  snap->setChecked(tool.snaps());
  shown->setCheckable(true);
  shown->setChecked(loupe.isSwitchedOn());
  QObject::connect(snap, &QAction::toggled, &tool, &MarkTool::setSnaps);
  QObject::connect(&tool, &MarkTool::snapsChanged, snap,
                   [snap, &tool] { snap->setChecked(tool.snaps()); });
  QObject::connect(shown, &QAction::toggled, &loupe, &Loupe::setSwitchedOn);
  QObject::connect(&loupe, &Loupe::changed, shown,
                   [shown, &loupe] { shown->setChecked(loupe.isSwitchedOn()); });
}

void addMagnifications(QMenu& menu, Loupe& loupe) {
  QAction* more = add(menu, tr("Loupe: &magnify more"), QKeySequence(QStringLiteral("Ctrl++")),
                      tr("More screen pixels per image pixel; also Ctrl and the wheel"));
  QAction* less = add(menu, tr("Loupe: magnify l&ess"), QKeySequence(QStringLiteral("Ctrl+-")),
                      tr("Fewer screen pixels per image pixel; also Ctrl and the wheel"));
  more->setShortcuts({more->shortcut(), QKeySequence(QStringLiteral("Ctrl+="))});
  QObject::connect(more, &QAction::triggered, &loupe,
                   [&loupe] { loupe.setMagnification(loupe.magnification() * Loupe::kStep); });
  QObject::connect(less, &QAction::triggered, &loupe,
                   [&loupe] { loupe.setMagnification(loupe.magnification() / Loupe::kStep); });
}

void addResiduals(QMenu& menu, ImageAnnotation& annotation) {
  QMenu* residuals = menu.addMenu(tr("Magnify resi&duals"));
  auto* group = new QActionGroup(residuals);
  for (const double factor : {1.0, 10.0, 40.0, 100.0}) {
    QAction* each =
        add(*residuals, tr("%1 times").arg(factor), {},
            tr("Draw what the solved pose leaves of each mark this many times as long"));
    each->setCheckable(true);
    each->setChecked(factor == annotation.magnification());
    group->addAction(each);
    QObject::connect(each, &QAction::triggered, &annotation,
                     [&annotation, factor] { annotation.setMagnification(factor); });
  }
}

}  // namespace

void addLoupeActions(QMenu& menu, ImageAnnotation& annotation) {
  addSwitches(menu, annotation);
  addMagnifications(menu, annotation.loupe());
  addResiduals(menu, annotation);
}

}  // namespace boresight::ui
