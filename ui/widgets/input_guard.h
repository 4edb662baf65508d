// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

namespace boresight::ui {

/// For the whole program: the wheel never changes tabs or a field that does not have the focus,
/// Ctrl+Z and Ctrl+Shift+Z apply to the session, not to the field with the focus, and a comma in a
/// field of a number is a point. Installed as the application's event filter.
class InputGuard : public QObject {
  Q_OBJECT

 public:
  explicit InputGuard(QObject* parent);

  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace boresight::ui
