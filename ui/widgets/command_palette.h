// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QDialog>
#include <QPointer>

class QAction;
class QLineEdit;
class QListWidget;
class QMenu;
class QMenuBar;

namespace boresight::ui {

/// Every action of the menus, found by parts of its name; Enter triggers it. Disabled actions are
/// listed in gray, with the reason as tip.
class CommandPalette : public QDialog {
  Q_OBJECT

 public:
  explicit CommandPalette(QMenuBar& menus, QWidget* parent = nullptr);

  /// Names that are listed now, the best first.
  QStringList names() const;

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
  QLineEdit* line_;
  QListWidget* list_;
};

}  // namespace boresight::ui
