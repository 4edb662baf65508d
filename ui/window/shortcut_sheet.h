// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>

namespace boresight::ui {

/// Every key of the window, taken from its actions, so that the sheet cannot be out of date.
class ShortcutSheet : public QDialog {
  Q_OBJECT

 public:
  explicit ShortcutSheet(QWidget& window);
};

}  // namespace boresight::ui
