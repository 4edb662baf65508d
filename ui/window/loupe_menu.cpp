// SPDX-License-Identifier: Apache-2.0
#include "ui/window/loupe_menu.h"

#include <QtWidgets>

#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/mark_tool.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

QString tr(const char* text) { return QCoreApplication::translate("LoupeMenu", text); }

/// A switch of something that tells when it has changed by itself.
template <class Owner>
void addSwitch(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip,
               Owner* owner, bool (Owner::*isOn)() const, void (Owner::*set)(bool),
               void (Owner::*changed)()) {
  QAction* made = addAction(menu, text, keys, tip);
  made->setCheckable(true);
  made->setChecked((owner->*isOn)());
  QObject::connect(made, &QAction::toggled, owner, set);
  QObject::connect(owner, changed, made, [=] { made->setChecked((owner->*isOn)()); });
}

void addMagnifications(QMenu& menu, Loupe* loupe) {
  const auto magnify = [loupe](double factor) {
    return [loupe, factor] { loupe->setMagnification(loupe->magnification() * factor); };
  };
  QAction* more = addAction(menu, tr("Loupe: &magnify more"), keys("Ctrl++"),
                            tr("More screen pixels per image pixel; also Ctrl and the wheel"),
                            loupe, magnify(Loupe::kStep));
  more->setShortcuts({more->shortcut(), keys("Ctrl+=")});
  addAction(menu, tr("Loupe: magnify l&ess"), keys("Ctrl+-"),
            tr("Fewer screen pixels per image pixel; also Ctrl and the wheel"), loupe,
            magnify(1.0 / Loupe::kStep));
}

void addResiduals(QMenu& menu, ImageAnnotation* annotation) {
  QMenu* residuals = menu.addMenu(tr("Magnify resi&duals"));
  auto* group = new QActionGroup(residuals);
  for (const double factor : {1.0, 10.0, 40.0, 100.0}) {
    QAction* each =
        addAction(*residuals, tr("%1 times").arg(factor), {},
                  tr("Draw what the solved pose leaves of each mark this many times as long"),
                  annotation, [annotation, factor] { annotation->setMagnification(factor); });
    each->setCheckable(true);
    each->setChecked(factor == annotation->magnification());
    group->addAction(each);
  }
}

}  // namespace

void addLoupeActions(QMenu& menu, ImageAnnotation& annotation) {
  addSwitch(menu, tr("&Snap"), Qt::Key_Q,
            tr("Snap to corners, edges, ellipses and what the mesh has; Alt held refuses once, Tab "
               "goes on to another"),
            &annotation.tool(), &MarkTool::snaps, &MarkTool::setSnaps, &MarkTool::snapsChanged);
  addSwitch(menu, tr("L&oupe"), Qt::Key_L,
            tr("Magnify the image under the pointer, or the mark that is moved"),
            &annotation.loupe(), &Loupe::isSwitchedOn, &Loupe::setSwitchedOn, &Loupe::changed);
  addMagnifications(menu, &annotation.loupe());
  addResiduals(menu, &annotation);
}

}  // namespace boresight::ui
