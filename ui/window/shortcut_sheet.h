// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>
#include <QList>
#include <QString>

namespace boresight::ui {

/// A key, or where the pointer or the focus is and a key, and what it does.
struct KeyRow {
  QString keys;
  QString text;
};

/// Every key of the window: those of its menus' actions, in their order, then those of image,
/// scene and tables.
QList<KeyRow> keysOf(const QWidget& window);

/// Every key of the window, taken from its actions, so that the sheet cannot be out of date.
class ShortcutSheet : public QDialog {
  Q_OBJECT

 public:
  explicit ShortcutSheet(QWidget& window);

 Q_SIGNALS:
  /// Somebody wants to read more than keys.
  void manualRequested();
};

}  // namespace boresight::ui
