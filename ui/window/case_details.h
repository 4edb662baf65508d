// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QTimer>

#include "core/geometry/pose.h"
#include "sessions/session/session.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// The session's cases as rows of the list of cases. `running` is the id of the case under way, or
/// empty; `file` is the session's, for messages; `known` is kept from one call to the next.
std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running,
                              const std::filesystem::path& file, sessions::StaleRuns& known);

/// Data of the list of cases that the session does not hold: thumbnails of the images, and errors
/// of the latest runs against the truth. Files are read on a worker thread, each once and one at a
/// time, so that requests of the operator run in between.
class CaseDetails : public QObject {
  Q_OBJECT

 public:
  explicit CaseDetails(TaskRunner& tasks, QObject* parent = nullptr);

  /// Sets the session whose files are to be read; known data is kept.
  void setSession(const sessions::Session& session);
  /// Adds the data known so far to rows of the session.
  void fill(std::vector<CaseRow>& rows) const;

 Q_SIGNALS:
  /// More data is available.
  void changed();

 private:
  void readNext();
  void tellSoon();
  template <class Value, class Read>
  bool read(std::map<std::string, Value>& known, const std::string& key, Read make);
  void fillErrors(const sessions::SessionCase& session_case, CaseRow& row) const;

  TaskRunner& tasks_;
  sessions::Session session_;
  std::map<std::string, QImage> thumbnails_;          ///< by hash of the file; null: cannot be read
  std::map<std::string, std::optional<Pose>> poses_;  ///< by digest of the run; empty: no result
  bool reading_ = false;
  std::size_t next_ = 0;  ///< next case to read, first for its picture, then for its run
  QTimer pause_;          ///< between two signals
};

}  // namespace boresight::ui
