// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QObject>
#include <QString>

#include "ui/window/window_parts.h"

QT_BEGIN_NAMESPACE
class QMenu;
QT_END_NAMESPACE

namespace boresight::ui {

class WindowDocks;

/// Shows the case and the iteration that the queue asks for, and puts what the queue can do into a
/// menu.
class QueueLinks : public QObject {
  Q_OBJECT

 public:
  QueueLinks(const WindowParts& parts, const WindowDocks& docks, QObject* parent);

  /// `docks` must outlive the menu.
  static void addActions(QMenu& menu, const WindowDocks& docks);

 private:
  struct Place {
    QString case_id;
    std::string run_digest;
    int iteration = -1;
  };

  void open(const Place& place);
  void goThere();

  WindowParts parts_;
  std::optional<Place> wanted_;  ///< while the case or its run is being read
};

}  // namespace boresight::ui
