// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>
#include <QList>
#include <QString>

#include "ui_shortcut_sheet.h"

namespace boresight::ui {

/// A key, possibly with the required position of pointer or focus, and its action.
struct KeyRow {
  QString keys;
  QString text;
};

/// Every key of the window: those of its menus' actions, in their order, then those of image,
/// scene and tables.
QList<KeyRow> keysOf(const QWidget& window);

/// Every key of the window, in two columns.
class ShortcutSheet : public QDialog {
  Q_OBJECT

 public:
  explicit ShortcutSheet(QWidget& window);

 Q_SIGNALS:
  /// The operator asks for the manual.
  void manualRequested();

 private:
  Ui::ShortcutSheet ui_;
};

}  // namespace boresight::ui
