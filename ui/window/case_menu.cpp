// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_menu.h"

#include <QClipboard>
#include <QDesktopServices>
#include <QGuiApplication>
#include <QUrl>

#include "sessions/session/session.h"
#include "ui/models/text.h"
#include "ui/run/run_controller.h"
#include "ui/state/document.h"
#include "ui/style/icons.h"
#include "ui/window/case_controller.h"
#include "ui/window/change_input.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {

CaseMenu::CaseMenu(const WindowParts& parts, Workspaces& workspaces, QWidget* parent)
    : QObject(parent), parts_(parts), workspaces_(workspaces), parent_(parent) {}

std::unique_ptr<QMenu> CaseMenu::of(const QString& id) const {
  auto menu = std::make_unique<QMenu>(parent_);
  const auto add = [&](const char* name, const QIcon& icon, const QString& text, auto act) {
    QAction* action = menu->addAction(icon, text, this, act);
    action->setObjectName(QLatin1String(name));
    return action;
  };
  add("caseRun", iconOf(Icon::kRun), tr("Run"), [this, id] {
    parts_.cases.runAll({id});
  })->setEnabled(!isBusy());
  add("caseReview", iconOf(Icon::kShield), tr("Review"), [this, id] { review(id); });
  menu->addSeparator();
  auto* change = menu->addMenu(iconOf(Icon::kFolder), tr("Change file"));
  change->setObjectName(QStringLiteral("caseChange"));
  change->setEnabled(parts_.document.isEditable() && !isBusy());
  addChangeInput(*change, parts_, *parent_, id);
  add("caseName", {}, tr("Copy the name"), [id] { QGuiApplication::clipboard()->setText(id); });
  add("caseFolder", iconOf(Icon::kFolder), tr("Show the image's folder"),
      [this, id] { showFolder(id); });
  menu->addSeparator();
  add("caseRemove", iconOf(Icon::kTrash), tr("Remove from the session"), [this, id] {
    remove(id);
  })->setEnabled(parts_.document.isEditable() && !isBusy());
  return menu;
}

void CaseMenu::show(const QString& id, const QPoint& at) { of(id)->exec(at); }

bool CaseMenu::isBusy() const {
  return parts_.run.state() == RunState::kWorking || parts_.cases.batch();
}

void CaseMenu::review(const QString& id) const {
  parts_.cases.chooseCase(id);
  workspaces_.show(Workspace::kReview);
}

void CaseMenu::showFolder(const QString& id) const {
  const sessions::SessionCase* session_case = parts_.document.session().findCase(id.toStdString());
  if (!session_case) return;
  const std::string folder = session_case->image.source.file.parent_path().string();
  QDesktopServices::openUrl(QUrl::fromLocalFile(fromText(folder)));
}

/// With its runs, annotations and decisions; an undo brings all of it back. Files stay.
void CaseMenu::remove(const QString& id) const {
  parts_.document.edit(sessions::withoutCase(parts_.document.session(), id.toStdString()),
                       tr("Remove %1").arg(id));
}

}  // namespace boresight::ui
