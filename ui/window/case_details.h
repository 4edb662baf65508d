// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <QImage>
#include <QObject>
#include <QTimer>

#include "sessions/evaluation/pose_error.h"
#include "sessions/session/session.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/run/case_by_case.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// A case of the session as a row of the list of cases; `known` is kept from one call to the next.
CaseRow caseRow(const sessions::Session& session, const std::string& id,
                sessions::StaleRuns& known);
/// How rows are made: on the worker's thread where there are many.
CaseWork<CaseRow> caseRowWork();

/// Data of the list of cases that the session does not hold: thumbnails of the images, and errors
/// of the latest runs against the truth. Files are read on a worker thread, each once and one at a
/// time, so that requests of the operator run in between.
class CaseDetails : public QObject {
  Q_OBJECT

 public:
  explicit CaseDetails(TaskRunner& tasks, QObject* parent = nullptr);

  /// Sets the session whose files are to be read; known data is kept.
  void setSession(const sessions::Session& session);
  /// Adds the data known so far to a row of the session.
  void fill(CaseRow& row) const;

 Q_SIGNALS:
  /// More data of these cases is available.
  void changed(const std::set<std::string>& ids);

 private:
  void readNext();
  bool readNextOf(std::deque<std::string>& ids, bool (CaseDetails::*begin)(const std::string&));
  bool readPicture(const std::string& id);
  bool readResult(const std::string& id);
  template <class Value, class Read>
  bool read(const std::string& id, std::map<std::string, Value>& known, const std::string& key,
            Read make);
  void fillErrors(const sessions::SessionCase& session_case, CaseRow& row) const;

  TaskRunner& tasks_;
  sessions::Session session_;
  std::map<std::string, QImage> thumbnails_;  ///< by hash of the file; null: cannot be read
  /// By errorKey(); empty: no result.
  std::map<std::string, std::optional<sessions::PoseError>> errors_;
  bool reading_ = false;
  std::deque<std::string> pictures_;  ///< cases whose pictures are to be read, then their results
  std::deque<std::string> results_;
  std::set<std::string> filled_;  ///< cases of which more is known since the last signal
  QTimer pause_;                  ///< between two signals
};

}  // namespace boresight::ui
