// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QMenu>
#include <QObject>
#include <QPoint>
#include <QString>

#include "ui/window/window_parts.h"

namespace boresight::ui {

class Workspaces;

/// The context menu of one case of a list.
class CaseMenu : public QObject {
  Q_OBJECT

 public:
  CaseMenu(const WindowParts& parts, Workspaces& workspaces, QWidget* parent);

  /// The menu of a case of the session, to be shown by the caller.
  std::unique_ptr<QMenu> of(const QString& id) const;
  void show(const QString& id, const QPoint& at);

 private:
  bool isBusy() const;
  void review(const QString& id) const;
  void showFolder(const QString& id) const;
  void remove(const QString& id) const;

  WindowParts parts_;
  Workspaces& workspaces_;
  QWidget* parent_;
};

}  // namespace boresight::ui
