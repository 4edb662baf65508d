// SPDX-License-Identifier: Apache-2.0
#include "ui/window/manual_help.h"

#include <QDockWidget>
#include <QMainWindow>

#include "ui/manual/manual_folder.h"
#include "ui/manual/manual_window.h"

namespace boresight::ui {

ManualHelp::ManualHelp(QMainWindow& window) : QObject(&window), window_(window) {
  setObjectName(QStringLiteral("manualHelp"));
}

ManualHelp::~ManualHelp() = default;

QString ManualHelp::pageHere() const {
  const QWidget* focus = window_.focusWidget();
  for (; focus; focus = focus->parentWidget())
    if (const auto* dock = qobject_cast<const QDockWidget*>(focus))
      return QStringLiteral("window.md#") + headingAnchor(dock->windowTitle());
  return QStringLiteral("index.md");
}

void ManualHelp::showHere() {
  if (!manual_) {
    manual_ = std::make_unique<ManualWindow>(manualFolder());
    // The program ends with its window, whether or not somebody still reads.
    manual_->setAttribute(Qt::WA_QuitOnClose, false);
  }
  manual_->showPage(pageHere());
}

}  // namespace boresight::ui
