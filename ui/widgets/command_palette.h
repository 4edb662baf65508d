// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QDialog>
#include <QPointer>

#include "ui_command_palette.h"

class QAction;
class QMenu;
class QMenuBar;

namespace boresight::ui {

/// Every action of the menus, found by parts of its name; Enter triggers it. Disabled actions are
/// listed in gray, with the reason as tip.
class CommandPalette : public QDialog {
  Q_OBJECT

 public:
  explicit CommandPalette(QMenuBar& menus, QWidget* parent = nullptr);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Command {
    QString name;  ///< "Run > Step iteration"
    QPointer<QAction> action;
  };

  void collect(const QMenu& menu, const QString& path);
  void filter(const QString& text);
  void run();

  std::vector<Command> commands_;
  Ui::CommandPalette ui_;
};

}  // namespace boresight::ui
