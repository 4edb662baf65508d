// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QObject>

#include "sessions/session/input_check.h"
#include "ui/run/task_runner.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

class Banner;

/// Compares the files of a session with its hashes once its first case is read, and reports missing
/// and changed files. On request it searches moved files below the session's folder or accepts
/// changed ones. Hashing may take long, so it has a separate runner.
class InputFindings : public QObject {
  Q_OBJECT

 public:
  InputFindings(WindowParts& parts, Banner& bar, QWidget& window);

  const std::vector<sessions::Finding>& findings() const { return findings_; }
  bool isBusy() const { return waits_ || tasks_.isBusy(); }
  /// Missing or changed files of a case and what to do; empty when there are none.
  QString adviceFor(const QString& case_id) const;

 public Q_SLOTS:
  /// Action of the bar's button: finds moved files, accepts changed ones, or checks again.
  void repair();

 Q_SIGNALS:
  void changed();
  void failed(const QString& message);

 private:
  void check();
  void show();
  bool has(sessions::FindingKind kind) const;
  void findMoved();
  void acceptChanged();

  WindowParts& parts_;
  Banner& bar_;
  QWidget& window_;
  TaskRunner tasks_;
  std::vector<sessions::Finding> findings_;
  bool waits_ = false;  ///< for the files of the case that is shown
};

}  // namespace boresight::ui
