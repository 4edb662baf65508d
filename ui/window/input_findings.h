// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include <QObject>

#include "sessions/session/input_check.h"
#include "ui/run/task_runner.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

class Banner;

/// Compares the files of a session with its hashes once its first case is read, and those of a case
/// whenever they are replaced; reports missing and changed files. On request it checks them again,
/// and searches those still missing below the session's folder or accepts changed ones. Hashing may
/// take long, so it has a separate runner.
class InputFindings : public QObject {
  Q_OBJECT

 public:
  InputFindings(WindowParts& parts, Banner& bar, QWidget& window);

  const std::vector<sessions::Finding>& findings() const { return findings_; }
  bool isBusy() const { return waits_ || tasks_.isBusy(); }
  /// Missing or changed files of a case and what to do; empty when there are none.
  QString adviceFor(const QString& case_id) const;

 public Q_SLOTS:
  /// Action of the bar's button: checks again, then finds moved files or accepts changed ones.
  void repair();

 Q_SIGNALS:
  void changed();
  void failed(const QString& message);

 private:
  void documentOpened();
  void documentChanged();
  std::set<std::string> allIds() const;
  void check(const std::set<std::string>& ids);
  void checkWhenRead();
  void take(const std::set<std::string>& ids, const std::vector<sessions::Finding>& findings);
  void show();
  void repairFound();
  bool has(sessions::FindingKind kind) const;
  void findMoved();
  void acceptChanged();

  WindowParts& parts_;
  Banner& bar_;
  QWidget& window_;
  TaskRunner tasks_;
  TaskKind checking_;
  TaskKind repairing_;
  TaskKind waiting_;
  sessions::Session followed_;   ///< the document when its changes were looked at last
  std::set<std::string> asked_;  ///< cases whose files are to be checked, or are being checked
  std::vector<sessions::Finding> findings_;
  bool repairs_ = false;  ///< what the check under way finds
  bool waits_ = false;    ///< for the files of the case that is shown
};

}  // namespace boresight::ui
