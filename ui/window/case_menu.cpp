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

std::unique_ptr<QMenu> caseMenu(const QString& id, WindowParts& parts, Workspaces& workspaces,
                                QWidget& window) {
  auto menu = std::make_unique<QMenu>(&window);
  const bool idle = !parts.cases.isWorking();
  const auto add = [&](const char* name, const QIcon& icon, const QString& text, auto act) {
    QAction* action = menu->addAction(icon, text, &window, act);
    action->setObjectName(QLatin1String(name));
    return action;
  };
  QAction* run = add("caseRun", iconOf(Icon::kRun), QMenu::tr("Run"),
                     [&parts, id] { parts.cases.runAll({id}); });
  run->setEnabled(idle);
  add("caseReview", iconOf(Icon::kShield), QMenu::tr("Review"), [&parts, &workspaces, id] {
    parts.cases.chooseCase(id);
    workspaces.show(Workspace::kReview);
  });
  menu->addSeparator();
  auto* change = menu->addMenu(iconOf(Icon::kFolder), QMenu::tr("Change file"));
  change->setObjectName(QStringLiteral("caseChange"));
  change->setEnabled(parts.document.isEditable() && idle);
  addChangeInput(*change, parts, window, id);
  add("caseName", {}, QMenu::tr("Copy the name"),
      [id] { QGuiApplication::clipboard()->setText(id); });
  add("caseFolder", iconOf(Icon::kFolder), QMenu::tr("Show the image's folder"), [&parts, id] {
    const sessions::SessionCase* found = parts.document.session().findCase(id.toStdString());
    if (!found) return;
    const std::string folder = found->image.source.file.parent_path().string();
    QDesktopServices::openUrl(QUrl::fromLocalFile(fromText(folder)));
  });
  menu->addSeparator();
  // With its runs, annotations and decisions; an undo restores all of them. Files stay.
  QAction* remove =
      add("caseRemove", iconOf(Icon::kTrash), QMenu::tr("Remove from the session"), [&parts, id] {
        parts.document.edit(sessions::withoutCase(parts.document.session(), id.toStdString()),
                            QMenu::tr("Remove %1").arg(id));
      });
  remove->setEnabled(parts.document.isEditable() && idle);
  return menu;
}

}  // namespace boresight::ui
